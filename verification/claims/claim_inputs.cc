#include "verification/claims/claim_inputs.h"

#include <algorithm>
#include <set>
#include <utility>

#include "support/full_precision.h"
#include "support/largest_error.h"
#include "verification/input/files.h"
#include "verification/output/run_info.h"

namespace latcon::claims
{
namespace
{

bool has_user_law(const input::Case &input)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number) && input.shell(number).has_user_law())
      return true;
  return false;
}

// Claims choose their own sheets; a subject needs one for its bonds alone.
constexpr double sheet_size = 12.; // spacings

// Lines `Section/Name=value` of the entries that claims may read.
std::vector<std::string> assignments(const input::Case &input, const std::vector<std::string> &further)
{
  input::Case copy = input; // declaring binds entries to members that may be written
  input::Parameters parameters;
  copy.declare(parameters);
  std::set<std::string> keys(further.begin(), further.end());
  for (const input::Declaration &entry : parameters.declarations())
    if (entry.read_by == input::ReadBy::claims ||
        (entry.read_by == input::ReadBy::claims_on_user_laws && has_user_law(input)))
      keys.insert(entry.key());
  std::vector<std::string> lines;
  for (const std::string &key : keys)
    lines.push_back(key + "=" + parameters.value(key));
  return lines;
}

} // namespace

std::string claim_inputs_text(const input::Case &input, const std::vector<std::string> &further)
{
  std::string text;
  for (const std::string &line : assignments(input, further))
    text += line + "\n";
  return text;
}

input::Case claim_inputs(const input::Case &input, const std::vector<std::string> &further)
{
  std::vector<std::string> lines = assignments(input, further);
  for (const char *extent : {"length", "height"})
    lines.push_back(std::string("Sheet/") + extent + "=" + support::full_precision(sheet_size * input.spacing));
  input::Case read;
  input::Parameters parameters;
  read.declare(parameters);
  parameters.read_overrides(lines);
  parameters.finish();
  return read;
}

VerdictKey::VerdictKey(std::string inputs) : text(std::move(inputs)), hash(input::sha256(text)) {}

VerdictKey verdict_key(const input::Case &input, const std::vector<Claim> &claims, const bridge::Laws &laws, bool quick,
                       unsigned int n_ranks)
{
  const bool is_about_program =
    !claims.empty() &&
    std::all_of(claims.begin(), claims.end(), [](const Claim &claim) { return claim.is_about_program; });
  std::string text = "program=" + output::program_hash() + "\n";
  std::vector<std::string> entries;
  for (const Claim &claim : claims)
  {
    text += "claim=" + claim.name + "\n";
    entries.insert(entries.end(), claim.entries.begin(), claim.entries.end());
  }
  text += std::string("quick=") + (quick ? "true" : "false") + "\n";
  if (is_about_program)
    return VerdictKey(text);
  text += "laws="; // they decide which rows can fail
  for (const bridge::Law law : laws)
    text += std::to_string(static_cast<int>(law)) + ",";
  text += "\nranks=" + std::to_string(n_ranks) + "\n";
  return VerdictKey(text + claim_inputs_text(input, entries));
}

void check_user_laws(const input::Case &input, input::Parameters &parameters)
{
  if (!parameters.good())
    return; // there may be no law
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    try
    {
      if (input.has_shell(number) && input.shell(number).has_user_law())
        (void)input.shell(number).shell(support::largest_of({largest_stretch, input.longest_stretch()}));
    }
    catch (const input::UserLaw::Problem &problem)
    {
      const std::string section = input::Case::shell_sections[number];
      parameters.error(section + "/" + problem.entry,
                       "claims evaluate the law at stretches up to " + support::full_precision(largest_stretch) + ": " +
                         problem.what(),
                       {section + "/law"});
    }
}

} // namespace latcon::claims
