#pragma once

#include <string>

#include "verification/compare/comparison.h"

namespace latcon::compare
{

/// Writes for ParaView what was compared: `difference.pvd` with two parts at the time of the lattice frame.
///
/// `difference_sites.vtp`, part 0: the lattice frame with all its fields, and for each common field NAME also
/// NAME_continuum, the finite element field at the sites, and NAME_difference, lattice less continuum, both
/// not-a-number at sites outside; `outside`, `complete` and `excluded` are 0 or 1. `difference_continuum.vtu`, part 1:
/// the continuum frame as it was read, in one piece. The series is written last, so that what it names is there. To be
/// called by one rank.
/// @throws OutputError
void write_difference(const std::string &directory, const LatticeFrame &lattice, const ContinuumFrame &continuum,
                      const Comparison &comparison);

} // namespace latcon::compare
