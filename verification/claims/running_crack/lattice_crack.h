#pragma once

#include <optional>
#include <string>

#include "lattice/material.h"
#include "verification/claims/running_crack/tip_field.h"

namespace latcon::claims
{

/// Energies that a sheet lost while its tip advanced, per reference length of crack and thickness [J/m^2].
struct CrackEnergy
{
  double lost;       ///< of stored and kinetic energy
  double dissipated; ///< by viscosity anywhere
  double taken;      ///< at the crack: held by bonds when they were cut, or work against the forces that held it shut
  double near;       ///< dissipated by viscosity within TipRun::near of the tip, by its rate at the samples
};

/// A crack that was driven, on either side.
struct TipRun
{
  TipField field;     ///< mean over the samples
  CrackEnergy energy; ///< between the middle of the run and its end
};

/// Distance from the tip within which dissipation counts as near it [d].
inline constexpr double near_tip = 5.;

/// A series of frames, of one frame at the end of the drive: NAME.pvd in a folder.
struct CrackFrame
{
  std::string folder, name;
};

/// Drives the crack through a lattice, whose bonds break in no other way.
/// @param reach of the field around the tip [m]
/// @param frame none is written if empty @throws support::OutputError
TipRun drive_lattice_crack(const CrackDrive &drive, const lattice::Material &material, const Eigen::Matrix2d &F,
                           double reach, const std::optional<CrackFrame> &frame = {});

} // namespace latcon::claims
