#include "continuum/solver_report.h"

#include <iomanip>
#include <sstream>

namespace latcon::continuum
{
SolverTimes &SolverTimes::operator+=(const SolverTimes &other)
{
  assembly += other.assembly;
  preconditioner += other.preconditioner;
  linear_solve += other.linear_solve;
  return *this;
}

std::string SolverReport::text() const
{
  std::ostringstream out;
  out << std::scientific << std::setprecision(4);
  for (const LoadStep &step : load_steps)
  {
    out << "load step " << step.number << " to " << step.load_factor << ": "
        << (step.accepted ? "converged" : "rejected, " + step.reason) << "\n";
    for (const NewtonIteration &it : iterations)
      if (it.load_step == step.number)
        out << "  iteration " << std::setw(2) << it.iteration << "  residual " << it.residual << " N/m  (tolerance "
            << it.tolerance << ")  energy " << std::setprecision(10) << it.energy << std::setprecision(4)
            << " J/m  step length " << it.step_length << "  linear iterations " << it.linear_iterations << "\n";
  }
  return out.str();
}

SolverFailed::SolverFailed(const std::string &reason, SolverReport report)
  : std::runtime_error(reason + "\n" + report.text()), report_(std::move(report))
{
}
} // namespace latcon::continuum
