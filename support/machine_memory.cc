#include "support/machine_memory.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include <unistd.h>

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

// Names of the files of a control group, which differ between versions 1 and 2.
struct GroupFiles
{
  const char *limit, *usage, *cache;
};

double left_in(const fs::path &group, const GroupFiles &files)
{
  const std::optional<double> limit = number_in(group / files.limit), usage = number_in(group / files.usage);
  if (!limit || !usage)
    return unlimited;
  const double cache = number_after(group / "memory.stat", files.cache).value_or(0.);
  return std::max(0., *limit - std::max(0., *usage - cache));
}

// Returns the smallest remaining memory of a group and its parents. In a container the folder of the group may not
// exist under the name given by the system; the group is then the mounted root.
double left_in_groups(const fs::path &mount, const std::string &name, const GroupFiles &files)
{
  double left = left_in(mount, files);
  fs::path group = mount;
  for (const fs::path &part : fs::path(name).relative_path())
  {
    group /= part;
    left = std::min(left, left_in(group, files));
  }
  return left;
}

} // namespace

double available_memory(const fs::path &root)
{
  double available = unlimited;
  if (const auto kibibytes = number_after(root / "proc/meminfo", "MemAvailable:"))
    available = 1024. * *kibibytes;
  std::ifstream groups(root / "proc/self/cgroup");
  std::string line; // "NUMBER:CONTROLLERS:NAME"; in version 2 "0::NAME"
  while (std::getline(groups, line))
  {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos)
      continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), name = line.substr(second + 1);
    if (controllers.empty())
      available = std::min(
        available, left_in_groups(root / "sys/fs/cgroup", name, {"memory.max", "memory.current", "inactive_file"}));
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
      available =
        std::min(available, left_in_groups(root / "sys/fs/cgroup/memory", name,
                                           {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"}));
  }
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
