// Properties of every law: objectivity, the symmetries of the triangular network,
// refusals.
#include "continuum/errors.h"
#include "continuum/isotropic_network.h"
#include "continuum/network_gradient.h"
#include "sheets.h"
#include "support/largest_error.h"

#include <gtest/gtest.h>

#include <limits>

namespace laws_test
{

using namespace sheets;
using namespace latcon::continuum;
using Gradient = GradientLaw::Gradient;

const double epsilon = std::numeric_limits<double>::epsilon();
constexpr double spacing = 0.625e-3;

// Symmetry group of a triangular network: rotations by 60 degrees, and reflections in lines along and across its rows.
// A reflection of both configurations, by R on the left, keeps det F positive.
struct Symmetry
{
  Tensor<2, 2> Q, R;
};

std::vector<Symmetry> hexagonal_group()
{
  std::vector<Symmetry> group;
  for (unsigned int n = 0; n < 6; ++n)
    for (const double mirror : {1., -1.})
    {
      const Tensor<2, 2> M = matrix(1., 0., 0., mirror);
      group.push_back({rotation(n * pi / 3.) * M, M});
    }
  return group;
}

template <class Law>
struct Named
{
  std::string name;
  std::shared_ptr<const Law> law;
  friend std::ostream &operator<<(std::ostream &out, const Named &named) { return out << named.name; }
};

class EveryMaterial : public testing::TestWithParam<Named<Material>>
{
protected:
  const Material &law = *GetParam().law;
  std::mt19937 generator{11};
};

TEST_P(EveryMaterial, IsObjectiveWithSymmetricStressAndTangent)
{
  for (int sample = 0; sample < 50; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator), R = rotation(0.1 + 0.12 * sample);
    const Tensor<2, 2> P = law.first_piola_stress(F);
    const Tensor<4, 2> T = law.tangent(F);
    const double tolerance = 100. * epsilon * T.norm() * F.norm_square();
    EXPECT_NEAR(law.energy(R * F), law.energy(F), tolerance);
    EXPECT_NEAR((law.first_piola_stress(R * F) - R * P).norm(), 0., tolerance);
    EXPECT_NEAR(law.thickness_stretch(R * F), law.thickness_stretch(F), 100. * epsilon);
    // Angular momentum: P F^T is symmetric.
    const Tensor<2, 2> tau = P * transpose(F);
    EXPECT_NEAR(tau[0][1], tau[1][0], tolerance);
    for (unsigned int i = 0; i < 16; ++i)
      EXPECT_NEAR(T[i / 8][i / 4 % 2][i / 2 % 2][i % 2], T[i / 2 % 2][i % 2][i / 8][i / 4 % 2],
                  10. * epsilon * T.norm());
  }
}

TEST_P(EveryMaterial, RefusesNonPositiveDeterminant)
{
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const Tensor<2, 2> &F : {matrix(1., 0., 0., -1.25), matrix(1., 2., 2., 4.), matrix(nan, 0., 0., 1.),
                                matrix(infinity, 0., 0., 1.), Tensor<2, 2>()})
  {
    EXPECT_THROW(law.energy(F), NonPhysicalState);
    EXPECT_THROW(law.first_piola_stress(F), NonPhysicalState);
    EXPECT_THROW(law.tangent(F), NonPhysicalState);
    EXPECT_THROW(law.thickness_stretch(F), NonPhysicalState);
  }
  try
  {
    law.energy(matrix(1., 0., 0., -1.25));
  }
  catch (const NonPhysicalState &failure)
  {
    EXPECT_NE(std::string(failure.what()).find("-1.25"), std::string::npos) << failure.what();
  }
}

const CauchyBorn mixed_network({{Tensor<1, 2>({1., 0.}), 0.7, RodPotential{1e5, 1.5e5}},
                                {Tensor<1, 2>({0.6, 0.8}), 1.1, LinearPotential{2e5}},
                                {Tensor<1, 2>({-0.28, 0.96}), 0.4, RodPotential{2e5, -0.5e5}}});
const std::vector<Named<Material>> hexagonal{{"Network", std::make_shared<CauchyBorn>(rubber_network())},
                                             {"Sheet", std::make_shared<MooneyRivlin>(rubber_sheet())},
                                             {"Mean", std::make_shared<IsotropicNetwork>(mixed_network.families())}};

INSTANTIATE_TEST_SUITE_P(Hexagonal, EveryMaterial, testing::ValuesIn(hexagonal));
INSTANTIATE_TEST_SUITE_P(Mixed, EveryMaterial,
                         testing::Values(Named<Material>{"Mixed", std::make_shared<CauchyBorn>(mixed_network)}));

class HexagonalMaterial : public testing::TestWithParam<Named<Material>>
{
};

TEST_P(HexagonalMaterial, HasTheSymmetriesOfTheTriangularNetwork)
{
  const Material &law = *GetParam().law;
  std::mt19937 generator(1);
  for (int sample = 0; sample < 20; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator), P = law.first_piola_stress(F);
    const Tensor<4, 2> T = law.tangent(F);
    const double tolerance = 100. * epsilon * T.norm() * F.norm_square();
    for (const auto &[Q, R] : hexagonal_group())
    {
      const Tensor<2, 2> there = R * F * transpose(Q);
      EXPECT_NEAR(law.energy(there), law.energy(F), tolerance);
      EXPECT_NEAR((law.first_piola_stress(there) - R * P * transpose(Q)).norm(), 0., tolerance);
      // G : T : G at F is (R G Q^T) : T' : (R G Q^T).
      const Tensor<2, 2> G = matrix(0.3, -0.2, 0.5, 0.1), H = R * G * transpose(Q);
      EXPECT_NEAR(scalar_product(H, dealii::double_contract<2, 0, 3, 1>(law.tangent(there), H)),
                  scalar_product(G, dealii::double_contract<2, 0, 3, 1>(T, G)), tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, HexagonalMaterial, testing::ValuesIn(hexagonal));

// The network is anisotropic; a sheet of rubber and the mean over directions are isotropic.
TEST(Material, OnlyTheNetworkKnowsATwelfthOfATurn)
{
  for (const auto &[name, law] : hexagonal)
  {
    std::mt19937 generator(2);
    double largest = 0.;
    for (int sample = 0; sample < 20; ++sample)
    {
      const Tensor<2, 2> F = random_deformation(generator, 1.5, 3.), turned = F * transpose(rotation(pi / 6.));
      largest = latcon::support::largest_of({largest, std::abs(law->energy(turned) / law->energy(F) - 1.)});
    }
    EXPECT_EQ(largest > 1e-4, name == "Network") << largest;
    EXPECT_EQ(largest < 100. * epsilon, name != "Network") << name << ' ' << largest;
  }
}

class EveryGradientLaw : public testing::TestWithParam<Named<GradientLaw>>
{
protected:
  const GradientLaw &law = *GetParam().law;
  std::mt19937 generator{5};
  Tensor<2, 2> F;
  Gradient G;

  // Draws a state with principal stretches from `low` to `high`.
  void draw(const double low, const double high)
  {
    F = random_deformation(generator, low, high);
    G = random_gradient(generator, spacing);
  }

  static Gradient rotated(const Tensor<2, 2> &R, const Gradient &G)
  {
    Gradient result;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int j = 0; j < 2; ++j)
        result[i] += R[i][j] * G[j];
    return result;
  }

  // Checks that the law is the same at R F Q^T, with gradients G'_iJK = R_ij G_jLM Q_JL Q_KM.
  void expect_same(const Tensor<2, 2> &R, const Tensor<2, 2> &Q, const double digits)
  {
    const auto moved = [&](const Gradient &gradient)
    {
      Gradient seen;
      for (unsigned int i = 0; i < 2; ++i)
        seen[i] = Q * gradient[i] * transpose(Q);
      return rotated(R, seen);
    };
    const double scale = law.energy(F, G);
    const Tensor<2, 2> there = R * F * transpose(Q);
    EXPECT_NEAR(law.energy(there, moved(G)), scale, digits * scale);
    EXPECT_NEAR((law.first_piola_stress(there, moved(G)) - R * law.first_piola_stress(F, G) * transpose(Q)).norm(), 0.,
                10. * digits * scale);
    EXPECT_NEAR((law.double_stress(there, moved(G)) - moved(law.double_stress(F, G))).norm(), 0.,
                10. * digits * scale * spacing);
  }
};

TEST_P(EveryGradientLaw, IsObjective)
{
  for (int sample = 0; sample < 30; ++sample)
  {
    draw(0.7, 3.5);
    expect_same(rotation(0.1 + 0.2 * sample), matrix(1., 0., 0., 1.), 300. * epsilon);
  }
}

// The mean over 32 directions has the symmetries up to the 32nd power of (l1 - l2)/(l1 + l2), which is below 1/2.
TEST_P(EveryGradientLaw, HasTheSymmetriesOfTheTriangularNetwork)
{
  for (int sample = 0; sample < 20; ++sample)
  {
    draw(1.1, 3.);
    for (const auto &[Q, R] : hexagonal_group())
      expect_same(R, Q, GetParam().name == "Mean" ? 1e-8 : 300. * epsilon);
  }
}

TEST_P(EveryGradientLaw, VanishesInHomogeneousDeformation)
{
  draw(1.1, 3.);
  EXPECT_EQ(law.energy(F, Gradient()), 0.);
  EXPECT_EQ(law.first_piola_stress(F, Gradient()).norm(), 0.);
  EXPECT_EQ(law.double_stress(F, Gradient()).norm(), 0.);
  EXPECT_EQ(law.evaluate(F, Gradient(), Order::second).tangent.norm(), 0.);
}

TEST_P(EveryGradientLaw, HasSymmetricSecondDerivatives)
{
  draw(1.1, 3.);
  EXPECT_EQ(law.energy(F, 4. * G), 16. * law.energy(F, G));
  const Tensor<4, 2> T = law.evaluate(F, G, Order::second).tangent;
  const Tensor<6, 2> Q_by_G = law.double_stress_by_G(F);
  for (unsigned int n = 0; n < 64; ++n)
  {
    const unsigned int i = n / 32, J = n / 16 % 2, k = n / 8 % 2, L = n / 4 % 2, M = n / 2 % 2, N = n % 2;
    EXPECT_NEAR(T[i][J][k][L], T[k][L][i][J], 100. * epsilon * T.norm());
    EXPECT_NEAR(Q_by_G[i][J][M][k][L][N], Q_by_G[k][L][N][i][J][M], 100. * epsilon * Q_by_G.norm());
    EXPECT_NEAR(Q_by_G[i][J][M][k][L][N], Q_by_G[i][M][J][k][L][N], 100. * epsilon * Q_by_G.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(
  Laws, EveryGradientLaw,
  testing::Values(Named<GradientLaw>{"Lattice", std::make_shared<LatticeGradient>(rubber_gradient(spacing))},
                  Named<GradientLaw>{"Isotropic", std::make_shared<IsotropicGradient>(5e5, 0.4 * spacing)},
                  Named<GradientLaw>{
                    "Mean",
                    std::make_shared<NetworkGradient>(rubber_bonds(spacing),
                                                      NetworkGradient::smallest_length(rubber_bonds(spacing)))}));

} // namespace laws_test
