#pragma once

#include <string>

#include "verification/input/case.h"

namespace latcon::bridge
{

// The lattice side of the sheet that a case describes: the same edges, hole and notch as the finite elements have.

/// Refuses what a case asks of the finite element sheet and `command` cannot do with the lattice: displacements other
/// than that of the loading, tractions, body forces, held rims. Errors go to `parameters`.
void require_lattice_sheet(const input::Case &input, input::Parameters &parameters, const std::string &command);

/// Refuses, besides, holes, notches, and edges that are not held: `command` wants every free site to have all its
/// bonds.
void require_whole_held_sheet(const input::Case &input, input::Parameters &parameters, const std::string &command);

/// Refuses, besides, cases that `latcon fracture` cannot run for want of a breaking stretch or an end time.
void require_fracture_case(const input::Case &input, input::Parameters &parameters);

/// The sheet at the homogeneous deformation of the case, at rest and without noise, in the rows that `band` knows; hole
/// or notch cut out, its edges held or free as the case says.
/// @param band all rows of input.lattice(), or a share of them
lattice::State lattice_state(const input::Case &input, const lattice::RowPartition &band);

} // namespace latcon::bridge
