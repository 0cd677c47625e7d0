// For programs that link the finite elements, as those of the tests: nothing is loaded.
#include "verification/elements/elements.h"

namespace latcon::elements
{

const Elements &elements()
{
  return *latcon_elements();
}

void finish() {}

} // namespace latcon::elements
