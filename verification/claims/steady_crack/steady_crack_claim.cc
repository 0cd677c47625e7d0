#include "verification/claims/steady_crack/steady_crack_claim.h"

#include <array>
#include <future>
#include <limits>
#include <utility>

#include <omp.h>

#include "support/largest_error.h"
#include "support/text_wrap.h"
#include "verification/claims/claim_list.h"

namespace latcon::claims
{
namespace
{

constexpr std::size_t free_rows = 9;      // on each side: 20 rows with the held ones
constexpr double fastest = 0.6;           // of the speeds searched, close to that of shear waves
constexpr double record_duration = 1024.; // all motion behind these cracks has died out after half of it
constexpr std::size_t record_samples = std::size_t(1) << 15;

Rows crack_rows(ClaimOutcome &outcome)
{
  return {outcome.results, "steady-crack", ""};
}

// A run and the exact solution for the elongation at which its bonds broke: up to a time step after they reached the
// breaking elongation, on average half a step, so that the lattice is slightly tougher than specified.
struct TheoryComparison
{
  TheoryComparison(const CrackRunOptions &options, const std::function<void(CrackRunOptions &)> &planted)
  {
    CrackRunOptions spoiled = options;
    planted(spoiled);
    run = run_crack(spoiled);
    driving = options.driving / run.breaking_elongation();
    speed = steady_speed(options.strip, driving, fastest);
    const double released_exact = options.driving * options.driving;
    errors = {std::log(steady_driving(options.strip, run.speed) / driving), run.released / released_exact - 1.,
              run.viscous / (released_exact - run.broken) - 1.};
  }

  CrackRun run;
  double driving; // Delta / Delta_G for the elongation at which bonds broke
  double speed;   // exact
  // Relative, of the driving that belongs to the measured speed, of the energy released, of that dissipated.
  std::array<double, 3> errors;
};

// The refined runs must not make room for an error of 1 %, whatever they find.
constexpr double largest_tolerance = 3e-3, smallest_tolerance = 1e-4;
const char *const reason = "twice the changes by half the time step, half the strain and a longer strip; the strain, "
                           "which a linear theory neglects against 1";

// Errors of the finite time step, breaking strain, and length of strip and run. They are of
// first order or better in the first two, so that halving these takes away half of the error at least; the strip is
// longer by six heights. A linear theory cannot be better than the strains that it neglects against 1.
std::array<double, 3> tolerances(const CrackRunOptions &options, const TheoryComparison &reference,
                                 const std::function<void(CrackRunOptions &)> &planted)
{
  std::array<double, 3> sum;
  sum.fill(options.breaking_strain);
  CrackRunOptions short_step = options, small_strain = options, long_strip = options;
  short_step.time_step *= 0.5;
  small_strain.breaking_strain *= 0.5;
  long_strip.length += 100.;
  long_strip.window_begin += 50.;
  long_strip.window_end += 50.;
  for (const CrackRunOptions &refined : {short_step, small_strain, long_strip})
  {
    const TheoryComparison comparison(refined, planted);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += 2. * std::abs(comparison.errors[i] - reference.errors[i]);
  }
  return sum;
}

std::string place(double viscosity, double driving)
{
  return support::text_of(", beta ", viscosity, ", Delta/Delta_G ", driving);
}

void add_run(ClaimOutcome &outcome, const CrackRunOptions &options, const TheoryComparison &comparison,
             const std::array<double, 3> &tolerance)
{
  const CrackRun &run = comparison.run;
  const SteadyFields fields = steady_fields(options.strip, comparison.speed, record_duration, record_samples);
  const std::string where = place(options.strip.viscosity, options.driving);
  const double speed_error = support::relative_error(run.speed, comparison.speed);
  const auto limited = [](double estimate)
  { return output::limited(estimate, smallest_tolerance, largest_tolerance, reason); };
  constexpr double step = 1e-3;
  const double sensitivity = // d ln v / d ln (Delta / Delta_G) of the exact solution
    2. * step /
    std::log(steady_driving(options.strip, comparison.speed * (1. + step)) /
             steady_driving(options.strip, comparison.speed * (1. - step)));
  const output::Tolerance speed_tolerance = limited(tolerance[0] * std::abs(sensitivity));
  const double released = options.driving * options.driving;
  const double c_S = shear_speed();

  const Rows rows = crack_rows(outcome);
  rows.add("crack speed over c_S" + where, "1", of_lattice(run.speed / c_S, comparison.speed / c_S), speed_error,
           speed_tolerance);
  rows.add("energy released for a broken bond, over that of the bond" + where, "1", of_lattice(run.released, released),
           std::abs(comparison.errors[1]), limited(tolerance[1]));
  rows.add("energy dissipated for a broken bond, over that of the bond" + where, "1",
           of_lattice(run.viscous, released - run.broken), std::abs(comparison.errors[2]), limited(tolerance[2]));
  const double elsewhere = run.largest_elsewhere / run.breaking_elongation();
  rows.add("largest elongation off the crack, over the breaking one" + where, "1",
           of_lattice(elsewhere, fields.largest_elsewhere),
           support::relative_error(elsewhere, fields.largest_elsewhere));
  const double off_line = static_cast<double>(run.off_line);
  rows.add("bonds broken off the crack" + where, "1", of_lattice(off_line, 0.), off_line, {0., "none"});

  outcome
    .table("steady_crack", {"beta", "driving", "breaking elongation", "lattice speed", "exact speed", "error",
                            "tolerance", "lattice released", "exact released", "lattice dissipated", "exact dissipated",
                            "lattice elsewhere", "exact elsewhere", "off line"})
    .add({options.strip.viscosity, options.driving, run.breaking_elongation(), run.speed / c_S, comparison.speed / c_S,
          speed_error, *speed_tolerance, run.released, released, run.viscous, released - run.broken, elsewhere,
          fields.largest_elsewhere, off_line});
}

// Bonds that the exact solution stretches beyond the breaking elongation do break.
void add_limit(ClaimOutcome &outcome, const CrackRunOptions &options)
{
  const double speed = steady_speed(options.strip, options.driving, fastest);
  const double elsewhere = steady_fields(options.strip, speed, record_duration, record_samples).largest_elsewhere;
  const auto off_line = static_cast<double>(run_crack(options).off_line);
  const std::string quantity = "bonds broken off the crack (theory: largest elongation there)";
  crack_rows(outcome).add(quantity + place(options.strip.viscosity, options.driving), "1",
                          of_lattice(off_line, elsewhere), (off_line > 0.) == (elsewhere > 1.) ? 0. : 1.,
                          {0., "both or neither"});
}

// A crack at rest just before it starts, and one that creeps: the slower, the closer, faster than any power of v.
void add_quasi_static(ClaimOutcome &outcome)
{
  const CrackStrip strip{2, 3.}; // so low that its slowest motion has died out before the next bond breaks
  const TrappingWindow coarse = trapping_window(strip, 16 * strip.layers()),
                       window = trapping_window(strip, 24 * strip.layers());
  const double truncation = 2. * std::abs(window.starts - coarse.starts);
  const double product = window.heals * window.starts;
  const Rows rows = crack_rows(outcome);
  rows.add("Delta_- Delta_+ / Delta_G^2 of a crack at rest", "1", {{}, {}, product},
           support::relative_error(product, 1.),
           output::limited(2. * truncation, 1e-9, 1e-4, "twice that of either end: change by a longer strip"));
  constexpr double creeping = 0.01;
  const double slow = steady_driving(strip, creeping), slower = steady_driving(strip, 0.5 * creeping);
  rows.add("driving of a creeping crack over that at which one at rest starts", "1", {{}, {}, slower / window.starts},
           support::relative_error(slower, window.starts),
           output::limited(2. * std::abs(slower - slow) + truncation, 1e-9, largest_tolerance,
                           "twice the change from twice the speed, and by a longer strip"));
}

void add_curves(ClaimOutcome &outcome, const std::vector<SteadyCrackSeries> &series)
{
  output::Table &table =
    outcome.table("steady_crack_curve", {"beta", "speed", "driving", "largest before", "largest elsewhere", "exists"});
  for (const SteadyCrackSeries &s : series)
    for (int i = 4; i <= 36; ++i)
    {
      const double speed = i * 0.025 * shear_speed();
      const SteadyFields fields = steady_fields({free_rows, s.viscosity}, speed, record_duration, record_samples);
      table.add({s.viscosity, speed / shear_speed(), fields.driving, fields.largest_before, fields.largest_elsewhere,
                 std::string(fields.exists() ? "yes" : "no")});
    }
}

} // namespace

ClaimOutcome steady_cracks(const SteadyCrackSeries &series)
{
  ClaimOutcome outcome;
  const auto attempt = [&](const std::string &part, double driving, const std::function<void()> &compute)
  { crack_rows(outcome).attempt(part + place(series.viscosity, driving), compute); };
  const CrackStrip strip{free_rows, series.viscosity};
  std::vector<std::pair<CrackRunOptions, TheoryComparison>> cracks;
  for (const double driving : series.drivings)
    attempt("crack", driving,
            [&]
            {
              const CrackRunOptions options{strip, driving, series.time_step};
              cracks.emplace_back(options, TheoryComparison(options, series.planted));
            });
  // Without the refined runs there are no tolerances, and the rows of the series fail.
  std::array<double, 3> tolerance;
  tolerance.fill(std::numeric_limits<double>::quiet_NaN());
  if (!cracks.empty())
    attempt("tolerances", cracks.back().first.driving,
            [&] { tolerance = tolerances(cracks.back().first, cracks.back().second, series.planted); });
  for (const auto &[options, comparison] : cracks)
    attempt("exact fields", options.driving, [&, &o = options, &c = comparison] { add_run(outcome, o, c, tolerance); });
  if (series.beyond != 0.)
    attempt("crack beyond the limit", series.beyond,
            [&] {
              add_limit(outcome, {strip, series.beyond, series.time_step});
            });
  return outcome;
}

ClaimOutcome steady_crack_claim(bool quick)
{
  ClaimOutcome outcome;
  crack_rows(outcome).attempt("cracks at rest and creeping", [&] { add_quasi_static(outcome); });
  std::vector<SteadyCrackSeries> every{{0.5, {1.57, 1.65, 1.75, 1.85, 1.92}, 2.2},
                                       {3., {1.88, 1.95, 2.1, 2.3, 2.6, 3.}, 0.}};
  if (quick)
    every = {{0.5, {1.75, 1.92}, 2.2, 0.05}, {1.5, {2.5}, 0., 0.05}};
  // A strip is too small for threads of its own, but the series do not need each other.
  const auto when = omp_get_max_threads() > 1 ? std::launch::async : std::launch::deferred;
  std::vector<std::future<ClaimOutcome>> outcomes;
  outcomes.reserve(every.size());
  for (const SteadyCrackSeries &series : every)
    outcomes.push_back(std::async(when, steady_cracks, std::cref(series)));
  for (std::future<ClaimOutcome> &of_series : outcomes)
    outcome.add(of_series.get());
  if (!quick)
    crack_rows(outcome).attempt("curves of the exact solution", [&] { add_curves(outcome, every); });
  return outcome;
}

ClaimOutcome check_steady_crack(const ClaimInput &input)
{
  return steady_crack_claim(input.quick);
}

} // namespace latcon::claims
