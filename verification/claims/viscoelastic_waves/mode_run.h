#pragma once

#include "verification/bridge/memory_waves.h"
#include "verification/claims/lattice_waves.h"

namespace latcon::claims
{

/// Frequency and decay of one wave of a lattice with Maxwell branches, measured on the moving lattice.
///
/// The sheet starts with displacements, velocities and overstresses of this wave alone, with strains of 1e-5; it is
/// followed for 0.8 of a period and fitted. The error of the time stepping is extrapolated from two time steps, of
/// second order, to fourth.
/// @param wave of memory_waves() for the same cell, material and F
/// @throws std::runtime_error if the wave does not oscillate
Oscillation run_wave(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                     const bridge::MemoryWave &wave);

} // namespace latcon::claims
