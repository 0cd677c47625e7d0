#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "verification/analysis/crack_branches.h"
#include "verification/analysis/crack_flanks.h"
#include "verification/analysis/crack_records.h"
#include "verification/analysis/path_fit.h"

namespace latcon::analysis
{

/// What the path of a crack is like.
enum class CrackPattern
{
  straight,
  oscillating,
  branching,
  arrested,
  undecided ///< the record is too short or not clear enough to tell
};

/// The word that outputs use: "straight", "oscillating", "branching", "arrested", "undecided".
const char *to_string(CrackPattern pattern);

/// What the sheet was, and where the rules of the measurement draw their lines. The first four have no default: NaN is
/// refused. Lengths are in the reference configuration, X runs from 0 at the left edge.
struct CrackMeasurementOptions
{
  double strip_length = std::numeric_limits<double>::quiet_NaN();    ///< L [m], > 0
  double lattice_spacing = std::numeric_limits<double>::quiet_NaN(); ///< d [m], in (0, L)
  double end_time = std::numeric_limits<double>::quiet_NaN();        ///< end of the run [s], >= 0, not before a record
  double seed_tip_X = std::numeric_limits<double>::quiet_NaN();      ///< tip of the seed crack [m], in [0, L)

  /// Part of L ahead of the seed's tip that is left out in any case [-]: the crack accelerates there and has not
  /// forgotten the seed. What else has not settled is found from the path itself.
  double run_in_fraction = 0.1;
  /// Part of L before the held right edge that is left out [-]: there the edge carries load past the crack.
  double clamp_fraction = 0.1;

  /// Shortest wavelength looked for, in d, >= 6: the path is averaged over columns of 2 d, three of them a wavelength
  /// are the least that show one, and the paths known in rubber are longer (16 d and more).
  double min_wavelength = 8.;
  /// Least amplitude of an oscillation, in d: a tip that hops between two neighbouring rows, a fraction of the time
  /// each, shows at most (4 / pi) (sqrt3 / 4) d = 0.55 d.
  double min_amplitude = 0.75;
  /// Greatest slope 2 pi amplitude / wavelength of an oscillation [-], > 0. The right-most damaged site follows a path
  /// up to about 60 degrees; what seems steeper is a tip that jumps from one strand to another. Known paths reach 0.6.
  double max_steepness = 2.;
  /// Least SinusoidFit::share_of_path [-]: the sinusoid must be most of what the path does.
  double min_share = 0.5;
  /// Greatest root mean square distance from a straight line of a path that is surely straight, in d, > 0: hops of a
  /// few d are no more than this after averaging. A path that strays further is undecided unless it oscillates.
  double max_straight_rms = 4.;
  /// Least number of wavelengths in the window: below it a bend and an oscillation are one and the same.
  double min_periods = 1.5;
  /// From here on the number of wavelengths leaves no doubt. In between, the pattern is undecided.
  double clear_periods = 2.;
  /// Least SinusoidFit::log_evidence of an oscillation [-]: odds of 20 to 1 against a straight path that wanders.
  double min_log_evidence = 3.;
  /// From here on the evidence leaves no doubt [-]: odds of 150 to 1. In between, the pattern is undecided.
  double clear_log_evidence = 5.;
  /// The window begins where the amplitude over one wavelength has come to this part of its later value [-], in (0, 1).
  double settled_amplitude = 0.75;

  /// Part of L [-] that a crack would have run at its own mean speed while it stood still, to be called arrested; also,
  /// halved, the least advance of a crack that has left its seed. As long as the clamp zone, many times the pauses of a
  /// running crack (a few d).
  double arrest_fraction = 0.1;
  /// Part of the crack's length that must run in several strands to be called branching [-].
  double min_branched_fraction = 0.25;
  BranchRule branch_rule{};
};

/// What the record of a crack says.
struct CrackMeasurement
{
  /// Undecided where the record is too short, or its path too wavy for straight and not regular enough for an
  /// oscillation, or an oscillation that is likely holds fewer than two periods or lacks clear evidence.
  CrackPattern pattern = CrackPattern::undecided;
  std::string reason; ///< one sentence for a reader: the criterion that decided, with its numbers

  /// Window that everything below was measured in, reference [m]. Equal ends where there is nothing to measure.
  double X_begin = 0., X_end = 0.;

  std::optional<Measured> speed_lagrangian; ///< dX/dt [m/s]; none if the tip moved fewer than 10 times in the window
  std::optional<Measured> speed_laboratory; ///< dx/dt [m/s]; none likewise

  /// Reference [m]; of cracks that oscillate, or are likely to.
  std::optional<Measured> wavelength;
  std::optional<Measured> amplitude; ///< of the nearest sinusoid, reference [m]; likewise
  /// Half the height from trough to crest, reference [m]; likewise, with two wavelengths or more only. What one
  /// reads off a drawn path: a zigzag is higher than its nearest sinusoid, up to pi^2 / 8 = 1.23 times.
  std::optional<Measured> crest_amplitude;

  /// The sinusoid nearest to the path, whether or not it means anything; none where the window is too short.
  std::optional<SinusoidFit> sinusoid;
  double periods = 0.;               ///< wavelengths of `sinusoid` in the window [-]
  double branched_fraction = 0.;     ///< part of the crack in two or more strands [-], see BranchRule
  std::optional<FlankDamage> flanks; ///< in the window; none where no bond broke in it
};

/// Measures speed, pattern, wavelength and amplitude of a crack.
///
/// Patterns, in this order:
/// 1. arrested: the tip never left the seed;
/// 2. branching: broken bonds form several strands over a substantial part of the crack (looked at before a stop, for
///    branches stop when they reach the upper and lower edge);
/// 3. arrested: the tip stopped before the clamp zone and stood while it could have run `arrest_fraction` of the strip;
/// 4. oscillating: a sinusoid of sufficient amplitude is most of what the path does, over enough periods, and explains
///    it better than a straight path that wanders does;
/// 5. straight: the amplitude is too small for an oscillation, or hops outweigh the sinusoid;
/// 6. undecided otherwise, and where the record is too short for any of these.
///
/// The window runs from the end of the run-in to the clamp zone or the last position of the tip. Its beginning moves on
/// to where the oscillation has reached its later amplitude, but two wavelengths stay in it where there are two.
/// @param tip record of the tip, may be empty
/// @param breaks broken bonds in any order; without them no crack is called branching
/// @throws std::invalid_argument for a value that is not finite, a time or X that decreases, a record after the end of
/// the run, or options out of range
CrackMeasurement measure_crack(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                               const CrackMeasurementOptions &options);

} // namespace latcon::analysis
