#pragma once

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"

namespace latcon::claims
{

/// Adds rows that compare a held sheet of finite elements, strained suddenly from I to F, with the closed form of its
/// branches (theory.md, eq. (L.31)), summed over the bonds of a site: first Piola stress, measured as the moment of the
/// nodal reactions, energies of each branch, and their balance. Every rank computes all of it.
/// @param sheet only its bonds matter
/// @param material of the closed form, with Maxwell branches @param planted of the finite elements
/// @param time_step [s] @param n_steps 2 or more
/// @throws what continuum::DynamicSolver throws
void add_held_elements(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                       const lattice::Material &material, const lattice::Material &planted, const Eigen::Matrix2d &F,
                       double time_step, std::size_t n_steps, ClaimOutcome &outcome);

} // namespace latcon::claims
