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

/// Seed crack of a case in the finite elements: a segment from X = left to X = right [m] in the middle of the row of
/// cells that is nearest to the sites which the lattice removes; it ends half a spacing beyond them.
struct SeedSegment
{
  double left, right, Y;
};

/// Returns the seed crack of a case on a grid.
[[nodiscard]] SeedSegment seed_segment(const input::Case &input, const continuum::NodeGrid &grid);

/// Returns the size of a cell that the case asks for [m], xi / n. The cells are those next to it that fill the sheet.
[[nodiscard]] double cell_size(const input::Case &input, const continuum::DamageLaw &law);

/// Returns the sheet at rest at the homogeneous loading of the case, all edges held, without damage within 2 xi of
/// them, with the damage of a straight crack about the seed (theory-damage.md, eq. (C.67)), and displaced by the
/// noise of the case: random numbers in [-1, 1] times the amplitude at the points of a square lattice with the spacing
/// of the case, linear in between, so that it does not depend on the mesh.
/// @param step damage_time_step() [s]
/// @throws InvalidInput, InvalidMaterial as DamageMotion does
[[nodiscard]] continuum::DamageMotion damaged_sheet(const input::Case &input, const Subject &subject,
                                                    const continuum::DamageLaw &law, double step);

/// Returns the energy density of the loaded sheet [J/m^3], by the law of the case.
/// @throws NonPhysicalState as continuum::CauchyBorn::energy() does
[[nodiscard]] double stored_energy(const input::Case &input, const Subject &subject);

/// Returns the time step of the sheet [s]: that of the case, or half the longest with which an explicit step without
/// viscosity is stable in the loaded sheet. Needs no memory of the size of the sheet. Reports to `parameters` a step or
/// an inertia length with which the sheet cannot move; the step is meaningless then.
[[nodiscard]] double damage_time_step(const input::Case &input, const Subject &subject, const continuum::DamageLaw &law,
                                      input::Parameters &parameters);

} // namespace latcon::bridge
