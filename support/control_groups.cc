#include "support/control_groups.h"

#include <fstream>

namespace latcon::support
{

namespace fs = std::filesystem;

void for_each_control_group(const fs::path &root, const std::string &controller,
                            const std::function<void(const fs::path &group, int version)> &visit)
{
  std::ifstream groups(root / "proc/self/cgroup");
  std::string line; // "NUMBER:CONTROLLERS:NAME"; in version 2 "0::NAME"
  while (std::getline(groups, line))
  {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos)
      continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), name = line.substr(second + 1);
    const int version = controllers.empty() ? 2 : 1;
    if (version == 1 && ("," + controllers + ",").find("," + controller + ",") == std::string::npos)
      continue;
    fs::path group = root / "sys/fs/cgroup" / (version == 1 ? controller : "");
    visit(group, version);
    for (const fs::path &part : fs::path(name).relative_path())
      visit(group /= part, version);
  }
}

} // namespace latcon::support
