/// Homogeneous deformations at which claims compare energies, stresses and moduli.
#pragma once

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "verification/claims/claim_inputs.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Returns a rotation times stretches between 0.7 and 3.5 times a rotation, the same on every machine.
inline Eigen::Matrix2d random_deformation(std::mt19937_64 &generator)
{
  // The same on every machine, unlike std's distributions.
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  const auto rotation = [&] { return Eigen::Rotation2Dd(2. * M_PI * uniform()).toRotationMatrix(); };
  constexpr double smallest = 0.7, range = 2.8;
  static_assert(smallest + range <= largest_stretch);
  const auto stretch = [&] { return smallest + range * uniform(); };
  const Eigen::Matrix2d outer = rotation(), inner = rotation();
  const double first = stretch(), second = stretch();
  return outer * Eigen::Vector2d(first, second).asDiagonal() * inner;
}

/// Error of stress_derivative().
inline const output::Tolerance small_strain_tolerance{
  1e-9, "fourth-order differences with a strain of 1e-3: 1e-12 of higher moduli, round-off over the strain"};

/// Returns dP_iJ / dF_kL at F = I for one (k, L). @param stress first Piola stress as a function of F
template <class Stress>
Eigen::Matrix2d stress_derivative(const Stress &stress, int k, int L)
{
  constexpr double h = 1e-3;
  const auto at = [&](double amount)
  {
    Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
    F(k, L) += amount;
    return Eigen::Matrix2d(stress(F));
  };
  return (8. * (at(h) - at(-h)) - (at(2. * h) - at(-2. * h))) / (12. * h);
}

} // namespace latcon::claims
