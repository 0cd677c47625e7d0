// Isotropic gradient energy of a network, compared with that of the rotated lattice.
#include "continuum/network_gradient.h"
#include "gradient_checks.h"

#include <tuple>

namespace network_gradient_test
{

using namespace latcon;
using namespace gradient_checks;
using continuum::NetworkGradient;

// theory-continuum.md, eq. (C.57): mean of the lattice energy over all rotations of the reference configuration, here a
// sum over 64 rotations. The 32 directions of the law differ from the mean by rho^32, rho = (l1 - l2)/(l1 + l2), times
// a power of 32 for the derivatives: by 5e-33 and 2e-11 times that.
TEST(NetworkGradient, IsTheMeanOfTheLatticeOverAllDirections)
{
  const auto bonds = rubber_bonds(spacing);
  const double l_d = LatticeGradient::smallest_length(bonds);
  const NetworkGradient law(bonds, l_d);
  std::mt19937 generator(12);
  for (const auto &[l1, l2, digits] : {std::tuple{2.3, 2.8, 1e-12}, std::tuple{3., 1.1, 1e-7}})
  {
    const Tensor<2, 2> F = rotation(0.4) * matrix(l1, 0., 0., l2) * rotation(0.7);
    const Gradient G = random_gradient(generator, spacing);
    constexpr unsigned int n = 64;
    double energy = 0.;
    Tensor<2, 2> by_F;
    Gradient Q;
    Tensor<6, 2> Q_by_G;
    for (unsigned int k = 0; k < n; ++k)
    {
      auto turned_bonds = bonds;
      for (BondFamily &bond : turned_bonds)
      {
        bond.fibre.direction = rotation(pi * k / n) * bond.fibre.direction;
        bond.fibre.weight /= n;
      }
      const LatticeGradient turned_law(turned_bonds, l_d);
      const auto turned_W = turned_law.evaluate(F, G, Order::second);
      energy += turned_W.energy;
      by_F += turned_W.first_piola;
      Q += turned_W.double_stress;
      Q_by_G += turned_W.double_stress_by_G;
    }
    const auto W = law.evaluate(F, G, Order::second);
    EXPECT_NEAR(W.energy, energy, digits * energy);
    EXPECT_NEAR((W.first_piola - by_F).norm(), 0., 10. * digits * energy);
    EXPECT_NEAR((W.double_stress - Q).norm(), 0., digits * Q.norm());
    EXPECT_NEAR((W.double_stress_by_G - Q_by_G).norm(), 0., digits * Q_by_G.norm());
  }
}

// Bonds with different potentials are not merged.
TEST(NetworkGradient, FormsAreDerivativesOfTheEnergy)
{
  const auto bonds = mixed_bonds();
  const double l_d = 1.1 * LatticeGradient::smallest_length(bonds);
  std::vector<BondFamily> in_all_directions;
  for (BondFamily bond : bonds)
    for (unsigned int k = 0; k < NetworkGradient::n_directions; ++k)
    {
      const double angle = pi * k / NetworkGradient::n_directions;
      in_all_directions.push_back(bond);
      in_all_directions.back().fibre.direction = Tensor<1, 2>({std::cos(angle), std::sin(angle)});
      in_all_directions.back().fibre.weight /= NetworkGradient::n_directions;
    }
  expect_derivatives(NetworkGradient(bonds, l_d),
                     [&](const auto &v) { return lattice_energy(in_all_directions, l_d, v); });
}

// theory-continuum.md, eq. (C.58). With G_iJK = p_i delta_JK, G is completely along the bonds for every direction.
TEST(NetworkGradient, HasTheMeanSquaredLengthOfLikeBonds)
{
  const auto bonds = rubber_bonds(spacing);
  const double mean_square = (1. + 3. * std::sqrt(3.)) / (1. + std::sqrt(3.)) * spacing * spacing;
  const double least = NetworkGradient::smallest_length(bonds);
  EXPECT_NEAR(least, std::sqrt(mean_square / 12.), 10. * epsilon * spacing);
  Gradient G;
  G[0][0][0] = G[0][1][1] = 0.1 / spacing;
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  const double mu = rubber_network().tangent(I)[0][1][0][1];
  EXPECT_NEAR(NetworkGradient(bonds, least).energy(I, G), 0., 100. * epsilon * mu);
  EXPECT_GT(NetworkGradient(bonds, 1.01 * least).energy(I, G), 1e-6 * mu);
  EXPECT_THROW(NetworkGradient(bonds, 0.999 * least), continuum::InvalidMaterial);
  // With a third potential on additional bonds, the longest mean determines the result.
  EXPECT_NEAR(NetworkGradient::smallest_length(mixed_bonds()), 1.3 * spacing / std::sqrt(12.), 10. * epsilon * spacing);
}

} // namespace network_gradient_test
