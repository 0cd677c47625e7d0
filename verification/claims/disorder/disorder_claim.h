#pragma once

#include <array>
#include <functional>

#include "lattice/state.h"
#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Size of the claim.
struct DisorderOptions
{
  lattice::Disorder disorder = {};                               ///< of the case; its strength does not matter
  std::size_t n_sheets = 24;                                     ///< with different seeds, at least 2
  std::size_t columns = 24;                                      ///< sites along and rows across a periodic sheet, even
  std::function<void(lattice::State &)> planted = [](auto &) {}; ///< changes a sheet before it relaxes; for tests
};

/// Widest distribution of stiffness for which the claim is checked [-]; a wider one is taken with this width.
inline constexpr double widest_checked_disorder = 0.1;

/// Claim `disorder`: energy of periodic sheets with disorder of the stiffness, relaxed at a small dilation and a small
/// shear about the undeformed state, over the energy at homogeneous deformation (theory-comparison.md, eqs. (H.21) to
/// (H.24)): bounds of Voigt and Reuss for every sheet, and the effective medium for the mean over sheets; mean and
/// standard deviation of the factors of the bonds. Tolerances are sampling errors and the order of the effective
/// medium.
ClaimOutcome disorder_claim(const bridge::Subject &subject, const DisorderOptions &options);

/// Mean of a function of the factor of a bond over its distribution, from the density and not from random numbers.
/// @param distribution not none
double mean_over(const lattice::Distribution &distribution, const std::function<double(double)> &function);

/// Effective medium of the bonds of a periodic, undeformed sheet (theory-comparison.md, eqs. (H.22)
/// and (H.23)): of each kind the
/// factor of the stiffness, and the share a of a bond in its own response.
struct EffectiveMedium
{
  std::array<double, lattice::n_bond_kinds> factor{}; ///< [-]; 0 for kinds that the material lacks
  std::array<double, lattice::n_bond_kinds> share{};  ///< [-]
};

/// Solves the equations of the effective medium, with the sum over all wave vectors of the sheet.
/// @param sheet periodic in both directions
EffectiveMedium effective_medium(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                 const lattice::Distribution &distribution);

} // namespace latcon::claims
