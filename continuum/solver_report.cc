#include "continuum/solver_report.h"

#include "support/text_wrap.h"

namespace latcon::continuum
{
std::string SolverReport::text() const
{
  std::string text;
  for (const LoadStep &step : load_steps)
  {
    text += support::formatted("load step %u to %.4e: ", step.number, step.load_factor) +
            (step.accepted ? "converged" : "rejected, " + step.reason) + "\n";
    for (const NewtonIteration &it : iterations)
      if (it.load_step == step.number)
        text +=
          support::formatted("  iteration %2u  residual %.4e N/m  (tolerance %.4e)  energy %.10e J/m  step length "
                             "%.4e  linear iterations %u\n",
                             it.iteration, it.residual, it.tolerance, it.energy, it.step_length, it.linear_iterations);
  }
  return text;
}

SolverFailed::SolverFailed(const std::string &reason, SolverReport report)
  : NoSolution(reason + "\n" + report.text()), report_(std::move(report))
{
}
} // namespace latcon::continuum
