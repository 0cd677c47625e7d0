#pragma once

#include <memory>

#include "continuum/constitution.h"
#include "continuum/dynamic_solver.h"
#include "continuum/fibre_memory.h"
#include "continuum/viscosity.h"
#include "verification/bridge/plane_waves.h"
#include "verification/bridge/subject.h"
#include "verification/claims/oscillation.h"

namespace latcon::claims
{

/// A continuum in which waves travel. The laws of its constitution must outlive it.
struct WaveContinuum
{
  continuum::Constitution constitution;
  continuum::Inertia inertia;
  std::shared_ptr<const continuum::Viscosity> viscosity = {}; ///< none: elastic
  std::shared_ptr<const continuum::FibreMemory> memory = {};  ///< none: no Maxwell branches
};

/// The continua of a subject, without viscosity. The subject must outlive them.
struct SubjectContinua
{
  explicit SubjectContinua(const bridge::Subject &subject);

  WaveContinuum local, gradient, isotropic; ///< Cauchy-Born law: alone, with the lattice's and an isotropic gradient
  WaveContinuum network, network_gradient;  ///< network: alone, with its gradient
};

/// Matrices of a plane wave at the homogeneous state F, in closed form from the tangents of the laws
/// (theory-comparison.md, eq. (W.3)). @param K referential wave vector [1/m]
bridge::WaveMatrices continuum_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                        const Eigen::Vector2d &K);

/// Returns both waves, of those matrices.
std::array<bridge::PlaneWave, 2> continuum_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                 const Eigen::Vector2d &K);

/// Returns the branches of a plane wave at the homogeneous state F, in closed form from the constants of the fibres
/// (theory-viscoelastic.md, eq. (V.6)); one for each relaxation time. @param K referential wave vector [1/m]
std::vector<bridge::BranchMatrix> branch_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                  const Eigen::Vector2d &K);

/// Returns both free waves of a continuum with Maxwell branches. @throws what bridge::memory_waves() throws
std::array<bridge::MemoryWave, 2> continuum_memory_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                         const Eigen::Vector2d &K);

/// Returns the nodal values of a field, without ghost entries. Collective.
continuum::Sheet::Vector interpolated(const continuum::Sheet &sheet, const dealii::Function<2> &field);

/// Elements of a periodic sheet as long as the wave, along x and along y (two across where K has no component).
struct WaveMesh
{
  unsigned int cells = 6;
  unsigned int degree = 4;
};

/// Bound on the relative error of a discrete frequency [-]: Ainsworth's dispersion error of elements of degree p
/// (SIAM J. Numer. Anal. 42, 553 (2004)), [p!/(2p)!]^2 (k h)^(2p) / (4p + 2), with p - 1 in place of p, as if all
/// energy were that of second derivatives.
double discretisation_bound(const WaveMesh &mesh);

/// Both waves in the finite elements, of tangent, viscosity and mass in the space of the two waves without damping,
/// which inverse iteration finds from the nodal values of both; polarisations are those in this space. Every rank
/// computes all of it. @throws continuum::LinearSolverFailed
std::array<bridge::PlaneWave, 2> discrete_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                const Eigen::Vector2d &K, const WaveMesh &mesh);

/// Frequencies and decays of both waves, measured on the moving finite element sheet as lattice_waves does on the
/// lattice: average acceleration, extrapolated from two time steps. Every rank computes all of it.
/// @throws std::runtime_error if a wave does not oscillate; what DynamicSolver throws
std::vector<Oscillation> finite_element_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                              const Eigen::Vector2d &K, const WaveMesh &mesh);

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
ElementWave element_wave(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                         const bridge::MemoryWave &wave, const WaveMesh &mesh);

/// Returns (1/2) d2E/de2 at e = 0 of an energy without odd terms, from second differences with e and 2 e.
template <class Energy>
double half_second_derivative(const Energy &energy, double e)
{
  const double at_rest = energy(0.);
  const auto second = [&](double x) { return 0.5 * (energy(x) + energy(-x) - 2. * at_rest) / (x * x); };
  return (4. * second(e) - second(2. * e)) / 3.;
}

/// Energy density that the displacement amplitude * p cos K.X adds to the homogeneous state, over amplitude^2 [J/m^5]:
/// from second differences of the energy of the finite element sheet, extrapolated. Every rank computes all of it.
double sinusoidal_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                         const Eigen::Vector2d &p, double amplitude, const WaveMesh &mesh);

/// Energy densities of a travelling wave [J/m^3].
struct TravellingEnergy
{
  double elastic;       ///< above that of the homogeneous state
  double kinetic;       ///< with micro-inertia, which the lattice lacks
  double micro_inertia; ///< the share of that in `kinetic`
};

/// Runs a wave amplitude * p cos(K.X - w t) of polarisation `wave` (0 longitudinal, 1 shear) for an eighth of a period.
/// Every rank computes all of it. @throws what DynamicSolver throws
TravellingEnergy travelling_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                                   std::size_t wave, double amplitude, const WaveMesh &mesh);

} // namespace latcon::claims
