#pragma once

#include <array>

#include "lattice/material.h"
#include "lattice/state.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/oscillation.h"
#include "verification/input/case.h"

namespace latcon::claims
{

/// Periodic lattice sheet for a plane wave.
struct WaveCell
{
  lattice::TriangularLattice sheet;
  Eigen::Vector2d K; ///< referential wave vector [1/m]

  double phase(std::size_t place) const { return K.dot(sheet.reference(place)); } ///< K.X of a site
};

/// Adds amplitude p cos(K.X - w t) at t = 0 to the positions of a state, and its rate to the velocities.
/// @param frequency w [rad/s]
void add_wave(lattice::State &state, const WaveCell &cell, double amplitude, const Eigen::Vector2d &p,
              double frequency = 0.);

/// Direction of a wave vector in units of the reciprocal periods of the lattice along x and y; not both 0.
struct WaveDirection
{
  unsigned int along_x, along_y;
};

/// Along x, at 30 degrees to it, along y, and one off every line of symmetry.
std::array<WaveDirection, 4> wave_directions(lattice::Orientation orientation);

/// Unit vector [-].
Eigen::Vector2d unit_vector(const WaveDirection &direction, lattice::Orientation orientation);

/// Its angle to x [degrees].
double angle(const WaveDirection &direction, lattice::Orientation orientation);

/// Smallest sheet for a wave of the requested length, to 2 %.
/// @param kd |K| d [-], > 0
WaveCell wave_cell(double spacing, lattice::Orientation orientation, const WaveDirection &direction, double kd);

/// Smallest stretch of all bonds at the homogeneous deformation F, 1 if none is compressed [-]: limits of the time step
/// depend on it.
double smallest_stretch(const lattice::TriangularLattice &lattice, const Eigen::Matrix2d &F);

/// Frequencies and decays of the longitudinal and the shear wave of a cell, measured on the moving lattice.
///
/// Both are standing waves in one sheet, with strains of 1e-5, polarised as the lattice's own (see bloch_waves),
/// released from rest at the homogeneous state F; each is followed through three quarters of a period at least, and
/// fitted. The error of the time stepping is extrapolated from two time steps, of second order, to fourth (to third by
/// Runge-Kutta-Chebyshev, whose error has a term of that order in damped waves). The longer step is at most the one
/// that the integrator takes in the sheet of a case.
/// @param integrator Runge-Kutta-Chebyshev is for materials with dashpots in all bonds
/// @throws std::runtime_error if a wave does not oscillate
std::vector<Oscillation> lattice_waves(const WaveCell &cell, const lattice::Material &material,
                                       const Eigen::Matrix2d &F,
                                       input::Case::Integrator integrator = input::Case::Integrator::velocity_verlet);

/// Frequency and decay of one wave of a lattice with Maxwell branches, measured on the moving lattice.
///
/// The sheet starts with displacements, velocities and overstresses of this wave alone, with strains of 1e-5; it is
/// followed for 0.8 of a period and fitted. The error of the time stepping is extrapolated from two time steps, of
/// second order, to fourth.
/// @param wave of memory_waves() for the same cell, material and F
/// @throws std::runtime_error if the wave does not oscillate
Oscillation lattice_wave(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                         const bridge::MemoryWave &wave);

} // namespace latcon::claims
