#pragma once

#include <memory>
#include <string>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"
#include "verification/claims/running_crack/continuum_crack.h"

namespace latcon::claims
{

/// Sizes in spacings d, and resolutions. The default is the quick version.
struct RunningCrackOptions
{
  double length = 46.;
  double height = 30.;  ///< of the whole sheet
  double start = 12.;   ///< distance of the start from the left edge
  double advance = 21.; ///< of the tip
  double far = 9.;      ///< outer radius of the far field, whose inner radius is 5
  double finest = 1.;   ///< approximate size of cells along the path; a second mesh has cells twice as large
  unsigned degree = 2;  ///< of the elements
  bool anisotropic = false; ///< also the continua of the lattice's own laws
  std::string frames;       ///< folder for a frame of each side at the end of the drive; empty: none
};

/// The full version.
inline RunningCrackOptions full_running_crack()
{
  return {66., 48., 18., 30., 12., 0.5, 3, true, {}};
}

/// A continuum with its name in rows and tables.
struct NamedContinuum
{
  std::string name;
  CrackContinuum medium;
};

/// Both sides of the comparison: one lattice and several continua. The subject must outlive it.
struct CrackSides
{
  CrackDrive drive;
  HalfSheet half; ///< the continuum's sheet
  std::vector<std::shared_ptr<const continuum::Viscosity>> viscosities;
  /// "local", the network, which is judged; "gradient", with its gradient energy and micro-inertia;
  /// "viscous-gradient", with gradient viscosity as well; if asked for, "bonds-local", "bonds-gradient" and
  /// "bonds-viscous-gradient", the same with the Cauchy-Born law and gradient energy of the lattice.
  std::vector<NamedContinuum> continua;
};

/// The crack runs at half the speed of the slower plane wave along it in the loaded sheet.
CrackSides crack_sides(const bridge::Subject &subject, const RunningCrackOptions &options);

/// Compares a straight crack that is driven at the same speed through the lattice and through the continua of
/// CrackSides (theory-comparison.md, section "A running crack"). The far field of the local network is judged, the
/// others are reported. The sheet must be loaded without shear, and open the crack. The frame of a side is
/// NAME-SIDE.pvd, NAME being that of the subject in lower case ("crack-nn-nnn"); the table `running_crack_frames` has
/// the position of the tip in it. For other sheets the claim reports that there is no such crack.
ClaimOutcome running_crack_claim(const bridge::Subject &subject, const RunningCrackOptions &options);

/// Checks the claim for sides that a test has changed.
ClaimOutcome running_crack_claim(const bridge::Subject &subject, const CrackSides &sides,
                                 const RunningCrackOptions &options);

} // namespace latcon::claims
