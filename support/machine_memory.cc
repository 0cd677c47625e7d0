#include "support/machine_memory.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include <unistd.h>

#include "support/control_groups.h"

namespace latcon::support
{
namespace
{

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();

std::optional<double> number_in(const fs::path &file)
{
  std::ifstream stream(file);
  double value = 0.;
  if (stream >> value)
    return value;
  return {}; // no such file, or the word "max"
}

// Returns the number after a word at the beginning of a line.
std::optional<double> number_after(const fs::path &file, const std::string &word)
{
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line))
  {
    std::istringstream words(line);
    std::string first;
    double value = 0.;
    if (words >> first && first == word && words >> value)
      return value;
  }
  return {};
}

// Memory that a control group may still take; names of files differ between versions 1 and 2.
double left_in(const fs::path &group, int version)
{
  const bool first = version == 1;
  const std::optional<double> limit = number_in(group / (first ? "memory.limit_in_bytes" : "memory.max")),
                              usage = number_in(group / (first ? "memory.usage_in_bytes" : "memory.current"));
  if (!limit || !usage)
    return unlimited;
  const double cache =
    number_after(group / "memory.stat", first ? "total_inactive_file" : "inactive_file").value_or(0.);
  return std::max(0., *limit - std::max(0., *usage - cache));
}

} // namespace

double available_memory(const fs::path &root)
{
  double available = unlimited;
  if (const auto kibibytes = number_after(root / "proc/meminfo", "MemAvailable:"))
    available = 1024. * *kibibytes;
  for_each_control_group(root, "memory",
                         [&available](const fs::path &group, int version)
                         { available = std::min(available, left_in(group, version)); });
  return available;
}

double resident_memory()
{
  std::ifstream stream("/proc/self/statm"); // pages: total, resident, ...
  double total = 0., resident = 0.;
  if (stream >> total >> resident)
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
  return 0.;
}

std::string readable_bytes(double bytes)
{
  const std::array<const char *, 7> units{"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < units.size(); ++unit)
    bytes /= 1000.;
  std::ostringstream text;
  text.precision(3);
  text << bytes << ' ' << units[unit];
  return text.str();
}

} // namespace latcon::support
