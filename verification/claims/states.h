/// Homogeneous states at which claims compare energies, stresses, moduli and waves.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "support/largest_error.h"
#include "support/text_wrap.h"
#include "verification/bridge/subject.h"
#include "verification/claims/claim_inputs.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Names of the waves of a direction, as Bloch matrices and Christoffel tensors order them: quasi-longitudinal,
/// quasi-shear.
inline const std::string wave_names[] = {"L", "S"};

/// Strain below which claims about loaded sheets take another state: 100 epsilon of it are round-off of stretches.
inline constexpr double smallest_strain = 1e-2;

/// Name of a homogeneous state in rows and plots: "F = I", "F = (2.3, 2.8)", "F = (1, 1, shear 0.5)".
inline std::string state_name(const Eigen::Matrix2d &F)
{
  if (F.isIdentity(1e-12))
    return "F = I";
  return support::text_of("F = (", F(0, 0), ", ", F(1, 1), F(0, 1) != 0. ? support::text_of(", shear ", F(0, 1)) : "",
                          ")");
}

/// Deformation gradients about which waves are evaluated: undeformed; in the full version stretched equally along both
/// axes; and as the case is loaded, unless the loaded lattice buckles and has no waves.
inline std::vector<Eigen::Matrix2d> wave_states(const bridge::Subject &subject, bool quick)
{
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  std::vector<Eigen::Matrix2d> list{I};
  if (!quick && !subject.deformation.isApprox(I, 1e-12))
    list.emplace_back(1.5 * I);
  if (subject.is_stable() && !subject.deformation.isApprox(I, 1e-12))
    list.push_back(subject.deformation);
  return list;
}

/// Row of a claim on the stability of the loaded lattice against waves of every length, which every comparison of the
/// loaded sheet assumes. The error is the distance of the smallest w^2 / k^2 below zero.
inline output::Result stability_row(const bridge::Subject &subject, const std::string &claim)
{
  std::string quantity =
    subject.name + ": stability of the loaded lattice, smallest w^2/k^2 of all waves over c_S^2 at F = I";
  const Eigen::Vector2d &K = subject.slowest_wave.wave_vector;
  if (!subject.is_stable())
    quantity += support::text_of("; it buckles in waves of kd = ", std::round(100. * K.norm() * subject.spacing) / 100.,
                                 " at ", std::lround(std::atan2(K.y(), K.x()) * 180. / M_PI), " degrees");
  const double smallest = subject.slowest_wave.squared_speed / std::pow(subject.theory.shear_speed, 2);
  // At zero the lattice is about to buckle, and counts as unstable.
  const double error = subject.is_stable() ? 0. : support::largest_of({-smallest, 1e-15});
  return {claim, quantity, "1", smallest, {}, {}, error, {0., "a sign"}};
}

/// Returns by how much the first order that the gradient continuum leaves out, (k l)^4 / 480 of the speed for a bond of
/// length l along the wave [-], is larger than with bonds of sqrt(3) d at most: (2 / sqrt(3))^4 with third-nearest
/// neighbours, otherwise 1. A factor of tolerances at a wave number k.
inline double gradient_remainder(const bridge::Subject &subject)
{
  return subject.material.third_nearest ? 16. / 9. : 1.;
}

/// Returns rotations times stretches between 0.7 and 3.5 times rotations, the same on every machine.
inline std::vector<Eigen::Matrix2d> random_deformations(unsigned int n)
{
  std::mt19937_64 generator(20061111);
  // The same on every machine, unlike std's distributions.
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  const auto rotation = [&] { return Eigen::Rotation2Dd(2. * M_PI * uniform()).toRotationMatrix(); };
  constexpr double smallest = 0.7, range = 2.8;
  static_assert(smallest + range <= largest_stretch);
  const auto stretch = [&] { return smallest + range * uniform(); };
  std::vector<Eigen::Matrix2d> list;
  for (unsigned int i = 0; i < n; ++i)
  {
    const Eigen::Matrix2d outer = rotation(), inner = rotation();
    const double first = stretch(), second = stretch();
    list.emplace_back(outer * Eigen::Vector2d(first, second).asDiagonal() * inner);
  }
  return list;
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

/// Returns psi''(1) [Pa] of a bond law, as below.
[[nodiscard]] inline double stiffness_at_rest(const lattice::BondLaw &law)
{
  if (const auto *rod = std::get_if<lattice::MooneyRivlinBond>(&law))
    return 3. * (rod->a + rod->b);
  if (const auto *spring = std::get_if<lattice::LinearBond>(&law))
    return spring->modulus;
  // Fourth order: errors of 1e-12 times higher derivatives, and of round-off over the step.
  constexpr double h = 1e-3;
  const auto force = [&](double offset) { return lattice::force(law, 1. + offset); };
  return (8. * (force(h) - force(-h)) - (force(2. * h) - force(-2. * h))) / (12. * h);
}

/// Returns the shear modulus mu [Pa] of an undeformed lattice from the constants of its bonds alone: 3/8 of the sum of
/// s (l / d) psi''(1) over its shells, l = d, sqrt(3) d and 2 d, with psi''(1) = 3 (a + b) for Mooney-Rivlin bonds, the
/// modulus for linear ones, and differences of the force for user-defined ones (theory-comparison.md, eq. (H.2)).
/// Nothing of it is shared with the lattice or its homogenisation, so that an error in a cross-section, which both have
/// in common, shows.
[[nodiscard]] inline double absolute_shear_modulus(const lattice::Material &material)
{
  const double lengths[lattice::n_shells] = {1., std::sqrt(3.), 2.}; // over d
  double sum = 0.;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      sum += shell->area_factor * lengths[number] * stiffness_at_rest(shell->law);
  return 3. / 8. * sum;
}

} // namespace latcon::claims
