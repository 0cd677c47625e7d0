#pragma once

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"
#include "verification/claims/continuum_waves.h"

namespace latcon::claims
{

/// Rows of the claim `wave-speeds` on the network law with its gradient energy about the homogeneous state F.
///
/// The dynamical matrix of the lattice, (W.1) of theory-comparison.md, depends on the orientation of the lattice in the
/// undeformed sheet. The network is the mean over all rotations: its matrix agrees with the mean of the lattice's to
/// second order of kd without gradient energy, and to fourth with it; and it is off the lattice as it stands by no more
/// than the lattice's dependence on direction, whose bound is (H.15). Only Bloch sums over bonds represent
/// the lattice. Every rank computes all of it.
/// @param mesh of the finite elements, which have to have the frequencies of their continuum
void network_waves(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveMesh &mesh,
                   ClaimOutcome &outcome);

} // namespace latcon::claims
