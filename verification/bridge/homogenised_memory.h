#pragma once

#include <memory>

#include "continuum/fibre_memory.h"
#include "lattice/material.h"

namespace latcon::bridge
{

/// Returns the Maxwell branches of a lattice as those of fibres, with weights as in cauchy_born()
/// (theory-comparison.md, eq. (H.1); theory-viscoelastic.md, eq. (V.1)); null if there are no branches. Branches are
/// numbered as in lattice::Simulation::mechanism_energies(): those of nearest-neighbour bonds first.
/// @throws std::invalid_argument for bonds with a memory of another program
std::unique_ptr<continuum::FibreMemory> homogenised_memory(const lattice::TriangularLattice &lattice,
                                                           const lattice::Material &material);

} // namespace latcon::bridge
