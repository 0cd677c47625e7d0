#include "verification/atomic_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <sstream>

#include "support/atomic_file.h"
#include "verification/errors.h"
#include "verification/output_list.h"

namespace verification
{

void write_file(const std::string &path, const std::string &text)
{
  list_output(path);
  replace_file(path, text);
}

void replace_file(const std::string &path, const std::string &text)
{
  try
  {
    latcon::support::write_atomically(path, text, latcon::support::Sync::yes);
  }
  catch (const latcon::support::WriteError &error)
  {
    throw OutputError(path, error.reason());
  }
}

void write_file(const std::string &path, const std::function<void(std::ostream &)> &writer)
{
  std::ostringstream text;
  writer(text);
  if (!text)
    throw OutputError(path, "its content could not be formatted");
  write_file(path, text.str());
}

std::string full_precision(const double value)
{
  if (std::isnan(value))
    return "nan";
  std::array<char, 32> digits{};
  const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  (void)status; // 24 characters are the longest there are
  return std::string(digits.data(), end);
}

} // namespace verification
