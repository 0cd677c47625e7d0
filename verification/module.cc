#include "verification/elements/elements.h"

#include "continuum/parallel_session.h"
#include "verification/commands/command.h"

namespace latcon::elements
{
namespace
{

std::shared_ptr<void> start()
{
  return std::make_shared<continuum::ParallelSession>();
}

} // namespace
} // namespace latcon::elements

extern "C" const latcon::elements::Elements *latcon_elements()
{
  using namespace latcon;
  static const elements::Elements table{claims::run_claims, commands::run_continuum, elements::start};
  return &table;
}
