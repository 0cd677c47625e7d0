#include "support/full_precision.h"

#include <array>
#include <charconv>
#include <cmath>

namespace latcon::support
{

std::string full_precision(const double value)
{
  if (std::isnan(value))
    return "nan";
  std::array<char, 32> digits{};
  const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  (void)status; // the longest text has 24 characters
  return std::string(digits.data(), end);
}

} // namespace latcon::support
