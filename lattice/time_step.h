#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "lattice/contact.h"

namespace latcon::lattice
{

class Integrator;

/// Time integrator of a motion, and its step.
struct TimeStepping
{
  /// Velocity Verlet, unless stages are given. A number converts to velocity Verlet with that step.
  TimeStepping(double h, unsigned int s = 0) : step(h), stages(s) {}

  double step;         ///< h [s], > 0
  unsigned int stages; ///< s of Runge-Kutta-Chebyshev, >= 2; 0: velocity Verlet
  /// Makes an integrator with this step in place of velocity Verlet; null: none.
  std::function<std::unique_ptr<Integrator>(const RowPartition &, Forces &)> make = {};

  unsigned int evaluations() const { return stages > 0 ? stages : 1; } ///< of all forces, in a step
};

/// Largest stable time steps of velocity Verlet with predicted velocities [s] (theory.md, eqs. (L.8) to (L.10)).
struct TimeStepLimits
{
  double elastic;  ///< 2 / omega, from the bond stiffness alone
  double viscous;  ///< 1 / gamma, from the dashpots alone; infinite without them
  double combined; ///< 2 / (gamma + sqrt(gamma^2 + omega^2)), root of gamma h + (omega h / 2)^2 = 1
};

/// Limits that hold in every configuration in which no bond is shorter than `smallest_stretch`.
///
/// omega^2 <= 2 sum_j A0 psi''_max / (l m) and gamma <= 2 sum_j A0 eta / (l m), sums over the bonds of a site, all as
/// stiff as disorder allows, with psi''_max = largest_stiffness(law, smallest_stretch): bonds all in line would attain
/// them. In the undeformed lattice of nearest neighbours the true limit is larger by a factor of 2 for the dashpots
/// (attained by the shortest waves), of sqrt2 for the springs.
/// Where sites may touch (theory.md, eq. (L.14)) the bound is also for a site with all its bonds and six contacts
/// around it. It differs only for contacts that are stiffer or more viscous than the bonds that they replace.
/// Likewise it is also for a site of an absorbing end, which lacks bonds (theory.md, eq. (L.16)).
/// @param smallest_stretch lam_min [-] in (0, 1] @param contact none: sites do not touch
/// @param end_impedance of absorbing ends, per sheet thickness [Pa s], see end_loads.h; zero: there are none
TimeStepLimits time_step_limits(const TriangularLattice &lattice, const Material &material, double smallest_stretch,
                                const std::optional<ContactLaw> &contact = std::nullopt,
                                const Eigen::Matrix2d &end_impedance = Eigen::Matrix2d::Zero());

/// Stretch below which a bond can require divided steps [-] (theory.md, eq. (L.24)).
inline constexpr double short_stretch = 0.5;

/// Longest step [s] that follows the recoil of a bond (theory.md, eq. (L.24)). For velocity Verlet: the combined
/// limit, at most a tenth of the elastic one; for Runge-Kutta-Chebyshev: 1 / kappa. All bonds of the shell of `kind`
/// are taken to be at `stretch`, all others at short_stretch.
/// @param contact none: sites do not touch
double recoil_step(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                   std::size_t kind, double stretch, const std::optional<ContactLaw> &contact);

/// Stretch below which bonds are checked after each step for whether the next step must be divided [-]: short_stretch
/// plus what a bond may lose in one step, at most 0.3 (theory.md, eq. (L.26)).
/// @param breaking_stretch of toughened bonds, if there are such, and of the strongest; infinite: bonds do not break
double watched_stretch(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                       double breaking_stretch);

/// Estimate r of the largest rate of stretch of a bond [1/s], > 0 (theory.md, eq. (L.26)).
/// @param breaking_stretch of toughened bonds, if there are such, finite
double largest_stretch_rate(const TriangularLattice &lattice, const Material &material, double breaking_stretch);

/// Step of Runge-Kutta-Chebyshev at which waves and the breaking of bonds are resolved [s]: a share of the elastic
/// limit of the undeformed sheet, or 1 / kappa, kappa being the largest psi''_max / eta, if that is smaller: all
/// oscillating modes are stable then for any number of stages (theory.md, eq. (L.22)). Where sites may touch it also
/// resolves and keeps stable a site with six contacts (eqs. (L.14) and (L.23)) and the jump of a contact's dashpot,
/// h <= m/c.
/// @return 0 where a shell, or the contact, has no dashpots: the method is not made for oscillations that nothing damps
double chebyshev_step(const TriangularLattice &lattice, const Material &material, double smallest_stretch,
                      const std::optional<ContactLaw> &contact = std::nullopt);

/// Returns whether the oscillation of two free, isolated sites in contact grows from step to step. Their relative
/// motion has gamma = 2c/m and omega^2 = 2k/m.
bool amplifies_contact(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                       const ContactLaw &contact);

/// Runge-Kutta-Chebyshev with steps no longer than `step`, and no longer than is stable (theory.md, eqs. (L.20) and
/// (L.22)).
/// @param step [s], > 0
/// @param limits of velocity Verlet for the same sheet, whose dashpots bound the real axis
/// @param stages s; 0: as few as are stable with `step`
TimeStepping chebyshev_time_stepping(double step, const TimeStepLimits &limits, unsigned int stages);

} // namespace latcon::lattice
