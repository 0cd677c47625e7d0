// Laws of a triangular network must be invariant under the symmetries of the lattice and under a change of units. For
// units that are powers of two, bits must not change either. Objectivity is tested in materials_test.cc and
// gradient_laws_test.cc.
#include "moving_sheets.h"
#include "support/largest_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace continuum_symmetry_test
{

using namespace latcon;
using namespace moving_sheets;
using continuum::GradientLaw;
using continuum::Material;
using Gradient = GradientLaw::Gradient;

const double epsilon = std::numeric_limits<double>::epsilon();
constexpr double spacing = 0.625e-3;

// Transforms to X' with X = Q^T X', Q orthogonal: F' = F Q^T and G'_iJK = G_iLM Q_JL Q_KM.
Gradient seen_from(const Tensor<2, 2> &Q, const Gradient &G)
{
  Gradient result;
  for (unsigned int i = 0; i < 2; ++i)
    result[i] = Q * G[i] * transpose(Q);
  return result;
}

// Symmetry group of a triangular network: rotations by 60 degrees, and reflections in lines along and across its rows.
std::vector<Tensor<2, 2>> hexagonal_group()
{
  std::vector<Tensor<2, 2>> group;
  for (unsigned int n = 0; n < 6; ++n)
    for (const double mirror : {1., -1.})
      group.push_back(rotation(n * pi / 3.) * matrix(1., 0., 0., mirror));
  return group;
}

// Laws, two of each kind.
struct Laws
{
  continuum::CauchyBorn network = rubber_network();
  continuum::MooneyRivlin sheet = rubber_sheet();
  continuum::LatticeGradient lattice = rubber_gradient(spacing);
  continuum::IsotropicGradient isotropic{5e5, 0.4 * spacing};
  std::vector<const Material *> materials() const { return {&network, &sheet}; }
  std::vector<const GradientLaw *> gradients() const { return {&lattice, &isotropic}; }
};

TEST(MaterialSymmetry, LocalLawsAreThoseOfTheHexagonalNetwork)
{
  const Laws laws;
  std::mt19937 generator(1);
  for (const Material *law : laws.materials())
    for (int sample = 0; sample < 20; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator);
      const Tensor<2, 2> P = law->first_piola_stress(F);
      const Tensor<4, 2> T = law->tangent(F);
      const double scale = T.norm() * F.norm_square();
      for (const Tensor<2, 2> &Q : hexagonal_group())
      {
        const Tensor<2, 2> turned = F * transpose(Q);
        if (determinant(turned) < 0.) // a reflection of both configurations is a valid deformation
        {
          const Tensor<2, 2> M = matrix(1., 0., 0., -1.);
          EXPECT_NEAR(law->energy(M * turned), law->energy(F), 100. * epsilon * scale);
          EXPECT_NEAR((law->first_piola_stress(M * turned) - M * P * transpose(Q)).norm(), 0., 100. * epsilon * scale);
          continue;
        }
        EXPECT_NEAR(law->energy(turned), law->energy(F), 100. * epsilon * scale);
        EXPECT_NEAR((law->first_piola_stress(turned) - P * transpose(Q)).norm(), 0., 100. * epsilon * scale);
        // G : T : G at F is (G Q^T) : T' : (G Q^T).
        const Tensor<2, 2> G = matrix(0.3, -0.2, 0.5, 0.1);
        const Tensor<2, 2> H = G * transpose(Q);
        EXPECT_NEAR(scalar_product(H, dealii::double_contract<2, 0, 3, 1>(law->tangent(turned), H)),
                    scalar_product(G, dealii::double_contract<2, 0, 3, 1>(T, G)), 100. * epsilon * scale);
      }
    }
}

// The network is anisotropic; a sheet of rubber is isotropic.
TEST(MaterialSymmetry, OnlyTheNetworkKnowsATwelfthOfATurn)
{
  const Laws laws;
  std::mt19937 generator(2);
  double network = 0., sheet = 0.;
  for (int sample = 0; sample < 20; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator, 1.5, 3.);
    const Tensor<2, 2> turned = F * transpose(rotation(pi / 6.));
    network = support::largest_of({network, std::abs(laws.network.energy(turned) / laws.network.energy(F) - 1.)});
    sheet = support::largest_of({sheet, std::abs(laws.sheet.energy(turned) / laws.sheet.energy(F) - 1.)});
  }
  EXPECT_GT(network, 1e-4);
  EXPECT_LT(sheet, 100. * epsilon);
}

TEST(MaterialSymmetry, GradientLawsAreThoseOfTheHexagonalNetwork)
{
  const Laws laws;
  const Tensor<2, 2> M = matrix(1., 0., 0., -1.);
  std::mt19937 generator(3);
  for (const GradientLaw *law : laws.gradients())
    for (int sample = 0; sample < 20; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator, 1.1, 3.);
      const Gradient G = random_gradient(generator, spacing), Z = random_gradient(generator, spacing);
      const double scale = law->energy(F, G) + law->energy(F, Z);
      for (const Tensor<2, 2> &Q : hexagonal_group())
      {
        // Reflect both configurations, so that det F remains positive.
        const Tensor<2, 2> R = determinant(Q) < 0. ? M : identity;
        const auto moved = [&](const Gradient &gradient)
        {
          const Gradient seen = seen_from(Q, gradient);
          Gradient result;
          for (unsigned int i = 0; i < 2; ++i)
            for (unsigned int j = 0; j < 2; ++j)
              result[i] += R[i][j] * seen[j];
          return result;
        };
        const Tensor<2, 2> there = R * F * transpose(Q);
        EXPECT_NEAR(law->form(there, moved(G), moved(Z)), law->form(F, G, Z), 300. * epsilon * scale);
        EXPECT_NEAR(
          (law->first_piola_stress(there, moved(G)) - R * law->first_piola_stress(F, G) * transpose(Q)).norm(), 0.,
          3000. * epsilon * scale);
        EXPECT_NEAR((law->double_stress(there, moved(G)) - moved(law->double_stress(F, G))).norm(), 0.,
                    3000. * epsilon * scale * spacing);
      }
    }
}

TEST(GradientLaw, HasSymmetricForms)
{
  const Laws laws;
  std::mt19937 generator(4);
  for (const GradientLaw *law : laws.gradients())
    for (int sample = 0; sample < 20; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator, 1.1, 3.);
      const Gradient G = random_gradient(generator, spacing), Z = random_gradient(generator, spacing);
      const double scale = law->energy(F, G) + law->energy(F, Z);
      EXPECT_NEAR(law->form(F, G, Z), law->form(F, Z, G), 100. * epsilon * scale);
      EXPECT_EQ(law->form(F, G, 4. * Z), 4. * law->form(F, G, Z));
      EXPECT_EQ(law->energy(F, 4. * G), 16. * law->energy(F, G));
      const Tensor<4, 2> T = law->tangent(F, G);
      const Tensor<6, 2> Q_by_G = law->double_stress_by_G(F);
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int J = 0; J < 2; ++J)
          for (unsigned int k = 0; k < 2; ++k)
            for (unsigned int L = 0; L < 2; ++L)
            {
              EXPECT_NEAR(T[i][J][k][L], T[k][L][i][J], 100. * epsilon * T.norm());
              for (unsigned int M = 0; M < 2; ++M)
                for (unsigned int N = 0; N < 2; ++N)
                {
                  EXPECT_NEAR(Q_by_G[i][J][M][k][L][N], Q_by_G[k][L][N][i][J][M], 100. * epsilon * Q_by_G.norm());
                  EXPECT_NEAR(Q_by_G[i][J][M][k][L][N], Q_by_G[i][M][J][k][L][N], 100. * epsilon * Q_by_G.norm());
                }
            }
    }
}

// Lengths 4 times and stresses 8 times larger: factors 1/4 for gradients, 32 for double stresses, 128 for gradient
// stiffnesses.
TEST(GradientLaw, DoesNotDependOnUnits)
{
  constexpr double l = 4., e = 8.;
  const Laws laws;
  const continuum::CauchyBorn network = rubber_network(e * 1e5, e * 1.5e5);
  std::vector<continuum::BondFamily> bonds = rubber_bonds(l * spacing);
  for (std::size_t k = 0; k < bonds.size(); ++k)
    bonds[k].fibre = network.families()[k];
  const continuum::LatticeGradient lattice(bonds, continuum::LatticeGradient::smallest_length(bonds));
  const continuum::IsotropicGradient isotropic(e * 5e5, l * 0.4 * spacing);
  const std::vector<const GradientLaw *> own = laws.gradients(), others{&lattice, &isotropic};
  std::mt19937 generator(5);
  for (std::size_t n = 0; n < others.size(); ++n)
    for (int sample = 0; sample < 20; ++sample)
    {
      const GradientLaw &law = *own[n], &other = *others[n];
      const Tensor<2, 2> F = random_deformation(generator, 1.1, 3.);
      const Gradient G = random_gradient(generator, spacing), Z = random_gradient(generator, spacing);
      EXPECT_EQ(other.energy(F, G / l), e * law.energy(F, G));
      EXPECT_EQ(other.form(F, G / l, Z / l), e * law.form(F, G, Z));
      EXPECT_EQ(other.first_piola_stress(F, G / l), e * law.first_piola_stress(F, G));
      EXPECT_EQ(other.tangent(F, G / l), e * law.tangent(F, G));
      EXPECT_EQ(other.double_stress(F, G / l), e * l * law.double_stress(F, G));
      EXPECT_EQ(other.double_stress_by_F(F, G / l), e * l * law.double_stress_by_F(F, G));
      EXPECT_EQ(other.double_stress_by_G(F), e * l * l * law.double_stress_by_G(F));
      EXPECT_EQ(other.normal_stiffness(), e * l * l * law.normal_stiffness());
      EXPECT_EQ(network.energy(F), e * laws.network.energy(F));
      EXPECT_EQ(network.first_piola_stress(F), e * laws.network.first_piola_stress(F));
      EXPECT_EQ(network.tangent(F), e * laws.network.tangent(F));
    }
}

// Units of a sheet relative to those of another one. The equation of motion, r u / t^2 = e / l, determines the unit of
// time; a viscosity is a stress times a time.
struct Units
{
  double length, stress, density;
  double time() const { return length * std::sqrt(density / stress); }
};

// Sheet with all quantities that have units: mass with micro-inertia, both laws, dashpots, a moving edge, a traction, a
// weak normal gradient.
struct MovingSheet
{
  explicit MovingSheet(const Units &units)
    : network(rubber_network(units.stress * 1e5, units.stress * 1.5e5)), gradient(bonds(units), l_d(units)),
      viscosity(network_viscosity(units.stress * units.time() * 20.)), mesh(MPI_COMM_SELF)
  {
    continuum::make_rectangle(mesh, {units.length * length, units.length * height, 2, 2});
    continuum::BoundaryConditions conditions({{continuum::edge::left, affine(matrix(1., 0., 0.3, 1.2))}});
    conditions.tractions = {{continuum::edge::top, constant(0., units.stress * 1e5)}};
    conditions.normal_gradients = {{continuum::edge::right, constant(0.2, 0.1)}};
    const double t = units.time();
    continuum::DynamicSettings settings{t * 2e-4};
    settings.degree = 2;
    settings.rule = continuum::NewmarkParameters::generalised_alpha(0.6);
    solver = std::make_unique<continuum::DynamicSolver>(
      mesh, continuum::Constitution(network, gradient), conditions,
      continuum::Inertia{units.density * density, l_d(units)}, settings, &viscosity,
      [t](const double time) { return std::pow(std::sin(100. * pi * time / t), 4); });
    solver->start();
    for (unsigned int n = 0; n < 20; ++n)
      solver->step();
  }

  std::vector<continuum::BondFamily> bonds(const Units &units) const
  {
    auto all = rubber_bonds(units.length * 0.02);
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k].fibre = network.families()[k];
    return all;
  }
  double l_d(const Units &units) const { return continuum::LatticeGradient::smallest_length(bonds(units)); }

  continuum::CauchyBorn network;
  continuum::LatticeGradient gradient;
  continuum::FibreViscosity viscosity;
  Mesh mesh;
  std::unique_ptr<continuum::DynamicSolver> solver;
};

// All units are powers of two, so both runs have equal mantissas everywhere: in the elements, in the factors of the
// matrix and in all compared norms.
TEST(DynamicSolver, DoesNotDependOnUnits)
{
  const MovingSheet one_sheet({1., 1., 1.});
  const auto &one = one_sheet.solver;
  EXPECT_GT(one->displacement().linfty_norm(), 0.01 * length);
  EXPECT_NE(one->ledger().dissipated, 0.);
  for (const Units &units : {Units{4., 1., 1.}, Units{1., 4., 16.}, Units{0.5, 16., 4.}})
  {
    const MovingSheet other_sheet(units);
    const auto &other = other_sheet.solver;
    const double l = units.length, per_energy = 1. / (units.stress * l * l);
    for (const auto i : one->displacement().locally_owned_elements())
    {
      ASSERT_EQ(other->displacement()(i), l * one->displacement()(i));
      ASSERT_EQ(other->velocity()(i), l / units.time() * one->velocity()(i));
    }
    EXPECT_EQ(per_energy * other->ledger().stored, one->ledger().stored);
    EXPECT_EQ(per_energy * other->ledger().kinetic, one->ledger().kinetic);
    EXPECT_EQ(per_energy * other->ledger().micro_kinetic, one->ledger().micro_kinetic);
    EXPECT_EQ(per_energy * other->ledger().dissipated, one->ledger().dissipated);
    EXPECT_EQ(per_energy * other->ledger().work, one->ledger().work);
  }
}

} // namespace continuum_symmetry_test
