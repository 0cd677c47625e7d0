#include "verification/claims/claim_inputs.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <utility>

#include "support/full_precision.h"
#include "support/largest_error.h"
#include "verification/input/sha256.h"
#include "verification/output/run_info.h"

namespace latcon::claims
{
namespace
{

// Entries of which a Subject is made. Further ones are in the table of claims.
constexpr std::array entries_of_subject{
  "Sheet/spacing",    "Sheet/orientation", "Material/density", "Loading/strain x",
  "Loading/strain y", "Loading/shear",     "Continuum/ratio",
};
// Those of each shell, in its section; claims are about bonds without plastic stretch, which has no continuum
// counterpart.
constexpr std::array entries_of_shell{
  "present",          "law",         "a",          "b",
  "modulus",          "psi",         "parameters", "library",
  "library sha256",   "area factor", "viscosity",  "branch moduli",
  "relaxation times",
};

// Entries of which the largest stretch of a bond follows, up to which a law of the user must have values.
constexpr std::array entries_of_user_law{
  "Fracture/breaking stretch", "Fracture/toughening",   "Fracture/factor",          "Fracture/shell factors",
  "Fracture/rate factor",      "Loading/history times", "Loading/history strain x", "Loading/history strain y",
};

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
  std::set<std::string> allowed(entries_of_subject.begin(), entries_of_subject.end());
  for (const char *section : input::Case::shell_sections)
    for (const char *entry : entries_of_shell)
      allowed.insert(std::string(section) + "/" + entry);
  allowed.insert(further.begin(), further.end());
  if (has_user_law(input))
    allowed.insert(entries_of_user_law.begin(), entries_of_user_law.end());
  input::Case copy = input; // declaring binds entries to members that may be written
  input::Parameters parameters;
  copy.declare(parameters);
  std::vector<std::string> lines;
  std::set<std::string> declared;
  for (const auto &[key, value] : parameters.values())
  {
    if (allowed.count(key) > 0)
      lines.push_back(key + "=" + value);
    declared.insert(key);
  }
  for (const std::string &key : further)
    if (declared.count(key) == 0)
      throw std::logic_error("the table of claims names `" + key + "`, which is no entry of a case");
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
