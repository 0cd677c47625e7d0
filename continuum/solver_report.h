#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace latcon::continuum
{
/// One evaluation of the residual within a load step: iteration 0 follows the predictor, later ones a Newton step.
struct NewtonIteration
{
  unsigned int load_step;         ///< counts from 1, rejected ones included
  unsigned int iteration;         ///< within the load step, from 0
  double load_factor;             ///< [-]
  double residual;                ///< Euclidean norm over the free unknowns [N/m], after this step
  double tolerance;               ///< residual that would end the load step here [N/m]
  double energy;                  ///< E less the work of the dead loads [J/m], after this step
  double step_length;             ///< fraction of the Newton step taken, in (0, 1]
  unsigned int linear_iterations; ///< conjugate-gradient iterations, 0 if direct
};

/// One attempt to raise the load.
struct LoadStep
{
  unsigned int number; ///< counts from 1
  double load_factor;  ///< aimed at [-]
  bool accepted;       ///< converged
  std::string reason;  ///< why it was rejected; empty if accepted
};

/// Wall time [s] spent on the calling rank.
struct SolverTimes
{
  double assembly = 0.;       ///< of energies, residuals and tangents
  double preconditioner = 0.; ///< taking over a tangent: coarser tangents and patches
  double linear_solve = 0.;   ///< factorisation and substitution, or conjugate gradients
};

/// Everything that happened in a solve.
struct SolverReport
{
  SolverTimes times;
  std::vector<NewtonIteration> iterations;
  std::vector<LoadStep> load_steps;
  double load_factor = 0.; ///< reached [-]

  /// A table for people, a line for each load step and iteration.
  std::string text() const;
};

/// The load could not be raised to its full value. Holds all that was tried; what() ends with it as a table.
class SolverFailed : public std::runtime_error
{
public:
  SolverFailed(const std::string &reason, SolverReport report);

  const SolverReport &report() const { return report_; }

private:
  SolverReport report_;
};
} // namespace latcon::continuum
