#include "verification/elements/elements.h"

#include <cmath>

#include "continuum/parallel_session.h"
#include "verification/bridge/damaged_sheet.h"
#include "verification/commands/continuum_commands.h"

namespace latcon::elements
{
namespace
{

CrackCost crack_cost(const input::Case &input, input::Parameters &parameters)
{
  const bridge::DamagedSheet sheet = bridge::damaged_sheet(input, parameters);
  return {sheet.cells, std::ceil(input.end_time / sheet.step) * sheet.stages};
}

std::shared_ptr<void> start()
{
  return std::make_shared<continuum::ParallelSession>();
}

} // namespace
} // namespace latcon::elements

extern "C" const latcon::elements::Elements &latcon_elements()
{
  using namespace latcon;
  static const elements::Elements table{claims::run_claims, commands::run_continuum, commands::run_continuum_fracture,
                                        elements::crack_cost, elements::start};
  return table;
}
