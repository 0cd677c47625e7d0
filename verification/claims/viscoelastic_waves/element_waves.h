#pragma once

#include "verification/bridge/memory_waves.h"
#include "verification/claims/continuum_waves.h"

namespace latcon::claims
{

/// Returns the branches of a plane wave at the homogeneous state F, in closed form from the constants of the fibres
/// (theory-viscoelastic.md, eq. (V.6)); one for each relaxation time. @param K referential wave vector [1/m]
std::vector<bridge::BranchMatrix> branch_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                  const Eigen::Vector2d &K);

/// Returns both free waves of a continuum with Maxwell branches. @throws what bridge::memory_waves() throws
std::array<bridge::MemoryWave, 2> continuum_memory_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                         const Eigen::Vector2d &K);

/// One wave measured on the moving finite element sheet.
struct ElementWave
{
  Oscillation oscillation;
  double imbalance; ///< largest of the run with the shorter step, over the energy of the wave at the start [-]
  double imbalance_tolerance; ///< its bound, theory-viscoelastic.md, eq. (V.8)
};

/// Runs one wave with Maxwell branches on a periodic sheet of finite elements: displacements, velocities and
/// overstresses of `wave` alone, for 0.8 of a period, by average acceleration; the error of the time stepping is
/// extrapolated from two time steps. Every rank computes all of it.
/// @param wave of continuum_memory_waves() of the correct continuum
/// @throws std::runtime_error if the wave does not oscillate; what DynamicSolver throws
ElementWave run_element_wave(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                             const bridge::MemoryWave &wave, const WaveMesh &mesh);

} // namespace latcon::claims
