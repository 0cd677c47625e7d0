#pragma once

#include <functional>
#include <vector>

#include "verification/claims/claim_outcome.h"
#include "verification/claims/steady_crack/crack_run.h"

namespace latcon::claims
{

/// Cracks between dashpots of one viscosity under several drivings.
struct SteadyCrackSeries
{
  double viscosity;             ///< beta, as in CrackStrip [-], > 0
  std::vector<double> drivings; ///< Delta / Delta_G, between the weakest under which a crack runs steadily and the
                                ///< strongest under which only bonds between the middle rows break, which is the last
  double beyond;                ///< driving under which bonds off the crack break too; 0: not tried
  /// Error that a test introduces into the simulator; none otherwise.
  std::function<void(CrackRunOptions &)> planted = {};
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
