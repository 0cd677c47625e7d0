#include "verification/commands/crack_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "support/text_wrap.h"
#include "verification/output/quantity_text.h"

namespace latcon::commands
{
namespace
{

constexpr std::size_t columns = 120;
// Leaves room for the measured quantities; results.csv has all rows.
constexpr std::size_t most_failing_rows = 4;

std::string padded(const std::string &text, std::size_t width)
{
  return text + std::string(width - std::min(width, support::width_of(text)), ' ');
}

// One quantity: "  wavelength, undeformed   2.359 ± 0.026 cm    reference 2.3 cm, +2.6 %".
std::string line_of(const std::string &name, const std::optional<analysis::Measured> &measured, const std::string &unit,
                    const std::optional<double> &reference)
{
  if (!measured && !reference)
    return "";
  std::string line = "  " + padded(name, 26);
  line += measured ? output::quantity_text(measured->value, measured->uncertainty, unit) : "not measured";
  if (!reference)
    return line + "\n";
  line = padded(line, 52) + "reference " + output::quantity_text(*reference, {}, unit);
  if (measured)
  {
    std::array<char, 32> percent{};
    std::snprintf(percent.data(), percent.size(), ", %+.1f %%", 100. * (measured->value / *reference - 1.));
    line += percent.data();
  }
  return line + "\n";
}

std::string counted(std::size_t n)
{
  return std::to_string(n) + (n == 1 ? " check" : " checks");
}

// One claim: "  energy                    12 checks hold".
std::string line_of_claim(const std::string &claim, const output::Results &rows)
{
  const std::size_t fail = rows.count(output::Verdict::fails), hold = rows.count(output::Verdict::holds);
  std::string line = "  " + padded(claim, 26);
  if (fail > 0)
    return line + std::to_string(fail) + " of " + counted(fail + hold) + (fail == 1 ? " fails\n" : " fail\n");
  if (hold > 0)
    return line + counted(hold) + (hold == 1 ? " holds\n" : " hold\n");
  return line + "nothing was checked\n";
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
    text += line_of_claim(claim, rows);
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
