#pragma once

#include <string>

#include "verification/compare/comparison.h"

namespace latcon::compare
{

/// Writes the comparison for ParaView: `difference.pvd` with two parts at the time of the lattice frame.
///
/// Part 0, `difference_sites.vtp`, is the lattice frame with all its fields. For each common field NAME it also
/// contains NAME_continuum, the finite element field at the sites, and NAME_difference, lattice minus continuum, both
/// NaN at sites outside; `outside`, `complete` and `excluded` are 0 or 1. Part 1, `difference_continuum.vtu`, is the
/// continuum frame as read, in one piece. The series is written last, so that the files it refers to exist. To be
/// called by one rank.
/// @throws OutputError
void write_difference(const std::string &directory, const LatticeFrame &lattice, const ContinuumFrame &continuum,
                      const Comparison &comparison);

} // namespace latcon::compare
