// Stencils of rings: moments of their weights. Energies and waves: tests/verification/claims/nonlocal_test.cc.
#include "lattice/stencil.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/triangular_lattice.h"
#include "support/largest_error.h"

namespace lattice_stencil_test
{

using namespace latcon::lattice;

constexpr double d = 0.625e-3;

using Stencil = std::vector<HalfBond>;

std::vector<Ring> all_directions()
{
  return lattice_rings(d, Orientation::rows_along_crack, M_PI / 6.);
}

Stencil isotropic(Grid::Kind kind, double m, double rotation = 0.)
{
  return ring_stencil({kind, d / m, rotation}, all_directions());
}

double sum(const Stencil &stencil, std::size_t shell, const std::function<double(const HalfBond &)> &of_bond)
{
  double total = 0.;
  for (const HalfBond &bond : stencil)
    if (bond.shell == shell)
      total += bond.weight * of_bond(bond);
  return total;
}

/// Largest error of the second and fourth moments of directions.
double error_of_moments(const Stencil &stencil)
{
  double error = 0.;
  for (const std::size_t shell : {0, 1})
    for (int x = 0; x <= 4; ++x)
    {
      const double mean = sum(stencil, shell,
                              [&](const HalfBond &bond)
                              {
                                const double angle = std::atan2(bond.vector.y(), bond.vector.x());
                                return std::pow(std::cos(angle), x) * std::pow(std::sin(angle), 4 - x);
                              });
      const double exact[] = {3. / 8., 0., 1. / 8., 0., 3. / 8.};
      error = latcon::support::largest_of({error, std::abs(mean - exact[x])});
    }
  return error;
}

const struct
{
  const char *name;
  Grid::Kind kind;
  double rotation;
} grids[] = {{"triangular", Grid::Kind::triangular, 0.},
             {"turned triangular", Grid::Kind::triangular, 0.21},
             {"square", Grid::Kind::square, 0.},
             {"turned square", Grid::Kind::square, M_PI / 4.},
             {"slightly turned square", Grid::Kind::square, 0.13}};

TEST(Stencil, HasTheMomentsOfAllDirections)
{
  for (const auto &grid : grids)
    for (const double m : {1.5, 2., 3., 4., 6.})
      EXPECT_LT(error_of_moments(isotropic(grid.kind, m, grid.rotation)), 1e-13) << grid.name << ", m = " << m;
  EXPECT_EQ(isotropic(Grid::Kind::square, 2.).size(), 30u);
  EXPECT_EQ(isotropic(Grid::Kind::square, 3.).size(), 48u);
  for (const double degrees : {10., 20.})
    EXPECT_LT(error_of_moments(ring_stencil({Grid::Kind::square, d / 4., 0.},
                                            lattice_rings(d, Orientation::rows_along_crack, degrees * M_PI / 180.))),
              1e-13)
      << degrees;
}

TEST(Stencil, RefusesWhatIsNoContinuum)
{
  const auto refuses = [](const Grid &grid, const std::vector<Ring> &rings)
  { EXPECT_THROW(ring_stencil(grid, rings), std::invalid_argument); };
  const auto narrow = lattice_rings(d, Orientation::rows_along_crack, 0.);
  refuses({Grid::Kind::square, d, 0.}, narrow);           // no bonds in the arcs
  refuses({Grid::Kind::triangular, 0.5 * d, 0.}, narrow); // four lattices in each other
  refuses({Grid::Kind::square, 0., 0.}, all_directions());
  refuses({Grid::Kind::square, d, 0.}, {{-d, 0., 0}});
  refuses({Grid::Kind::square, d, 0.}, {{d, 0., n_shells}});
  refuses({Grid::Kind::square, d, 0.}, {{d, 0., 0, 1.}});
}

} // namespace lattice_stencil_test
