#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "verification/analysis/crack_records.h"
#include "verification/analysis/path_fit.h"

namespace latcon::analysis
{

/// Criteria for counting the broken bonds of a sheet as two or more strands. Lengths in lattice spacings d.
struct BranchRule
{
  /// Width of the columns of X in which strands are separated. Wide enough for a dozen broken bonds, narrow enough that
  /// an oscillating path (slope below 1) covers less than half of `gap` in one column.
  double column_width = 4.;
  /// Empty interval of Y between two strands. Bonds that break in the wake lie within several d of the path; a branch
  /// at 30 degrees exceeds this gap after 9 d.
  double gap = 10.;
  /// Broken bonds per d of X in a strand. A crack that cuts the lattice completely breaks at least 2 (nearest
  /// neighbours only, along a row); half of that allows for ligaments. Loose debris has fewer.
  double bonds_per_spacing = 1.;
  /// Length of X over which two strands must run in parallel without interruption. Holes beside a crest of an
  /// oscillating path are shorter than half a wavelength, which is 8 d to 32 d in rubber; a branch continues.
  double persistence = 20.;
  /// Gap that the strands must reach somewhere along this length: a branch moves away, whereas a damaged band keeps its
  /// distance.
  double grown_gap = 15.;
};

/// Returns the fraction of the columns between X_begin and X_end in which the crack has two or more strands.
///
/// In every column the Y of the broken bonds are sorted and split at gaps; a group with enough bonds is a strand.
/// Columns count if they belong to a run of columns with two or more strands that is long enough and reaches a large
/// enough gap.
/// @param breaks broken bonds in any order, may be empty
/// @param X_begin, X_end interval, reference [m]
/// @param lattice_spacing d [m], > 0
/// @return in [0, 1]; 0 if the interval contains no whole column
/// @throws std::invalid_argument if the interval contains 1e9 columns or more
double branched_fraction(const std::vector<BreakRecord> &breaks, double X_begin, double X_end, double lattice_spacing,
                         const BranchRule &rule = {});

/// Damage beside the path of a crack.
///
/// The paper raises the breaking stretch "behind the crack to keep its back surface intact. But even with this, a
/// fraction of mass points will still detach from an oscillating crack": bonds break near the path, few beside it, and
/// none far from it.
struct FlankDamage
{
  double depth; ///< largest distance of a broken bond from the path, reference [m], >= 0
  double share; ///< share of the broken bonds that lie more than 6 d from the path [-], 0 to 1
};

/// Measures the damage of the flanks between X_begin and X_end, reference [m].
///
/// The path is the polyline through the positions of the tip; the distance of a bond is the distance of its midpoint
/// from the path.
/// @param tip record of the tip, X not decreasing @param breaks broken bonds in any order
/// @param spacing d [m], > 0
/// @return none if there is no record of the tip, or if no bond broke between X_begin and X_end
std::optional<FlankDamage> flank_damage(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                                        double X_begin, double X_end, double spacing);

/// Pattern of the path of a crack.
enum class CrackPattern
{
  straight,
  oscillating,
  branching,
  arrested,
  undecided ///< the record is too short or not clear enough to decide
};

/// Returns the name of a pattern in output files: "straight", "oscillating", "branching", "arrested", "undecided".
const char *to_string(CrackPattern pattern);

/// Data of the sheet, of which the first four have no default and NaN is rejected, and thresholds of the measurement,
/// which no case sets. Lengths are in the reference configuration; X is 0 at the left edge.
struct CrackMeasurementOptions
{
  double strip_length = std::numeric_limits<double>::quiet_NaN();    ///< L [m], > 0
  double lattice_spacing = std::numeric_limits<double>::quiet_NaN(); ///< d [m], in (0, L)
  double end_time = std::numeric_limits<double>::quiet_NaN();        ///< end of the run [s], >= 0, not before a record
  double seed_tip_X = std::numeric_limits<double>::quiet_NaN();      ///< tip of the seed crack [m], in [0, L)

  /// Fraction of L ahead of the tip of the seed that is always excluded [-], because the crack accelerates there and is
  /// influenced by the seed. The rest of the transient is determined from the path.
  double run_in_fraction = 0.1;
  /// Fraction of L before the held right edge that is excluded [-], because the edge carries load there.
  double clamp_fraction = 0.1;

  /// Shortest wavelength of the search, in d. The path is averaged over columns of 2 d, and a wavelength needs at
  /// least three of them; known wavelengths in rubber are longer (16 d and more).
  double min_wavelength = 8.;
  /// Smallest amplitude of an oscillation, in d. A tip that hops between two neighbouring rows shows at most (4 / pi)
  /// (sqrt3 / 4) d = 0.55 d.
  double min_amplitude = 0.75;
  /// Largest slope 2 pi amplitude / wavelength of an oscillation [-], > 0. The right-most damaged site follows a path
  /// up to about 60 degrees; steeper paths are tips that jump between strands. Known paths reach 0.6.
  double max_steepness = 2.;
  /// Smallest SinusoidFit::share_of_path [-]: the sinusoid must explain most of the path.
  double min_share = 0.5;
  /// Largest root mean square distance from a straight line of a straight path, in d, > 0; hops of a few d stay below
  /// it after averaging. A path with a larger distance is undecided unless it oscillates.
  double max_straight_rms = 4.;
  /// Smallest number of wavelengths in the window; with fewer, a bend cannot be distinguished from an oscillation.
  double min_periods = 1.5;
  /// Number of wavelengths that is sufficient without doubt. Between the two numbers the pattern is undecided.
  double clear_periods = 2.;
  /// Smallest SinusoidFit::log_evidence of an oscillation [-]: odds of 20 to 1 against a straight path that wanders.
  double min_log_evidence = 3.;
  /// Evidence that is sufficient without doubt [-]: odds of 150 to 1. Between the two values the pattern is undecided.
  double clear_log_evidence = 5.;
  /// Fraction of its later value that the amplitude over one wavelength has reached at the beginning of the window [-],
  /// in (0, 1).
  double steady_amplitude = 0.75;

  /// Fraction of L [-] that an arrested crack would have run at its mean speed while it stood still; half of it is the
  /// smallest advance of a crack that has left its seed. Equal to the clamp zone, and many times longer than the pauses
  /// of a running crack (a few d).
  double arrest_fraction = 0.1;
  /// Fraction of the length of the crack with several strands from which on the pattern is branching [-].
  double min_branched_fraction = 0.25;
  BranchRule branch_rule{};

  /// Error of an amplitude due to the discrete positions of the tip, in d: of lattice sites, the root mean square over
  /// exact sinusoids of amplitude d to 5 d and wavelength 20 d to 50 d, rounded to the nearest sites.
  double position_error = 0.09;
};

/// Result of measure_crack().
struct CrackMeasurement
{
  /// Pattern; undecided if the record is too short, if the path is too wavy to be straight and too irregular for an
  /// oscillation, or if a likely oscillation has fewer than two periods or no clear evidence.
  CrackPattern pattern = CrackPattern::undecided;
  std::string reason; ///< sentence with the decisive criterion and its numbers

  /// Window of the measurements below, reference [m]. Both ends are equal if there is nothing to measure.
  double X_begin = 0., X_end = 0.;

  std::optional<Measured> speed_lagrangian; ///< dX/dt [m/s]; none if the tip moved fewer than 10 times in the window
  std::optional<Measured> speed_laboratory; ///< dx/dt [m/s]; none as for speed_lagrangian

  /// Wavelength, reference [m]; only of cracks that oscillate or are likely to.
  std::optional<Measured> wavelength;
  std::optional<Measured> amplitude; ///< of the fitted sinusoid, reference [m]; as for wavelength
  /// Half the height from trough to crest, reference [m]; as for wavelength, and only with two wavelengths or more. It
  /// corresponds to a reading from a plot: a zigzag is up to pi^2 / 8 = 1.23 times higher than its fitted sinusoid.
  std::optional<Measured> crest_amplitude;

  /// Sinusoid fitted to the path, significant or not; none if the window is too short.
  std::optional<SinusoidFit> sinusoid;
  double periods = 0.;               ///< wavelengths of `sinusoid` in the window [-]
  double branched_fraction = 0.;     ///< fraction of the crack with two or more strands [-], see BranchRule
  std::optional<FlankDamage> flanks; ///< in the window; none if no bond broke in it
};

/// Measures speed, pattern, wavelength and amplitude of a crack.
///
/// Patterns, in this order:
/// 1. arrested: the tip did not leave the seed;
/// 2. branching: broken bonds form several strands over a substantial part of the crack (tested before arrest, because
///    branches stop at the upper and lower edge);
/// 3. arrested: the tip stopped before the clamp zone for the time in which it could have run `arrest_fraction` of the
///    strip;
/// 4. oscillating: a sinusoid of sufficient amplitude explains most of the path over enough periods, and explains it
///    better than a straight path that wanders;
/// 5. straight: the amplitude is too small for an oscillation, or hops dominate over the sinusoid;
/// 6. undecided: otherwise, and if the record is too short.
///
/// The window runs from the end of the run-in to the clamp zone or the last position of the tip. Its beginning moves
/// forward to where the oscillation has reached its later amplitude, but at least two wavelengths remain in the window
/// if there are two.
/// @param tip record of the tip, may be empty
/// @param breaks broken bonds in any order; if empty, the pattern is never branching
/// @throws std::invalid_argument for values that are not finite, decreasing times or X, a record after the end of the
/// run, or options out of range
CrackMeasurement measure_crack(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                               const CrackMeasurementOptions &options);

/// Steady part of a path and its fitted sinusoid.
struct SteadyPart
{
  double X_begin = 0.;                 ///< reference [m]
  bool is_long_enough = false;         ///< long enough to fit a sinusoid
  std::optional<SinusoidFit> sinusoid; ///< none if the part is too short or has no waviness, see fit_sinusoid()
};

/// Returns the records with X in [X_begin, X_end], reference [m].
std::vector<TipRecord> part_between(const std::vector<TipRecord> &tip, double X_begin, double X_end);

/// Fits a sinusoid to the path between X_begin and X_end (reference [m]) and moves the beginning to where the amplitude
/// over one wavelength has reached the later one; repeats this until the beginning no longer changes. At least two
/// wavelengths remain if there are two; a path without a clear sinusoid is not shortened.
SteadyPart find_steady_part(const std::vector<TipRecord> &tip, double X_begin, double X_end,
                            const CrackMeasurementOptions &rule);

/// Returns half the height from trough to crest [m], mean over the whole wavelengths of a path without its drift; the
/// uncertainty is that of the mean. The path is first averaged over columns of 2 d, so that a single hop is not a
/// crest.
/// @param tip records of the steady part
/// @param spacing d [m], > 0
/// @param curve sinusoid fitted to the path
/// @return none for fewer than two wavelengths, or if one contains no record
std::optional<Measured> crest_amplitude(const std::vector<TipRecord> &tip, double spacing, const Sinusoid &curve);

/// Returns the steady speed of a coordinate of the tip [m/s]: slope of the straight line through its position over
/// time.
///
/// The tip rests between records, so its mean position over equal time spans is known without interpolation, and every
/// span has the same weight.
/// @param tip records of the steady part, times and X not decreasing
/// @param spacing d [m], > 0
/// @param coordinate &TipRecord::X for the Lagrangian speed, &TipRecord::x for the laboratory speed
/// @return none for fewer than ten records, or if the tip or time does not advance
std::optional<Measured> steady_speed(const std::vector<TipRecord> &tip, double spacing, double TipRecord::*coordinate);

} // namespace latcon::analysis
