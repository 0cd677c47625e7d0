// libFuzzer: whatever is in a case, it is read, or refused by an InputError, and nothing else. A case
// that is good is the same case after it has been written and read again.
//
// The first byte of an input says what the rest is: 0 a case as .prm, 1 as .json, 2 options of --set (a line each) for
// a good case.
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "support/errors.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/input/case.h"

using namespace latcon;

namespace
{

using namespace bridge;
using namespace input;

// A good case, short; the sheet of quick.prm.
const std::string good = R"(
subsection Sheet
  set spacing = 0.625 mm
  set length = 4 cm
  set height = 2.5 cm
end
subsection Material
  set density = 944
end
subsection Loading
  set strain x = 1.3
  set strain y = 1.8
end
)";

[[noreturn]] void fail(const std::string &what)
{
  std::cerr << what << std::endl;
  std::abort();
}

std::vector<std::string> lines_of(const std::string &text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line))
    lines.push_back(line);
  return lines;
}

void read_case(const std::string &text, const std::string &name, const std::vector<std::string> &overrides)
{
  Case input;
  Parameters parameters;
  input.declare(parameters);
  parameters.read_text(text, name);
  parameters.read_overrides(overrides);
  input.check(parameters);
  parameters.finish();
  const std::string resolved = parameters.resolved_text();

  Case again;
  Parameters parameters_again;
  again.declare(parameters_again);
  parameters_again.read_text(resolved, "resolved.prm");
  again.check(parameters_again);
  try
  {
    parameters_again.finish();
  }
  catch (const latcon::support::InputError &error)
  {
    fail(std::string("a good case is refused once it is written: ") + error.what());
  }
  if (parameters.lines() != parameters_again.lines())
    fail("a case is another one once it is written");

  // Further checks of a command may refuse the input.
  if (overrides.size() % 2 == 0)
    require_lattice_sheet(again, parameters_again, "`latcon lattice`");
  else
    require_fracture_case(again, parameters_again);
  parameters_again.finish();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  if (size == 0)
    return -1;
  const std::string text(reinterpret_cast<const char *>(data + 1), size - 1);
  try
  {
    switch (data[0])
    {
    case 0:
      read_case(text, "case.prm", {});
      break;
    case 1:
      read_case(text, "case.json", {});
      break;
    case 2:
      read_case(good, "case.prm", lines_of(text));
      break;
    default:
      return -1;
    }
  }
  catch (const latcon::support::InputError &)
  {
  }
  return 0;
}
