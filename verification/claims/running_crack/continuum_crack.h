#pragma once

#include "continuum/constitution.h"
#include "continuum/dynamic_solver.h"
#include "continuum/viscosity.h"
#include "verification/claims/running_crack/lattice_crack.h"

namespace latcon::claims
{

/// A continuum through which a crack is driven. The laws must outlive it.
struct CrackContinuum
{
  continuum::Constitution constitution;
  continuum::Inertia inertia;
  const continuum::Viscosity *viscosity = nullptr; ///< none: elastic
  const continuum::Material *bonds = nullptr;      ///< Cauchy-Born law of the lattice, for TipValues::anisotropy
};

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

/// Drives the crack through the half sheet. Ahead of the tip the lower edge is on the plane of symmetry: no
/// displacement across it, no shear, and with a gradient energy no normal gradient of the displacement along it. Behind
/// the tip it is free. The edge is opened cell by cell: while the tip passes a cell, the forces that held that cell's
/// nodes fall linearly to zero.
/// @param reach as for the lattice, at whose sites the fields are evaluated
/// @param frame none is written if empty
/// @throws continuum::SolverFailed, continuum::InvalidInput, continuum::OutputFailed
TipRun drive_continuum_crack(const CrackDrive &drive, const HalfSheet &half, const CrackContinuum &medium,
                             const Eigen::Matrix2d &F, const CrackMesh &resolution, double reach,
                             const std::optional<CrackFrame> &frame = {});

} // namespace latcon::claims
