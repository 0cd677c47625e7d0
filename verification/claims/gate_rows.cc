#include "verification/claims/gate_rows.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace latcon::claims
{

std::string row_problem(const output::Results &results, const std::string &shells, const std::vector<Claim> &claims)
{
  std::map<std::string, std::vector<std::string>> required;
  for (const Claim &claim : claims)
    required[claim.name] = claim.required_rows;
  std::set<std::pair<std::string, std::string>> decided;
  for (const output::Result &row : results.rows())
  {
    const bool is_own = required.count(row.claim) > 0 && row.quantity.size() > shells.size() &&
                        row.quantity.compare(0, shells.size(), shells) == 0 &&
                        (row.quantity[shells.size()] == ':' || row.quantity[shells.size()] == ',');
    if (!is_own)
      return "`" + row.claim + "` has no row `" + row.quantity + "`";
    if (row.error && row.tolerance)
      decided.emplace(row.claim, row.quantity);
  }
  for (const auto &[claim, quantities] : required)
    for (const std::string &quantity : quantities)
      if (decided.count({claim, shells + quantity}) == 0)
        return "the row `" + shells + quantity + "` of `" + claim + "` is missing";
  return "";
}

} // namespace latcon::claims
