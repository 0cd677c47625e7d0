#include "verification/commands/crack_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "support/text_wrap.h"
#include "verification/study/study_table.h"

namespace latcon::commands
{
namespace
{

constexpr std::size_t columns = 120;
// Few enough to leave room for what was measured; results.csv has all.
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
  line += measured ? study::quantity_text(measured->value, measured->uncertainty, unit) : "not measured";
  if (!reference)
    return line + "\n";
  line = padded(line, 52) + "reference " + study::quantity_text(*reference, {}, unit);
  if (measured)
  {
    std::array<char, 32> percent{};
    std::snprintf(percent.data(), percent.size(), ", %+.1f %%", 100. * (measured->value / *reference - 1.));
    line += percent.data();
  }
  return line + "\n";
}

} // namespace

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
  return text + results.verdict_text(most_failing_rows);
}

} // namespace latcon::commands
