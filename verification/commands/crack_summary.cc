#include "verification/commands/command.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "support/text_wrap.h"
#include "verification/analysis/crack_measurement.h"

namespace latcon::commands
{
namespace
{

// Leaves room for the measured quantities; results.csv has all rows.
constexpr std::size_t most_failing_rows = 4;

// A number with a readable unit: lengths in cm. @param deviation standard deviation in the same unit, or none
std::string quantity_text(const double value, const std::optional<double> deviation, const std::string &unit)
{
  const double scale = unit == "m" ? 1e2 : 1.;
  const std::string symbol = unit == "m" ? " cm" : " " + unit;
  // Equal values have a deviation of round-off.
  if (!deviation || !(*deviation > 1e-12 * std::abs(value)))
    return support::formatted("%.4g", scale * value) + symbol;
  // Two digits of the deviation, and the value to the same decimal place.
  const double spread = scale * *deviation;
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(spread))), 0, 12);
  if (digits > 6 && std::abs(scale * value) < 1e-3)
    return support::formatted("%.1e", scale * value) + " ± " + support::formatted("%.1e", spread) + symbol;
  return support::formatted("%.*f", digits, scale * value) + " ± " + support::formatted("%.*f", digits, spread) +
         symbol;
}

// One quantity: "  wavelength, undeformed   2.359 ± 0.026 cm    reference 2.3 cm, +2.6 %".
std::string line_of(const std::string &name, const std::optional<analysis::Measured> &measured, const std::string &unit,
                    const std::optional<double> &reference)
{
  if (!measured && !reference)
    return "";
  std::string line = "  " + support::padded(name, 26);
  line += measured ? quantity_text(measured->value, measured->uncertainty, unit) : "not measured";
  if (!reference)
    return line + "\n";
  line = support::padded(line, 52) + "reference " + quantity_text(*reference, {}, unit);
  if (measured)
    line += support::formatted(", %+.1f %%", 100. * (measured->value / *reference - 1.));
  return line + "\n";
}

} // namespace

std::string claim_lines(const output::Results &results)
{
  std::vector<std::pair<std::string, output::Results>> claims; // in the order of their first rows
  for (const output::Result &row : results.rows())
  {
    auto claim =
      std::find_if(claims.begin(), claims.end(), [&](const auto &known) { return known.first == row.claim; });
    if (claim == claims.end())
      claim = claims.insert(claims.end(), {row.claim, {}});
    claim->second.add(row);
  }
  std::string text;
  for (const auto &[claim, rows] : claims)
    text += "  " + support::padded(claim, 26) + rows.count_text() + "\n";
  return text;
}

std::string times_text(const std::vector<std::pair<std::string, double>> &times)
{
  std::string text;
  for (const auto &[phase, seconds] : times)
    text += (text.empty() ? "" : ", ") + phase + support::formatted(seconds < 10. ? " %.1f s" : " %.0f s", seconds);
  return text;
}

std::string crack_summary(const input::Case &input, const analysis::CrackMeasurement &crack,
                          const output::Results &results)
{
  const std::string pattern = to_string(crack.pattern);
  std::string text;
  for (const std::string &line : support::wrap_text(
         (crack.pattern == analysis::CrackPattern::undecided ? "The pattern of the crack is " : "The crack is ") +
           pattern + ": " + crack.reason,
         120))
    text += line + "\n";
  text += line_of("Lagrangian crack speed", crack.speed_lagrangian, "m/s", input.reference_speed);
  text += line_of("laboratory crack speed", crack.speed_laboratory, "m/s", {});
  text += line_of("wavelength, undeformed", crack.wavelength, "m", input.reference_wavelength);
  text += line_of("amplitude, undeformed", crack.amplitude, "m", input.reference_amplitude);
  text += claim_lines(results);
  return results.count(output::Verdict::fails) > 0 ? text + results.verdict_text(most_failing_rows) : text;
}

} // namespace latcon::commands
