#pragma once

#include <string>

#include "verification/input/case.h"

namespace latcon::bridge
{

// Lattice sheet of a case, with the same edges, hole and notch as the finite element sheet.

/// Reports to `parameters` entries for the finite element sheet that `command` does not support for the lattice:
/// displacements other than that of the loading, tractions, body forces, held rims.
void require_lattice_sheet(const input::Case &input, input::Parameters &parameters, const std::string &command);

/// Reports what `latcon fracture` cannot run: holes, notches and free edges, as it requires all bonds at every free
/// site, or a missing breaking stretch or end time.
void require_fracture_case(const input::Case &input, input::Parameters &parameters);

/// Returns the state of the sheet at the homogeneous deformation of the case, at rest and without noise, with its hole
/// or notch, and with held and free edges of the case.
/// @param band relevant rows: all rows of input.sheet(), or a part of them
lattice::State lattice_state(const input::Case &input, const lattice::RowPartition &band);

} // namespace latcon::bridge
