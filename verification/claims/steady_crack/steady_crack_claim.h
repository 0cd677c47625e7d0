#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "verification/claims/rows.h"
#include "verification/claims/steady_crack/steady_crack.h"

namespace latcon::claims
{

/// A crack in a strip of the simulator's own lattice: linear bonds between nearest neighbours, no toughening, strains
/// so small that the lattice is a linear one but for the breaking. Units as in CrackStrip.
struct CrackRunOptions
{
  CrackStrip strip;
  double driving;                ///< Delta / Delta_G of the held rows
  double breaking_strain = 1e-4; ///< lam_f - 1 [-]
  double time_step = 0.025;
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
  double kinetic;           ///< gained
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
  /// Error that a test introduces into the simulator; none otherwise.
  std::function<void(CrackRunOptions &)> planted = [](CrackRunOptions &) {};
};

/// The series of the claim. @param quick fewer drivings
std::vector<SteadyCrackSeries> steady_crack_series(bool quick);

/// Steady cracks of the simulator against the exact solution of the linear lattice (theory-comparison.md, section "A
/// steady crack in a linear lattice"): speed, elastic energy released and energy dissipated for each broken bond (eq.
/// (S.9)), under several drivings and for a weak and a strong viscosity. Besides, the exact solution against the
/// equilibrium of a crack at rest.
///
/// Leaves the tables `steady_crack` (a row for each run) and, unless `quick`, `steady_crack_curve` (exact driving over
/// speed, and whether only the bonds that should break do). A crack that does not run, or for which there is no exact
/// solution, makes a row that fails.
/// @param quick fewer drivings; about 25 s on one core, in full 60 s
ClaimOutcome steady_crack_claim(bool quick);

/// The rows of one series: what every crack of it has, beside the exact solution, within tolerances from refined runs.
ClaimOutcome steady_cracks(const SteadyCrackSeries &series);

} // namespace latcon::claims
