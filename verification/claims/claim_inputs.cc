#include "verification/claims/claim_inputs.h"

#include <algorithm>
#include <array>
#include <variant>
#include <vector>

#include "support/full_precision.h"
#include "verification/input/case_text.h"

namespace latcon::claims
{
namespace
{

// What makes a Subject. A claim that reads a further entry adds it here; the test goes through all entries there are.
constexpr std::array read_by_claims{
  "Sheet/spacing",
  "Sheet/orientation",
  "Material/density",
  "Nearest neighbours/law",
  "Nearest neighbours/a",
  "Nearest neighbours/b",
  "Nearest neighbours/modulus",
  "Nearest neighbours/area factor",
  "Nearest neighbours/viscosity",
  "Next-nearest neighbours/present",
  "Next-nearest neighbours/law",
  "Next-nearest neighbours/a",
  "Next-nearest neighbours/b",
  "Next-nearest neighbours/modulus",
  "Next-nearest neighbours/area factor",
  "Next-nearest neighbours/viscosity",
  "Loading/strain x",
  "Loading/strain y",
  "Loading/shear",
  "Continuum/ratio",
};

// Claims choose their own sheets; a subject needs one for its bonds alone.
constexpr double sheet_size = 12.; // spacings

// Lines `Section/Name=value` of the entries that claims may read.
std::vector<std::string> assignments(const input::Case &input)
{
  input::Case copy = input; // declaring binds entries to members that may be written
  input::Parameters parameters;
  copy.declare(parameters);
  std::vector<std::string> lines;
  for (const auto &item : input::read_prm(parameters.resolved_text(), "case"))
    if (const auto *entry = std::get_if<input::Assignment>(&item))
    {
      const std::string key = entry->section + "/" + entry->name;
      if (std::find(read_by_claims.begin(), read_by_claims.end(), key) != read_by_claims.end())
        lines.push_back(key + "=" + entry->value);
    }
  return lines;
}

} // namespace

std::string claim_inputs_text(const input::Case &input)
{
  std::string text;
  for (const std::string &line : assignments(input))
    text += line + "\n";
  return text;
}

input::Case claim_inputs(const input::Case &input)
{
  std::vector<std::string> lines = assignments(input);
  for (const char *extent : {"length", "height"})
    lines.push_back(std::string("Sheet/") + extent + "=" + support::full_precision(sheet_size * input.spacing));
  input::Case read;
  input::Parameters parameters;
  read.declare(parameters);
  parameters.read_overrides(lines);
  parameters.finish();
  return read;
}

} // namespace latcon::claims
