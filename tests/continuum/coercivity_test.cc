// The lifted gradient energy: never negative, and stable where laws stiffen, cells are skewed and normal gradients
// jump.
#include "continuum/errors.h"
#include "continuum/rate_forces.h"
#include "moving_sheets.h"

#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace coercivity_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::Constitution;
using continuum::StaticSettings;
using continuum::StaticSolver;

// psi = a ((l - 1)^2 / 2 + 10 (l - 1)^6): psi'' is 20 times that at rest at stretch 1.5.
class StiffeningBond : public continuum::CustomPotentialLaw
{
public:
  continuum::PotentialDerivatives derivatives(const double l) const override
  {
    constexpr double a = 1e5;
    const double x = l - 1.;
    return {a * (0.5 * x * x + 10. * std::pow(x, 6)), a * (x + 60. * std::pow(x, 5)), a * (1. + 300. * std::pow(x, 4)),
            a * 1200. * std::pow(x, 3), a * 3600. * x * x};
  }
};

// The gradient energy is not negative at rough states, whose F and normal gradients jump by the order of one. With the
// double traction of both sides in place of the lifting, some of them have less than -1e6 J/m at a penalty of 2.
TEST(GradientEquilibrium, HasNoNegativeGradientEnergy)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::LatticeGradient gradient = rubber_gradient(0.02);
  RectangleMesh mesh(rectangle(6, 4));
  for (const auto &[degree, roughness] : {std::pair(2u, 5e-3), std::pair(3u, 2e-3)}) // [m], on cells of 2.5 cm
  {
    Constitution laws(law, gradient);
    laws.penalty = 0.;
    const continuum::Sheet with(mesh, laws, degree), without(mesh, law, degree);
    std::mt19937 generator(23);
    std::uniform_real_distribution<double> rough(-roughness, roughness);
    unsigned int n_states = 0;
    for (int sample = 0; sample < 400; ++sample)
    {
      auto u = with.make_ghosted();
      {
        auto owned = with.make_owned();
        with.for_each_owned_dof(
          [&](const auto dof, const unsigned int i, const auto &X)
          {
            if (owned(dof) == 0.) // nodes are visited once a cell
              owned(dof) = 0.5 * X[i] + rough(generator);
          });
        u = owned;
      }
      try
      {
        EXPECT_GE(with.energy(u) - without.energy(u), 0.) << degree << ' ' << sample;
        ++n_states;
      }
      catch (const continuum::NonPhysicalState &)
      {
        // A cell is folded.
      }
    }
    EXPECT_GT(n_states, 300u);
  }
}

// The lifting of a kink u_y = s max(0, X - a) along a column of faces in a strip of squares of side h that is periodic
// along Y: in both cells beside a face, whose n is 4, R is a polynomial of degree p - 1 across the face with the
// squared mean (s p / 2 h)^2, so that W_g = c |G|^2 / 2 has the energy n c s^2 p^2 / 4 h per length of the column, and
// dashpots at rest dissipate n p^2 / 2 h times the power of the rate s e_y (x) NN. theory-continuum.md, eqs. (C.59) and
// (C.63).
TEST(GradientEquilibrium, LiftsAKinkAsInClosedForm)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::IsotropicGradient gradient(5e5, 0.01);
  const continuum::FibreViscosity local_dashpots = network_viscosity(300.);
  const continuum::FibreViscosity dashpots = network_viscosity(300., 0.01);
  constexpr double h = 0.02, s = 0.3, n = 4.;
  continuum::FieldDerivatives rate{};
  rate[1][continuum::n_first] = s;
  continuum::PointIntegrand power;
  continuum::clear(power, continuum::Order::value);
  dashpots.gradient()->add_density({}, rate, continuum::Order::value, 0., power);
  for (const unsigned int p : {2u, 3u, 4u})
  {
    RectangleMesh mesh({4. * h, 2. * h, 4, 2, false, true});
    continuum::BoundaryConditions along_y;
    along_y.periodic = {{continuum::edge::bottom, continuum::edge::top, 1}};
    Constitution laws(law, gradient);
    laws.penalty = 0.;
    const continuum::Sheet with(mesh, laws, p, along_y), without(mesh, law, p, along_y);
    const auto u = nodal(with, [](const Point<2> &X) { return Tensor<1, 2>({0., s * std::max(0., X[0] - 2. * h)}); });
    const double expected = n * gradient.modulus() * s * s * p * p / (4. * h) * 2. * h;
    // Round-off of two energies of the order of 1e3 J/m.
    EXPECT_NEAR(with.energy(u) - without.energy(u), expected, 1e-11 * without.energy(u)) << p;
    const double of_stretches =
      continuum::RateForces(with, &local_dashpots, nullptr).dissipation(with.make_ghosted(), u, {});
    const double of_both = continuum::RateForces(with, &dashpots, nullptr).dissipation(with.make_ghosted(), u, {});
    EXPECT_NEAR(of_both - of_stretches, power.value * n * p * p / (2. * h) * 2. * h, 1e-10 * of_both) << p;
  }
}

// psi'' is 20 times that at rest at the load. The equilibrium is independent of the penalty, and there is one without.
TEST(GradientEquilibrium, StaysCoerciveWhereTheLawStiffens)
{
  continuum::CauchyBorn network = rubber_network();
  std::vector<continuum::FibreFamily> fibres = network.families();
  std::vector<continuum::BondFamily> bonds = rubber_bonds(0.02);
  const auto law = std::make_shared<StiffeningBond>();
  for (std::size_t k = 0; k < fibres.size(); ++k)
    bonds[k].fibre.potential = fibres[k].potential = continuum::CustomPotential{law};
  network = continuum::CauchyBorn(fibres);
  const continuum::LatticeGradient gradient(bonds, continuum::LatticeGradient::smallest_length(bonds));
  const auto energy = [&](const double penalty, const unsigned int cells)
  {
    RectangleMesh mesh(rectangle(cells, cells));
    Constitution laws(network, gradient);
    laws.penalty = penalty;
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver solver(mesh, laws, bump_problem(1.5, 1.5, 0.004), settings);
    solver.solve();
    return solver.total_energy();
  };
  const double expected = energy(0.5, 12);
  const double error_of_mesh = std::abs(expected - energy(0.5, 24));
  for (const double penalty : {0., 2., 20.})
    EXPECT_NEAR(energy(penalty, 12), expected, error_of_mesh) << penalty;
}

// Cells skewed by a shear of 3, for which a penalty that suffices for squares would be too small.
TEST(GradientEquilibrium, StaysCoerciveOnSkewedCells)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::LatticeGradient gradient = rubber_gradient(0.05);
  RectangleMesh mesh(rectangle(8, 8));
  dealii::GridTools::transform([](const Point<2> &X) { return Point<2>(X[0] + 3. * X[1], X[1]); }, mesh);
  const auto field = std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.1 * X[0], 0.2 * X[1] + 0.01 * std::sin(30. * X[0]) * std::sin(40. * X[1])});
    });
  for (const double penalty : {0., 0.5, 20.})
  {
    Constitution laws(law, gradient);
    laws.penalty = penalty;
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver solver(mesh, laws, on_all_edges(field), settings);
    EXPECT_EQ(solver.solve().load_steps.size(), 1u) << penalty;
  }
}

} // namespace coercivity_test
