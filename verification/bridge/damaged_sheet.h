#pragma once

#include "continuum/damage/damage_motion.h"
#include "verification/bridge/subject.h"
#include "verification/input/case.h"

namespace latcon::bridge
{

// Finite element sheet of a case that breaks by damage: the sheet, loading, seed, noise and held edges of its lattice.

/// Reports to `parameters` entries that the sheet does not support: holes, notches, edges that are not held, bonds with
/// memory or disorder or a law of the user, other laws, gradient energies, body forces, other initial states, too many
/// cells.
void require_damaged_sheet(const input::Case &input, input::Parameters &parameters);

/// Returns the constants of the damage of a case: those of section `Damage`. By default the length is the spacing, and
/// the threshold the energy density of the subject's Cauchy-Born law stretched along both axes to the breaking stretch,
/// or to 3 if the case has none (theory-damage.md, eq. (C.61)).
[[nodiscard]] continuum::DamageLaw damage_law(const input::Case &input, const Subject &subject);

/// What a damaged sheet needs to know of its case; takes no memory of the size of the sheet.
struct DamagedSheet
{
  Subject subject;
  continuum::DamageLaw law;
  /// Automatic time step [s]: half the longest with which an explicit step without viscosity is stable, halved until
  /// stages with the viscosity damp all waves.
  double automatic_step;
  double step;         ///< that of the case, or the automatic one [s]
  unsigned int stages; ///< evaluations of the forces in a step
  double cells;        ///< number of cells
};

/// Reads the damaged sheet of a case. Calls Parameters::finish().
/// @throws InputError for entries that require_damaged_sheet() reports, for a sheet that would be damaged everywhere in
/// its homogeneous state, and for a step or an inertia length with which it cannot move
/// @throws NonPhysicalState as continuum::CauchyBorn::energy() does
[[nodiscard]] DamagedSheet damaged_sheet(const input::Case &input, input::Parameters &parameters);

/// Seed crack of a case in the finite elements: a segment from X = left to X = right [m] in the middle of the row of
/// cells that is nearest to the sites which the lattice removes; it ends half a spacing beyond them.
struct SeedSegment
{
  double left, right, Y;
};

/// Returns the seed crack of a case on a grid.
[[nodiscard]] SeedSegment seed_segment(const input::Case &input, const continuum::NodeGrid &grid);

/// Returns the sheet at rest at the homogeneous loading of the case, all edges held, without damage within 2 xi of
/// them, displaced by the noise of the case: random numbers in [-1, 1] times the amplitude at the points of a square
/// lattice with the spacing of the case, linear in between, so that it does not depend on the mesh. The damage is that
/// of a straight crack about the seed (theory-damage.md, eq. (C.67)), or more where the loading drives it further.
/// All ranks share it. Collective. @throws InvalidInput, InvalidMaterial as DamageMotion does
[[nodiscard]] continuum::DamageMotion damage_motion(const input::Case &input, const DamagedSheet &sheet);

} // namespace latcon::bridge
