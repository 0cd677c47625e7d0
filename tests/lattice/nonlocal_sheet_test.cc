// Sheets of any stencil: the lattice's own crack by the stencil of six directions, and what holds for all.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/cutout.h"
#include "lattice/simulation.h"
#include "lattice/site_fields.h"
#include "tests/lattice/nonlocal_sheets.h"
#include "tests/lattice/running_crack.h"

namespace lattice_nonlocal_sheet_test
{

using namespace latcon::lattice;
using nonlocal_sheets::sheet;

constexpr double d = sheets::spacing;

Eigen::Matrix2d loaded()
{
  return sheets::stretched(2.3, 2.8);
}

TimeStepping stepping(const TriangularLattice &lattice, const Material &material)
{
  return chebyshev_time_stepping(chebyshev_step(lattice, material, 0.45), time_step_limits(lattice, material, 0.3), 0);
}

State noisy(const TriangularLattice &lattice, const Material &material)
{
  State state = homogeneous_state(lattice, material, loaded(), Edges::held);
  add_noise(state, lattice, 0.02 * d, 3);
  return state;
}

using OfSixDirections = testing::TestWithParam<Orientation>;
INSTANTIATE_TEST_SUITE_P(NonlocalSheet, OfSixDirections,
                         testing::Values(Orientation::rows_along_crack, Orientation::rows_across_crack));

TEST_P(OfSixDirections, IsTheLatticeBitForBit)
{
  const TriangularLattice lattice(d, 50. * d, 30. * d, GetParam()),
    ours = sheet(Grid::Kind::triangular, 1., 50., 30., 0., GetParam());
  ASSERT_EQ(ours.n_places(), lattice.n_places());
  for (const Material &material : {sheets::rubber(), sheets::disordered_rubber()})
  {
    running_crack::Choice choice;
    choice.material = material;
    choice.stepping = stepping(lattice, material);
    choice.contact = choice.contact_strength = 1.;
    const auto crack = running_crack::start(ours, choice), expected = running_crack::start(lattice, choice);
    for (int step = 0; step < 60; ++step)
    {
      crack->step();
      expected->step();
    }
    EXPECT_GT(expected->n_broken(), 20u);
    EXPECT_EQ(crack->n_broken(), expected->n_broken());
    EXPECT_EQ(crack->tip(), expected->tip());
    for (const auto energy : sheets::energies)
      EXPECT_EQ(crack->energies().*energy, expected->energies().*energy);
    for (VectorField State::*field : {&State::position, &State::velocity})
      for (const std::size_t place : lattice.sites())
        ASSERT_EQ((crack->state().*field).at(place), (expected->state().*field).at(place)) << place;
  }
}

struct Stencil
{
  Grid::Kind kind;
  double m, half_width;
  Orientation orientation = Orientation::rows_along_crack;
  double scatter = 0.;
};
const Stencil stencils[] = {{Grid::Kind::triangular, 2., 30.},
                            {Grid::Kind::square, 2., 30.},
                            {Grid::Kind::square, 2., 30., Orientation::rows_across_crack},
                            {Grid::Kind::triangular, 1.5, 15., Orientation::rows_across_crack},
                            {Grid::Kind::triangular, 4., 30.}, // of 78 half-bonds
                            {Grid::Kind::square, 1.5, 30., Orientation::rows_along_crack, 0.5},
                            {Grid::Kind::triangular, 2., 30., Orientation::rows_across_crack, 0.5}};

class NonlocalSheet : public testing::TestWithParam<Stencil>
{
protected:
  static TriangularLattice of(double length, double height)
  {
    const auto [kind, m, half_width, orientation, scatter] = GetParam();
    return sheet(kind, m, length, height, half_width, orientation, scatter);
  }
};
INSTANTIATE_TEST_SUITE_P(Stencils, NonlocalSheet, testing::ValuesIn(stencils));

TEST_P(NonlocalSheet, RestsWhereItIsStretchedHomogeneously)
{
  Eigen::Matrix2d F;
  F << 1.4, 0.3, -0.2, 1.7;
  const TriangularLattice lattice = of(16., 12.);
  const Material material = sheets::rubber_with_branches();
  Simulation at_rest(lattice, material, homogeneous_state(lattice, material, F, Edges::held),
                     stepping(lattice, material));
  for (int step = 0; step < 20; ++step)
    at_rest.step();
  std::size_t n_free = 0;
  for_each_bond(at_rest.state(), lattice,
                [&](const Bond &bond)
                {
                  n_free += at_rest.state().held[bond.near] == 0 ? 1 : 0;
                  EXPECT_LT((at_rest.position(bond.near) - F * lattice.reference(bond.near)).norm(),
                            (GetParam().scatter > 0. ? 0.1 : 1e-11) * d);
                });
  EXPECT_GT(n_free, 500u);
}

// With the order of the method, and so only if forces are the gradient of the energy and dashpots take what they say.
TEST_P(NonlocalSheet, ClosesItsLedger)
{
  const TriangularLattice lattice = of(16., 12.);
  const Material material = sheets::rubber_with_branches();
  const double span = 8. * chebyshev_step(lattice, material, 0.45);
  const auto relative_imbalance = [&](int steps)
  {
    Simulation moving(lattice, material, noisy(lattice, material),
                      chebyshev_time_stepping(span / steps, time_step_limits(lattice, material, 0.3), 0));
    for (int step = 0; step < steps; ++step)
      moving.step();
    const EnergyBalance energies = moving.energies();
    return std::abs(energies.imbalance()) / energies.viscous;
  };
  const double coarse = relative_imbalance(64), fine = relative_imbalance(256);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(coarse / fine, 10.);
}

TEST_P(NonlocalSheet, CutsTheBondsThatCrossASegment)
{
  const auto side = [](const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
  { return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0.; };
  const TriangularLattice lattice = of(16., 12.);
  const Material material = sheets::rubber();
  const State whole = homogeneous_state(lattice, material, loaded(), Edges::held);
  Simulation slit(lattice, material, whole, stepping(lattice, material),
                  Fracture(lattice, material, 3.05, Toughening(), loaded()));
  const Eigen::Vector2d a(4.03 * d, 0.217 * d), b(8.41 * d, 0.217 * d);
  slit.cut_bonds(bonds_across(lattice, a.x(), b.x(), a.y()));
  std::size_t n = 0;
  for_each_bond(whole, lattice,
                [&](const Bond &bond)
                {
                  const Eigen::Vector2d X = lattice.reference(bond.near), far = X + lattice.bond_vector(bond);
                  const bool crosses = side(a, b, X) != side(a, b, far) && side(X, far, a) != side(X, far, b);
                  EXPECT_EQ(slit.state().bonds.present(bond.near, bond.kind), !crosses);
                  n += crosses ? 1 : 0;
                });
  EXPECT_GT(n, 0u);
  const EnergyBalance energies = slit.energies();
  EXPECT_NEAR(energies.broken, energies.initial - energies.elastic, 1e-12 * energies.elastic);
  // Behind it are the last sites that lost a quarter of their bonds.
  ASSERT_TRUE(slit.tip());
  EXPECT_LT(lattice.reference(*slit.tip()).x(), b.x());
  EXPECT_GT(lattice.reference(*slit.tip()).x(), b.x() - d);
}

// Returns how many of the bonds that a slit cut in a compressed sheet are turned round once it has come to rest.
std::size_t n_turned(const TriangularLattice &lattice, double contact_distance)
{
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1., 0.85);
  Simulation closing(lattice, material, homogeneous_state(lattice, material, F, Edges::held),
                     stepping(lattice, material), Fracture(lattice, material, 3.05, Toughening(), F));
  closing.enable_contact(contact_like_nearest_bond(lattice, material, contact_distance, 1., 1.));
  const auto slit = bonds_across(lattice, 5. * d, 15. * d, 0.1 * d);
  closing.cut_bonds(slit);
  for (int step = 0; step < 100; ++step)
    closing.step();
  std::size_t n = 0;
  for (const auto &[near, kind] : slit)
  {
    const Bond bond = lattice.bond(near, kind);
    const double now = (closing.position(bond.far) - closing.position(bond.near)).y();
    const double Y = lattice.bond_vector(bond).y();
    n += Y > 0.8 * d && now < 0. ? 1 : 0;
  }
  return n;
}

TEST_P(NonlocalSheet, HasFlanksThatDoNotPassEachOther)
{
  const TriangularLattice lattice = of(20., 12.);
  const std::size_t without_contact = n_turned(lattice, 1e-3 * d);
  EXPECT_GT(without_contact, 0u);
  // Single points fit into gaps between scattered ones.
  EXPECT_LE(n_turned(lattice, 0.9 * d), lattice.grid().scatter.amplitude > 0. ? without_contact / 10 : 0);
}

// Neither do sites of an unloaded flank touch, however close they are.
TEST_P(NonlocalSheet, HasNoContactInAnUnloadedSlit)
{
  const TriangularLattice lattice = of(24., 16.);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  Simulation unloaded(lattice, material, homogeneous_state(lattice, material, F, Edges::held),
                      stepping(lattice, material), Fracture(lattice, material, 3.05, Toughening(), F));
  unloaded.enable_contact(contact_like_nearest_bond(lattice, material, 0.9 * d, 1., 1.));
  unloaded.cut_bonds(bonds_across(lattice, 6. * d, 18. * d, 0.1 * d));
  unloaded.step();
  // Only bonds of the rings that are shorter than the distance may be in contact, across the slit.
  std::size_t n_short = 0;
  for (const auto &[near, kind] : bonds_across(lattice, 6. * d, 18. * d, 0.1 * d))
    n_short += lattice.rest_length(kind) / lattice.length_ratio(near, kind) < 0.9 * d ? 1 : 0;
  EXPECT_LE(unloaded.contact()->last().size(), 2 * n_short);
}

TEST(NonlocalCrack, RefusesWhatItCannotDo)
{
  const std::vector<Ring> rings = lattice_rings(d, Orientation::rows_along_crack, M_PI / 6.);
  const Grid fine{Grid::Kind::triangular, d / 8.};
  EXPECT_THROW(TriangularLattice(fine, ring_stencil(fine, rings), d, 16. * d, 12. * d), std::invalid_argument);
  const TriangularLattice square = sheet(Grid::Kind::square, 2., 16., 12.);
  const State state = homogeneous_state(square, sheets::rubber(), loaded(), Edges::held);
  EXPECT_FALSE(StrainGradientFit(square).at(state, square.index(square.rows() / 2, square.columns() / 2)));
}

} // namespace lattice_nonlocal_sheet_test
