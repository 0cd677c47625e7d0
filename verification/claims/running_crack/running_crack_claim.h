#pragma once

#include <string>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/rows.h"
#include "verification/claims/running_crack/tip_field.h"

namespace latcon::claims
{

/// Elements. The finest ones are four cells high over the crack; a time step is that of a stride.
struct CrackMesh
{
  double finest;           ///< cells along the path, in strides of the tip: a power of two [-]
  unsigned int degree = 3; ///< of the elements
};

/// The upper half of the sheet in the coordinates of the lattice, its lower edge on the line of the crack,
/// Y = CrackDrive::axis().
struct HalfSheet
{
  double left, right; ///< X of the held ends [m]
  double height;      ///< of the held upper edge above the crack [m]
  double tip = 0.;    ///< how far the tip is ahead of where the drive has it [m]
};

/// Drives the crack through the half sheet of a continuum without memory. Ahead of the tip the lower edge is on the
/// plane of symmetry: no displacement across it, no shear, and with a gradient energy no normal gradient of the
/// displacement along it. Behind the tip it is free. The edge is opened cell by cell: while the tip passes a cell, the
/// forces that held that cell's nodes fall linearly to zero.
/// @param cut bonds that, with their dashpots, are missing in part at the open edge, see continuum::Flank; empty: none.
/// The energy that they held is CrackEnergy::taken as well.
/// @param bonds Cauchy-Born law of the lattice, for TipValues::anisotropy
/// @param reach as for the lattice, at whose sites the fields are evaluated
/// @param frame none is written if empty
/// @throws continuum::SolverFailed, continuum::InvalidInput, continuum::OutputFailed
TipRun drive_continuum_crack(const CrackDrive &drive, const HalfSheet &half, const WaveContinuum &medium,
                             const std::vector<continuum::BondFamily> &cut, const continuum::Material &bonds,
                             const Eigen::Matrix2d &F, const CrackMesh &resolution, double reach,
                             const std::optional<CrackFrame> &frame = {});

/// Sizes in spacings d, and resolutions. The default is the quick version.
struct RunningCrackOptions
{
  double length = 46.;
  double height = 30.;      ///< of the whole sheet
  double start = 12.;       ///< distance of the start from the left edge
  double advance = 21.;     ///< of the tip
  double far = 9.;          ///< outer radius of the far field, whose inner radius is 5
  double finest = 1.;       ///< approximate size of cells along the path; a second mesh has cells twice as large
  unsigned degree = 2;      ///< of the elements
  bool anisotropic = false; ///< also the continua of the lattice's own laws
  std::string frames;       ///< folder for a frame of each side at the end of the drive; empty: none
};

/// A continuum with its name in rows and tables.
struct NamedContinuum
{
  std::string name;
  WaveContinuum medium;
  std::vector<continuum::BondFamily> cut = {}; ///< that the flank lacks in part, see continuum::Flank; empty: none
};

/// Both sides of the comparison: one lattice and several continua. The subject must outlive it.
struct CrackSides
{
  CrackDrive drive;
  HalfSheet half; ///< the continuum's sheet
  /// "local", the network, which is judged; "gradient", with its gradient energy and micro-inertia;
  /// "viscous-gradient", with gradient viscosity as well; "local-flank" and "gradient-flank", the first two without
  /// the bonds and dashpots that the crack has cut; if asked for, "bonds-local" and so on, the same with the
  /// Cauchy-Born law and gradient energy of the lattice.
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
