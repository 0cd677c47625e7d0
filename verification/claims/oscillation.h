#pragma once

#include <cstddef>
#include <functional>
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

/// Returns the oscillation without the error of the time stepping, of second order, from runs with a step and half of
/// it.
Oscillation extrapolated(const Oscillation &whole, const Oscillation &half);

/// Amplitudes of waves on a sheet in motion, at equal intervals of time.
class WaveRecord
{
public:
  explicit WaveRecord(std::size_t n_waves) : amplitudes_(n_waves), turns_(n_waves, 0) {}

  /// Appends the amplitude of a wave. @throws std::runtime_error if it is not finite
  void add(std::size_t wave, double value);

  /// Returns true if each wave has changed its sign twice: one does so within three quarters of its damped period, one
  /// that is overdamped never.
  bool have_turned() const;

  /// Returns the fits to all waves. @param step between the samples [s] @throws what fit_oscillation() throws
  std::vector<Oscillation> fit(double step) const;

private:
  std::vector<std::vector<double>> amplitudes_;
  std::vector<unsigned int> turns_;
};

/// Samples and steps a wave through 0.8 of a period, and fits its amplitude.
/// @param amplitude of the present state @param advance one time step
Oscillation followed(double frequency, double time_step, std::size_t stride, const std::function<double()> &amplitude,
                     const std::function<void()> &advance);

/// Periods for which followed() follows a wave.
inline constexpr double followed_periods = 0.8;

/// Returns the time steps between samples, for that many samples in a period of the wave.
/// @throws std::runtime_error if the wave does not oscillate
std::size_t sampling_stride(double frequency, double decay, double time_step, double samples_per_period);

/// Least-squares fit to values at the times 0, step, 2 step, ...: a linear recurrence over an eighth of a period for a
/// start, then Gauss-Newton. No initial guess is needed.
/// @param values at least half a period of an oscillation that starts near an extreme
/// @throws std::runtime_error if the values do not oscillate, or the fit does not converge
Oscillation fit_oscillation(const std::vector<double> &values, double step);

} // namespace latcon::claims
