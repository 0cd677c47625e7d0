#include "verification/claims/damage/smooth_motion_rows.h"

#include <algorithm>
#include <cmath>

#include "continuum/damage/damage_motion.h"
#include "support/largest_error.h"
#include "verification/bridge/homogenisation.h"

namespace latcon::claims
{
namespace
{

using continuum::GridVector;
using continuum::NodeGrid;
using dealii::Point;
using dealii::Tensor;

constexpr double pi = 3.14159265358979323846;
constexpr double smooth_density = 1e3; // sets the unit of time alone
constexpr double periods_height = 8.;  // wavelength of the deformation, over the spacing
constexpr double added_strain = 0.05;  // of the deformation, in addition to that of the case

// A square sheet with one wavelength of a deformation along either axis.
struct Deformation
{
  double length; // of an edge [m]

  double q() const { return 2. * pi / length; }
  Tensor<1, 2> displacement(const Point<2> &X) const
  {
    const double x = q() * X[0] + 0.3, y = q() * X[1] - 0.2, e = added_strain / q();
    return Tensor<1, 2>({e * std::sin(x) * std::cos(y), 0.7 * e * std::cos(x) * std::sin(y)});
  }
  Tensor<2, 2> gradient(const Point<2> &X) const
  {
    const double x = q() * X[0] + 0.3, y = q() * X[1] - 0.2;
    Tensor<2, 2> G;
    G[0][0] = added_strain * std::cos(x) * std::cos(y);
    G[0][1] = -added_strain * std::sin(x) * std::sin(y);
    G[1][0] = -0.7 * added_strain * std::sin(x) * std::sin(y);
    G[1][1] = 0.7 * added_strain * std::cos(x) * std::cos(y);
    return G;
  }
  // Second derivatives u_k,LJ.
  Tensor<3, 2> second_gradient(const Point<2> &X) const
  {
    const double x = q() * X[0] + 0.3, y = q() * X[1] - 0.2, e = added_strain * q();
    Tensor<3, 2> H;
    H[0][0][0] = H[0][1][1] = -e * std::sin(x) * std::cos(y);
    H[0][0][1] = H[0][1][0] = -e * std::cos(x) * std::sin(y);
    H[1][0][0] = H[1][1][1] = -0.7 * e * std::cos(x) * std::sin(y);
    H[1][0][1] = H[1][1][0] = -0.7 * e * std::sin(x) * std::cos(y);
    return H;
  }
};

NodeGrid grid_of(const Deformation &deformation, const unsigned int n)
{
  return NodeGrid(continuum::Rectangle{deformation.length, deformation.length, n, n});
}

GridVector nodal_displacement(const NodeGrid &grid, const Deformation &deformation)
{
  GridVector u;
  for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    for (const unsigned int i : {0u, 1u})
      u[i].push_back(deformation.displacement(grid.position(a))[i]);
  return u;
}

// The loaded sheet of a case.
struct Sheet
{
  const bridge::Subject &subject;
  Tensor<2, 2> F;
  std::vector<continuum::BondFamily> bonds;
};

// Largest difference of nodal forces per area [N/m^3] from the divergence of the stress, over the largest divergence.
double error_of_forces(const Sheet &sheet, const Deformation &deformation, const unsigned int n)
{
  const NodeGrid grid = grid_of(deformation, n);
  const GridVector u = nodal_displacement(grid, deformation);
  GridVector force;
  continuum::FibreForces(grid, sheet.subject.cauchy_born.families(), {}, sheet.F)
    .forces(u, u, std::vector<double>(grid.n_cells(), 1.), force);
  support::LargestError error, largest;
  for (std::size_t j = 1; j + 1 < grid.rows(); ++j)
    for (std::size_t i = 1; i + 1 < grid.columns(); ++i)
    {
      const std::size_t a = j * grid.columns() + i;
      const Point<2> X = grid.position(a);
      const Tensor<4, 2> A = sheet.subject.cauchy_born.tangent(sheet.F + deformation.gradient(X));
      const Tensor<3, 2> H = deformation.second_gradient(X);
      for (const unsigned int component : {0u, 1u})
      {
        double divergence = 0.;
        for (const unsigned int J : {0u, 1u})
          for (const unsigned int k : {0u, 1u})
            for (const unsigned int L : {0u, 1u})
              divergence += A[component][J][k][L] * H[k][L][J];
        error.add(std::abs(force[component][a] / grid.area() - divergence));
        largest.add(std::abs(divergence));
      }
    }
  return error.error() / largest.error();
}

// Forces of the gradient energy per area [N/m^3] at the inner nodes of the coarsest of meshes of 16, 32, ... cells.
std::vector<double> gradient_forces(const Sheet &sheet, const Deformation &deformation, const unsigned int refinement)
{
  const unsigned int n = 16 * refinement;
  const NodeGrid grid = grid_of(deformation, n);
  GridVector force{std::vector<double>(grid.n_nodes(), 0.), std::vector<double>(grid.n_nodes(), 0.)};
  continuum::GradientForces(grid, sheet.bonds, sheet.subject.lengths.lattice, sheet.F)
    .add_forces(nodal_displacement(grid, deformation), std::vector<double>(grid.n_nodes(), 1.), force);
  std::vector<double> densities;
  for (std::size_t j = 3; j <= 13; ++j)
    for (std::size_t i = 3; i <= 13; ++i)
      for (const unsigned int component : {0u, 1u})
        densities.push_back(force[component][refinement * (j * grid.columns() + i)] / grid.area());
  return densities;
}

double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  support::LargestError error;
  for (std::size_t i = 0; i < a.size(); ++i)
    error.add_difference(a[i], b[i]);
  return error.error();
}

// Squared frequency [1/s^2] of a longitudinal wave along X with k^2 = K, eqs. (C.47) and (C.82).
double squared_frequency(const Sheet &sheet, const double K)
{
  double A_2 = 0., A_4 = 0.;
  for (const continuum::BondFamily &bond : sheet.bonds)
  {
    const Tensor<1, 2> &N = bond.fibre.direction, f = sheet.F * N;
    const double l = f.norm(), n = f[0] / l;
    const continuum::PotentialDerivatives psi = continuum::derivatives(bond.fibre.potential, l);
    const double h = bond.fibre.weight * (psi.second * n * n + psi.first / l * (1. - n * n));
    A_2 += h * N[0] * N[0];
    A_4 += h * std::pow(bond.length, 2) * std::pow(N[0], 4) / 12.;
  }
  const double l_d = sheet.subject.lengths.lattice;
  return (A_2 * K + (l_d * l_d * A_2 - A_4) * K * K) / (1. + l_d * l_d * K) / smooth_density;
}

// Squared frequency that a sheet has in its middle, in one step of velocity Verlet from rest, over the theory.
double wave(const Sheet &sheet)
{
  // The mass operator forgets an edge as exp(-0.9 y/h) or faster.
  constexpr unsigned int n = 50;
  const double h = 0.5 * sheet.subject.spacing, k = 1.2 / sheet.subject.spacing, amplitude = 1e-4 * h;
  const double theory = squared_frequency(sheet, std::pow(2. / h * std::sin(0.5 * k * h), 2));
  const double step = 0.02 / std::sqrt(theory);
  const double threshold = // never reached
    10. * (sheet.subject.cauchy_born.energy(sheet.F) + sheet.subject.cauchy_born.tangent(sheet.F)[0][0][0][0]);
  continuum::DamageMotionSetup setup{{n * h, n * h, n, n},
                                     sheet.F,
                                     sheet.subject.cauchy_born.families(),
                                     {},
                                     smooth_density,
                                     {threshold, sheet.subject.spacing},
                                     [](const Point<2> &, unsigned int) { return false; },
                                     {},
                                     step};
  setup.gradient = continuum::GradientSetup{sheet.bonds, sheet.subject.lengths.lattice};
  continuum::DamageMotion motion(setup);
  const double middle = 0.5 * n * h;
  motion.set_motion(
    [&](const Point<2> &X) {
      return Tensor<1, 2>({amplitude * std::cos(k * (X[0] - middle)), 0.});
    },
    [](const Point<2> &) { return Tensor<1, 2>(); });
  motion.advance();
  const std::size_t node = (n / 2) * motion.grid().columns() + n / 2;
  const double squared = 2. * (1. - motion.displacement()[0][node] / amplitude) / (step * step);
  return squared / theory;
}

} // namespace

void add_smooth_motion_rows(const bridge::Subject &subject, const Rows &rows)
{
  const auto add = [&](const std::string &quantity, double value, double theory, const output::Tolerance &tolerance)
  { rows.add(quantity, "1", of_continuum(value, theory), std::abs(value - theory), tolerance); };
  const lattice::TriangularLattice cell(subject.spacing, 4. * subject.spacing, 4. * subject.spacing,
                                        subject.orientation);
  const Sheet sheet{subject, bridge::to_continuum(subject.deformation), bridge::bond_families(cell, subject.material)};
  const Deformation deformation{periods_height * subject.spacing};
  const double coarse = error_of_forces(sheet, deformation, 16), fine = error_of_forces(sheet, deformation, 32);
  const output::Tolerance of_order{0.15,
                                   "the next term is (q h)^2 = 0.15 of the first on the coarser mesh, a quarter of "
                                   "that on the finer one: log2(1.15) - log2(1.04)"};
  add("forces of a smooth deformation: order in h", std::log2(coarse / fine), 2., of_order);
  add("forces of a smooth deformation over the divergence of the stress, error at h = 1/32 of the wavelength", fine, 0.,
      {6. * std::pow(2. * pi / 32., 2) / 12.,
       "second differences and means over cells, (q h)^2 / 12 each along either axis, in products of three"});
  const std::vector<double> f_1 = gradient_forces(sheet, deformation, 1), f_2 = gradient_forces(sheet, deformation, 2),
                            f_4 = gradient_forces(sheet, deformation, 4);
  add("forces of the gradient energy: order in h",
      std::log2(largest_difference(f_1, f_2) / largest_difference(f_2, f_4)), 2., of_order);
  // Ten times the tolerance of the mass operator. The first step from rest is exact, and the quadratic terms of the law
  // vanish in the middle by symmetry; the cubic ones are the square of a strain of 6e-5.
  add("wave with gradient energy and micro-inertia, squared frequency over (C.82)", wave(sheet), 1.,
      {10. * continuum::MassOperator::tolerance, "ten times the tolerance of the mass operator"});
}

} // namespace latcon::claims
