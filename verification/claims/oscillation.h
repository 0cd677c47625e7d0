#pragma once

#include <array>
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
  double residual;  ///< rms of the residual of the fit, over the rms of the values [-]
};

/// Returns the oscillation without the error of the time stepping, of second order, from runs with a step and half of
/// it.
Oscillation extrapolated(const Oscillation &whole, const Oscillation &half);

/// Returns those of two waves.
std::array<Oscillation, 2> extrapolated(const std::array<Oscillation, 2> &whole,
                                        const std::array<Oscillation, 2> &half);

/// Samples and steps two waves of one sheet until each has changed its sign twice, within three quarters of its damped
/// period, and fits their amplitudes. @param amplitudes of the present state @param advance one time step
/// @param stride time steps between samples @param sheet in the message: "the lattice"
/// @throws std::runtime_error if a wave has not turned in `max_steps`; what fit_oscillation() throws
std::array<Oscillation, 2> followed_to_turns(double time_step, std::size_t stride, std::size_t max_steps,
                                             const std::string &sheet,
                                             const std::function<std::array<double, 2>()> &amplitudes,
                                             const std::function<void()> &advance);

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
/// @throws std::runtime_error if the values do not oscillate or are not finite, or the fit does not converge
Oscillation fit_oscillation(const std::vector<double> &values, double step);

} // namespace latcon::claims
