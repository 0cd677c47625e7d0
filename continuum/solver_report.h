#pragma once

#include "continuum/errors.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// Record of one evaluation of the residual within a load step: iteration 0 is after the predictor or at the state of a
/// coarser mesh, later ones after a Newton step.
struct NewtonIteration
{
  unsigned int load_step;         ///< counts from 1, rejected ones included
  unsigned int iteration;         ///< within the load step, from 0
  double load_factor;             ///< [-]
  double residual;                ///< Euclidean norm over the free unknowns [N/m], after this step
  double tolerance;               ///< converged if the residual is not above [N/m]
  double energy;                  ///< E minus the work of the dead loads [J/m], after this step
  double step_length;             ///< fraction of the Newton step taken, in (0, 1]
  unsigned int linear_iterations; ///< conjugate-gradient iterations, 0 if direct
};

/// Record of one attempt to increase the load.
struct LoadStep
{
  unsigned int number; ///< counts from 1
  double load_factor;  ///< target [-]
  bool accepted;       ///< converged
  std::string reason;  ///< reason of rejection; empty if accepted
};

/// Wall time [s] spent on the calling rank, on coarser meshes too.
struct SolverTimes
{
  double assembly = 0.;       ///< of energies, residuals and tangents
  double preconditioner = 0.; ///< set-up for a tangent: coarser tangents and patches
  double linear_solve = 0.;   ///< factorisation and substitution, or Krylov iterations
};

/// Full record of a solve.
struct SolverReport
{
  SolverTimes times;
  std::vector<NewtonIteration> iterations;
  std::vector<LoadStep> load_steps;

  /// Returns a human-readable table with one line per load step and iteration.
  std::string text() const;
};

/// Error of a solve that did not reach the full load, or of a time step that failed. Contains the record of all
/// attempts; what() ends with it as a table.
class SolverFailed : public NoSolution
{
public:
  SolverFailed(const std::string &reason, SolverReport report);

  const SolverReport &report() const { return report_; }

private:
  SolverReport report_;
};
} // namespace latcon::continuum
