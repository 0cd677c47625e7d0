#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace latcon::claims
{

/// A damped oscillation a(t) = exp(-g t) (A cos w t + B sin w t) + residual.
struct Oscillation
{
  double frequency; ///< w [rad/s]
  double decay;     ///< g [1/s]
};

/// How waves of a sheet in motion are sampled.
struct Sampling
{
  double time_step;   ///< [s]
  std::size_t stride; ///< time steps between samples
  /// Samples after the first; 0: until each wave has changed its sign twice, within three quarters of its damped
  /// period.
  std::size_t n_samples = 0;
};

/// Periods for which a wave is sampled whose frequency is known.
inline constexpr double sampled_periods = 0.8;

/// Returns the sampling of a wave through them. @param per_period samples @throws std::runtime_error if the wave does
/// not oscillate
Sampling sampling_of(double frequency, double decay, double time_step, double per_period);

/// Samples and steps waves of one sheet, and fits their amplitudes. @param sheet in the message: "the lattice"
/// @param max_steps in which each wave must turn @param amplitudes of the present state @param advance one time step
/// @throws std::runtime_error if a wave has not turned; what fit_oscillation() throws
std::vector<Oscillation> followed(const Sampling &sampling, std::size_t max_steps, const std::string &sheet,
                                  const std::function<std::vector<double>()> &amplitudes,
                                  const std::function<void()> &advance);

/// Returns the oscillations without the error of the time stepping, of second order, from runs with a step and half of
/// it. @param half_stride stride of the second run
std::vector<Oscillation> extrapolated(const Sampling &whole, std::size_t half_stride,
                                      const std::function<std::vector<Oscillation>(const Sampling &)> &run);

/// Least-squares fit to values at the times 0, step, 2 step, ...: a linear recurrence over an eighth of a period for a
/// start, then Gauss-Newton. No initial guess is needed.
/// @param values at least half a period of an oscillation that starts near an extreme
/// @throws std::runtime_error if the values do not oscillate or are not finite, or the fit does not converge
Oscillation fit_oscillation(const std::vector<double> &values, double step);

} // namespace latcon::claims
