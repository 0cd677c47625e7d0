#include "verification/output/quantity_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace latcon::output
{
namespace
{

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

} // namespace

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

} // namespace latcon::output
