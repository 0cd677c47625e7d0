// Penalty of the gradient terms: coercivity where laws stiffen and cells are skewed.
#include "continuum/errors.h"
#include "continuum/meshes.h"
#include "continuum/point_integrand.h"
#include "sheets.h"

#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

namespace coercivity_test
{

using namespace latcon;
using namespace sheets;
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

// A penalty that is fixed at F = I makes the tangent indefinite where a law stiffens by more than eight times, at 80 %
// of this load at the default, earlier at smaller ones. The equilibrium is that of a penalty that is large throughout;
// energies differ by the error of the mesh.
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
  const auto energy = [&](const double penalty)
  {
    Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle(mesh, rectangle(12, 12));
    Constitution laws(network, gradient);
    laws.penalty = penalty;
    StaticSettings settings;
    settings.degree = 2;
    StaticSolver solver(mesh, laws, bump_problem(1.5, 1.5, 0.004), settings);
    solver.solve();
    return solver.total_energy();
  };
  const double expected = energy(20.);
  for (const double penalty : {0.5, Constitution(network).penalty, 5.})
    EXPECT_NEAR(energy(penalty), expected, 1e-4 * expected) << penalty;
}

// Cells skewed by a shear of 3 violate the inverse estimate at a quarter of the default penalty: the message says so,
// and the default solves the sheet.
TEST(GradientEquilibrium, NamesThePenaltyIfFaceTermsLoseCoercivity)
{
  const continuum::CauchyBorn law = rubber_network();
  const continuum::LatticeGradient gradient = rubber_gradient(0.05);
  Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, rectangle(8, 8));
  dealii::GridTools::transform([](const Point<2> &X) { return Point<2>(X[0] + 3. * X[1], X[1]); }, mesh);
  const auto field = std::make_shared<Field>(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.1 * X[0], 0.2 * X[1] + 0.01 * std::sin(30. * X[0]) * std::sin(40. * X[1])});
    });
  const auto solve = [&](const double penalty)
  {
    Constitution laws(law, gradient);
    laws.penalty = penalty;
    StaticSettings settings;
    settings.degree = 2;
    settings.smallest_load_step = 1. / 16.;
    StaticSolver(mesh, laws, on_all_edges(field), settings).solve();
  };
  EXPECT_NO_THROW(solve(Constitution(law).penalty));
  try
  {
    solve(0.5);
    FAIL() << "the penalty is too small";
  }
  catch (const continuum::SolverFailed &failure)
  {
    EXPECT_NE(std::string(failure.what()).find("raise the penalty"), std::string::npos) << failure.what();
  }
}

// Below the limit the penalty is that of the theory, bit for bit; the stiffness bounds the largest one in any
// direction.
TEST(GradientEquilibrium, HasThePenaltyOfSmallStrainUpToALimit)
{
  const continuum::LatticeGradient law = rubber_gradient(0.01);
  const Tensor<2, 2> rest = matrix(1., 0., 0., 1.);
  for (const double angle : {0., 0.3, 0.5 * pi})
  {
    const Tensor<1, 2> N({std::cos(angle), std::sin(angle)});
    EXPECT_GE(law.stiffness_across(rest, N), law.normal_stiffness() * (1. - 1e-12));
    EXPECT_LE(law.stiffness_across(rest, N), 2. * law.normal_stiffness());
  }
  const Tensor<1, 2> N({1., 0.});
  continuum::FieldDerivatives one{}, other{};
  one[0][0] = 0.01; // jump of du_x/dX
  const auto sigma = [&](const double supported)
  {
    continuum::PointIntegrand d;
    clear(d, continuum::Order::value);
    face_density(law, {one, other}, 2, N, Tensor<1, 2>(), {true, true}, {1e3, supported}, continuum::Order::value, d);
    return d.value / (0.5 * 0.01 * 0.01);
  };
  const double stiffness = 0.5 * (law.stiffness_across(matrix(1.01, 0., 0., 1.), N) + law.stiffness_across(rest, N));
  EXPECT_DOUBLE_EQ(sigma(stiffness * 1.01), 1e3);
  for (const double ratio : {1.1, 1.4, 2., 10., 1e3})
  {
    EXPECT_GE(sigma(stiffness / ratio), 0.82 * ratio * 1e3);
    EXPECT_LE(sigma(stiffness / ratio), ratio * 1e3);
  }
}

} // namespace coercivity_test
