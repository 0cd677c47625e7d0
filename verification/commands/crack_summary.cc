#include "verification/commands/crack_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "support/text_wrap.h"

namespace latcon::commands
{
namespace
{

constexpr std::size_t columns = 120;
// Leaves room for the measured quantities; results.csv has all rows.
constexpr std::size_t most_failing_rows = 4;

// Unit and scale for display.
struct Display
{
  double scale;
  std::string unit;
};

Display display(const std::string &unit)
{
  if (unit == "m")
    return {1e2, " cm"};
  if (unit == "m^2")
    return {1e6, " mm²"};
  if (unit == "s")
    return {1e3, " ms"};
  if (unit == "degrees")
    return {1., "°"};
  return {1., unit == "1" ? "" : " " + unit};
}

std::string format_number(const char *format, int digits, double value)
{
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

// A number with a readable unit: lengths in cm, areas in mm^2, times in ms. @param deviation standard deviation in the
// same unit, or none
std::string quantity_text(const double value, const std::optional<double> deviation, const std::string &unit)
{
  const Display shown = display(unit);
  // Equal values have a deviation of round-off.
  if (!deviation || !(*deviation > 1e-12 * std::abs(value)))
    return format_number("%.*g", 4, shown.scale * value) + shown.unit;
  // Two digits of the deviation, and the value to the same decimal place.
  const double spread = shown.scale * *deviation;
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(spread))), 0, 12);
  if (digits > 6 && std::abs(shown.scale * value) < 1e-3)
    return format_number("%.*e", 1, shown.scale * value) + " ± " + format_number("%.*e", 1, spread) + shown.unit;
  return format_number("%.*f", digits, shown.scale * value) + " ± " + format_number("%.*f", digits, spread) +
         shown.unit;
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
  {
    std::array<char, 32> percent{};
    std::snprintf(percent.data(), percent.size(), ", %+.1f %%", 100. * (measured->value / *reference - 1.));
    line += percent.data();
  }
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
  {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), seconds < 10. ? " %.1f s" : " %.0f s", seconds);
    text += (text.empty() ? "" : ", ") + phase + number.data();
  }
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
         columns))
    text += line + "\n";
  text += line_of("Lagrangian crack speed", crack.speed_lagrangian, "m/s", input.reference_speed);
  text += line_of("laboratory crack speed", crack.speed_laboratory, "m/s", {});
  text += line_of("wavelength, undeformed", crack.wavelength, "m", input.reference_wavelength);
  text += line_of("amplitude, undeformed", crack.amplitude, "m", input.reference_amplitude);
  text += claim_lines(results);
  return results.count(output::Verdict::fails) > 0 ? text + results.verdict_text(most_failing_rows) : text;
}

} // namespace latcon::commands
