/// Steady cracks of the simulator; the exact solution, and the equilibrium of a crack at rest, in a linear lattice.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <vector>

#include "verification/claims/rows.h"

namespace latcon::claims
{

/// A strip of the triangular lattice of nearest neighbours, linearised about its undeformed state, with rows along a
/// crack that runs midway between two of them. Top and bottom rows are held.
///
/// Units of the whole folder: d = 1 (spacing), k = 1 (spring constant of a bond [N/m]), m = 1 (mass of a site). Times
/// are then in sqrt(m/k), speeds in d sqrt(k/m).
struct CrackStrip
{
  std::size_t free_rows; ///< N, rows that move on each side of the crack, >= 1; with the held ones 2 N + 2 in all
  double viscosity;      ///< beta = c / sqrt(k m) [-], > 0: dashpot c [N s/m] beside each spring

  /// Gaps between neighbouring rows, 2 N + 1: elastic layers in series.
  std::size_t layers() const { return 2 * free_rows + 1; }
};

/// Speed of shear waves, sqrt(3/8) d sqrt(k/m); longitudinal waves are faster by sqrt3.
double shear_speed();

/// Response of the lower half of a strip to loads that move along it at a steady speed.
///
/// All fields are w(t - X/v) with the same w for all sites of a row (theory-comparison.md, eq. (S.2)). Transforms are
/// f(omega) = integral of f(s) exp(-i omega s), so that a step along the row by X is the factor exp(-i omega X/v). Rows
/// are counted down from the crack; the upper half is the mirror image.
class HalfStrip
{
public:
  using Complex = std::complex<double>;

  /// @param speed v of the crack, > 0 @throws std::invalid_argument for values out of range
  HalfStrip(const CrackStrip &strip, double speed);

  const CrackStrip &strip() const { return strip_; }
  double speed() const { return speed_; }

  /// kappa = 1 + i omega beta: complex stiffness of a bond.
  Complex stiffness(double omega) const { return {1., omega * strip_.viscosity}; }

  /// L(omega): the elongation that bonds across the crack lose if each of them pulls its ends together with a force of
  /// transform 1 and nothing else holds the crack together (theory-comparison.md, eqs. (S.3), (S.4)).
  Complex compliance(double omega) const { return -elongations(omega, 1).front().right; }

  /// Phi(omega) = 1 + kappa L (theory-comparison.md, eq. (S.5)).
  Complex phi(double omega) const { return 1. + stiffness(omega) * compliance(omega); }

  /// Elongations of the bonds of one gap between rows, and of the row below it.
  struct Layer
  {
    Complex right; ///< bonds that go up and to the right; in layer 0 those across the crack
    Complex left;  ///< bonds that go up and to the left
    Complex along; ///< bonds of the row below the gap; 0 for the held row
  };

  /// Elongations of the bonds of the first of N + 1 layers: 0 is the gap of the crack, N that above the held row.
  std::vector<Layer> elongations(double omega, std::size_t n_layers) const;

private:
  CrackStrip strip_;
  double speed_;
};

/// Driving Delta / Delta_G at which a crack runs steadily at speed v: the displacement of the held rows over that of
/// Griffith's threshold (theory-comparison.md, eq. (S.1)), from the exact solution of the linear lattice by the
/// Wiener-Hopf method (eq. (S.8)). Nothing of it is shared with the simulator.
/// @param speed v in d sqrt(k/m), > 0
/// @throws std::runtime_error if the integral does not converge
double steady_driving(const CrackStrip &strip, double speed);

/// The speed at which a crack runs steadily under a driving: the inverse of steady_driving on the branch where the
/// driving grows with speed, which is the stable one.
/// @param driving Delta / Delta_G, > 1
/// @param fastest upper end of the search, in d sqrt(k/m)
/// @throws std::runtime_error if no speed of that branch up to `fastest` has this driving
double steady_speed(const CrackStrip &strip, double driving, double fastest);

/// Fields around a steadily running crack as functions of the time s since a bond across it broke.
/// Elongations are over the breaking elongation.
struct SteadyFields
{
  double driving;                 ///< Delta / Delta_G
  std::vector<double> time;       ///< s, even steps, in sqrt(m/k)
  std::vector<double> elongation; ///< of a bond across the crack, or of the gap it leaves
  double largest_before;    ///< of a bond across the crack until a tenth of the breaking interval before it breaks
  double largest_elsewhere; ///< of any other bond at any time
  double dissipation;       ///< by all dashpots for one broken bond, over the energy k e_c^2 / 2 that this held

  /// Returns whether the solution is valid: bonds reach the breaking elongation when they are to break, and nowhere
  /// else.
  bool exists() const { return largest_before < 1. && largest_elsewhere < 1.; }
};

/// The fields by inverse Fourier transform of the exact solution (theory-comparison.md, eqs. (S.6) and (S.7)).
/// @param duration of the periodic record, half of it ahead of the breaking: long enough for all motion behind the
/// crack to die out, in sqrt(m/k)
/// @param samples of it, a power of 2; errors fall with the second power of the step
SteadyFields steady_fields(const CrackStrip &strip, double speed, double duration, std::size_t samples);

/// Drivings Delta / Delta_G between which a crack at rest neither opens nor heals: lattice trapping
/// (theory-comparison.md, eq. (S.10)).
struct TrappingWindow
{
  double heals;  ///< Delta_-: here the last broken bond would be at the breaking elongation, were it whole
  double starts; ///< Delta_+: here the first bond ahead reaches it
};

/// The window from the equilibrium of a strip with a half-infinite crack, a sparse linear system. The viscosity has no
/// part in it.
/// @param columns sites in a row, half of them ahead of the tip; the ends are free. Errors fall exponentially with the
/// length over the height: sixteen times the layers leave less than 1e-6
/// @throws std::runtime_error if the system cannot be solved
TrappingWindow trapping_window(const CrackStrip &strip, std::size_t columns);

/// A crack in a strip of the simulator's own lattice: linear bonds between nearest neighbours, no toughening, strains
/// so small that the lattice is a linear one but for the breaking. Units as in CrackStrip.
struct CrackRunOptions
{
  CrackStrip strip;
  double driving; ///< Delta / Delta_G of the held rows
  double time_step = 0.025;      ///< [sqrt(m/k)]
  double breaking_strain = 1e-4; ///< lam_f - 1 [-]
  double length = 260.;       ///< of the strip; its left end is free, the right one held
  double window_begin = 110.; ///< what the tip does from here on is measured ...
  double window_end = 210.;   ///< ... up to here
};

/// Measurement of the crack in the window. Energies are per broken bond, divided by the energy k e_c^2 / 2 of a bond at
/// the breaking elongation.
struct CrackRun
{
  double speed;             ///< slope of the tip's record [d sqrt(k/m)]
  double broken;            ///< held by bonds when they broke; above 1, since time steps are finite
  double viscous;           ///< dissipated by the dashpots
  double released;          ///< by the springs, what broken bonds held included
  double largest_elsewhere; ///< elongation of a bond near the tip but not across the middle, over the breaking one
  std::size_t bonds_broken;
  std::size_t off_line; ///< bonds broken anywhere but across the middle, over the whole run

  /// Mean elongation at which bonds broke, over the breaking one: root mean square.
  double breaking_elongation() const { return std::sqrt(broken); }
};

/// Runs the simulator until the tip has passed the window.
/// @throws std::invalid_argument if the time step is not a stable one
/// @throws std::runtime_error if the crack stops before
CrackRun run_crack(const CrackRunOptions &options);

/// Cracks between dashpots of one viscosity under several drivings.
struct SteadyCrackSeries
{
  double viscosity;             ///< beta, as in CrackStrip [-], > 0
  std::vector<double> drivings; ///< Delta / Delta_G, between the weakest under which a crack runs steadily and the
                                ///< strongest under which only bonds between the middle rows break, which is the last
  double beyond;                ///< driving under which bonds off the crack break too; 0: not tried
  double time_step = 0.025;     ///< of the runs [sqrt(m/k)]; a longer one has larger tolerances
  /// Error that a test introduces into the simulator; none otherwise.
  std::function<void(CrackRunOptions &)> planted = [](CrackRunOptions &) {};
};

/// Steady cracks of the simulator against the exact solution of the linear lattice (theory-comparison.md, section "A
/// steady crack in a linear lattice"): speed, elastic energy released and energy dissipated for each broken bond (eq.
/// (S.9)), under several drivings and for a weak and a strong viscosity. Besides, the exact solution against the
/// equilibrium of a crack at rest.
///
/// Leaves the tables `steady_crack` (a row for each run) and, unless `quick`, `steady_crack_curve` (exact driving over
/// speed, and whether only the bonds that should break do). A crack that does not run, or for which there is no exact
/// solution, makes a row that fails.
/// @param quick fewer drivings, twice the time step and weaker dashpots; about 12 s on one core, in full 60 s
ClaimOutcome steady_crack_claim(bool quick);

/// The rows of one series: what every crack of it has, beside the exact solution, within tolerances from refined runs.
ClaimOutcome steady_cracks(const SteadyCrackSeries &series);

} // namespace latcon::claims
