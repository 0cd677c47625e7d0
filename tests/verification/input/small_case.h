#pragma once

// A small sheet of rubber, with entries of a test in place of its own.

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "support/errors.h"
#include "verification/input/case.h"

namespace small_case
{

using latcon::input::Case;
using latcon::input::Parameters;
using Lines = std::vector<std::string>;

/// @param others entries in place of those of the sheet, unless they are given
inline void read(Lines given, Case &input, Parameters &parameters, const Lines &others = {})
{
  const auto key = [](const std::string &entry) { return entry.substr(0, entry.find('=')); };
  for (const Lines &more : {others, Lines{"Sheet/spacing=1 mm", "Sheet/length=20 mm", "Sheet/height=20 mm",
                                          "Material/density=944", "Loading/strain x=0.5", "Loading/strain y=0.5"}})
    for (const std::string &entry : more)
      if (std::none_of(given.begin(), given.end(), [&](const std::string &other) { return key(other) == key(entry); }))
        given.push_back(entry);
  input.declare(parameters);
  parameters.read_overrides(given);
  input.check(parameters);
}

/// Problems of a case, among them those that a command has with it.
inline Lines problems(
  const Lines &given, Case &input, const Lines &others = {},
  const std::function<void(const Case &, Parameters &)> &check = [](const Case &, Parameters &) {})
{
  Parameters parameters;
  read(given, input, parameters, others);
  check(input, parameters);
  try
  {
    parameters.finish();
  }
  catch (const latcon::support::InputError &error)
  {
    return error.problems();
  }
  return {};
}

} // namespace small_case
