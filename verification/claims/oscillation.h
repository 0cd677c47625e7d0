#pragma once

#include <vector>

namespace latcon::claims
{

/// A damped oscillation a(t) = exp(-g t) (A cos w t + B sin w t) + residual.
struct Oscillation
{
  double frequency; ///< w [rad/s]
  double decay;     ///< g [1/s]
  double residual;  ///< rms of the residual of the fit, over the rms of the values [-]
};

/// Least-squares fit to values at the times 0, step, 2 step, ...: a linear recurrence over an eighth of a period for a
/// start, then Gauss-Newton. No initial guess is needed.
/// @param values at least half a period of an oscillation that starts near an extreme
/// @throws std::runtime_error if the values do not oscillate, or the fit does not converge
Oscillation fit_oscillation(const std::vector<double> &values, double step);

} // namespace latcon::claims
