#include "verification/claims/claim_inputs.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <variant>

#include "support/full_precision.h"
#include "support/largest_error.h"
#include "verification/input/case_text.h"

namespace latcon::claims
{
namespace
{

// Entries of which a Subject is made. Further ones are in the descriptors of claims.
constexpr std::array entries_of_subject{
  "Sheet/spacing",
  "Sheet/orientation",
  "Material/density",
  "Nearest neighbours/law",
  "Nearest neighbours/a",
  "Nearest neighbours/b",
  "Nearest neighbours/modulus",
  "Nearest neighbours/psi",
  "Nearest neighbours/parameters",
  "Nearest neighbours/library",
  "Nearest neighbours/library sha256",
  "Nearest neighbours/area factor",
  "Nearest neighbours/viscosity",
  "Nearest neighbours/branch moduli",
  "Nearest neighbours/relaxation times",
  "Next-nearest neighbours/present",
  "Next-nearest neighbours/law",
  "Next-nearest neighbours/a",
  "Next-nearest neighbours/b",
  "Next-nearest neighbours/modulus",
  "Next-nearest neighbours/psi",
  "Next-nearest neighbours/parameters",
  "Next-nearest neighbours/library",
  "Next-nearest neighbours/library sha256",
  "Next-nearest neighbours/area factor",
  "Next-nearest neighbours/viscosity",
  "Next-nearest neighbours/branch moduli",
  "Next-nearest neighbours/relaxation times",
  "Loading/strain x",
  "Loading/strain y",
  "Loading/shear",
  "Continuum/ratio",
};

// Entries of which the largest stretch of a bond follows, up to which a law of the user must have values.
constexpr std::array entries_of_user_law{"Fracture/breaking stretch", "Fracture/toughening", "Fracture/factor"};

bool has_user_law(const input::Case &input)
{
  return input.nearest.has_user_law() || (input.has_next_nearest && input.next_nearest.has_user_law());
}

// Claims choose their own sheets; a subject needs one for its bonds alone.
constexpr double sheet_size = 12.; // spacings

// Lines `Section/Name=value` of the entries that claims may read.
std::vector<std::string> assignments(const input::Case &input, const std::vector<std::string> &further)
{
  std::set<std::string> allowed(entries_of_subject.begin(), entries_of_subject.end());
  allowed.insert(further.begin(), further.end());
  if (has_user_law(input))
    allowed.insert(entries_of_user_law.begin(), entries_of_user_law.end());
  input::Case copy = input; // declaring binds entries to members that may be written
  input::Parameters parameters;
  copy.declare(parameters);
  std::vector<std::string> lines;
  std::set<std::string> declared;
  for (const auto &item : input::read_prm(parameters.resolved_text(), "case"))
    if (const auto *entry = std::get_if<input::Assignment>(&item))
    {
      const std::string key = entry->section + "/" + entry->name;
      if (allowed.count(key) > 0)
        lines.push_back(key + "=" + entry->value);
      declared.insert(key);
    }
  for (const std::string &key : further)
    if (declared.count(key) == 0)
      throw std::logic_error("the descriptor of a claim names `" + key + "`, which is no entry of a case");
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

void check_user_laws(const input::Case &input, input::Parameters &parameters)
{
  if (!parameters.good())
    return; // there may be no law
  const auto check = [&](const input::ShellCase &shell, const std::string &section)
  {
    if (!shell.has_user_law())
      return;
    try
    {
      (void)shell.shell(support::largest_of({largest_stretch, input.longest_stretch()}));
    }
    catch (const input::UserLaw::Problem &problem)
    {
      parameters.error(section + "/" + problem.entry,
                       "claims evaluate the law at stretches up to " + support::full_precision(largest_stretch) + ": " +
                         problem.what(),
                       {section + "/law"});
    }
  };
  check(input.nearest, "Nearest neighbours");
  if (input.has_next_nearest)
    check(input.next_nearest, "Next-nearest neighbours");
}

void check_user_laws_of(const std::vector<Claim> &claims, const input::Case &input, input::Parameters &parameters)
{
  for (const Claim &claim : claims)
  {
    if (claim.takes_user_laws)
      continue;
    const std::string reason = "the claim " + claim.name + " evaluates laws far beyond the stretch of " +
                               support::full_precision(largest_stretch) +
                               " up to which user-defined ones are checked; allowed: mooney-rivlin, linear";
    if (input.nearest.has_user_law())
      parameters.error("Nearest neighbours/law", reason);
    if (input.has_next_nearest && input.next_nearest.has_user_law())
      parameters.error("Next-nearest neighbours/law", reason);
  }
}

} // namespace latcon::claims
