#include "verification/commands/command.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <nlohmann/json.hpp>

#include "verification/input/case_text.h"
#include "verification/output/output_file.h"

namespace latcon::commands
{

using claims::Claim;

namespace
{

template <typename Condition>
std::vector<Claim> claims_where(const Condition &condition)
{
  std::vector<Claim> list;
  std::copy_if(claim_registry().begin(), claim_registry().end(), std::back_inserter(list), condition);
  return list;
}

std::vector<std::string> names()
{
  std::vector<std::string> list;
  for (const Claim &claim : claim_registry())
    list.push_back(claim.name);
  return list;
}

} // namespace

const std::vector<Claim> &claim_registry()
{
  static const std::vector<Claim> claims{
#define LATCON_CLAIM(name_, title_, statement_, ...)                                                                   \
  []                                                                                                                   \
  {                                                                                                                    \
    Claim claim{claims::claim_name(#name_), title_, statement_};                                                       \
    __VA_ARGS__ return claim;                                                                                          \
  }(),
#include "verification/claims/claim_table.inc"
#undef LATCON_CLAIM
  };
  return claims;
}

std::vector<Claim> selected_claims(const std::vector<std::string> &names, const lattice::Material &material)
{
  return claims_where(
    [&](const Claim &claim)
    {
      return names.empty() ? claim.is_default_for(material)
                           : std::find(names.begin(), names.end(), claim.name) != names.end();
    });
}

std::vector<Claim> claims_before_fracture(const lattice::Material &material, bool on_continuum)
{
  return claims_where([&](const Claim &claim) { return claim.is_before_fracture(material, on_continuum); });
}

std::string unknown_claim(const std::string &name)
{
  const std::vector<std::string> known = names();
  if (std::find(known.begin(), known.end(), name) != known.end())
    return "";
  return "unknown claim '" + input::printable(name) + "'" +
         input::nearest_hint(name, known, "; claims: " + input::comma_separated(known));
}

std::string claim_choices()
{
  std::string list;
  for (const std::string &name : names())
    list += (list.empty() ? "{" : ",") + name;
  return list + "}";
}

std::string claim_list()
{
  constexpr std::size_t column = 30; // of texts in the help
  std::string text = "Claims:\n";
  for (const Claim &claim : claim_registry())
  {
    std::string line = "  " + claim.name;
    line.resize(std::max(line.size() + 2, column), ' ');
    text += line + claim.title;
    if (claim.is_about_memory)
      text += " (only if named or if bonds have branches)";
    else if (claim.is_about_disorder)
      text += " (only if named or if bonds have disorder)";
    else if (!claim.is_default)
      text += " (only if named)";
    text += "\n";
  }
  return text;
}

void write_claims(const std::vector<Claim> &claims, const std::string &folder)
{
  nlohmann::ordered_json document;
  document["claims"] = nlohmann::ordered_json::array();
  for (const Claim &claim : claims)
    document["claims"].push_back({{"name", claim.name}, {"title", claim.title}, {"statement", claim.statement}});
  output::write_file((std::filesystem::path(folder) / "claims.json").string(), document.dump(2) + "\n");
}

} // namespace latcon::commands
