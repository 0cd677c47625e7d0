#include "verification/claims/oscillation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "support/dense.h"

namespace latcon::claims
{
namespace
{

// Index of the first sample past the first change of sign: about a quarter of a period.
std::size_t first_crossing(const std::vector<double> &values)
{
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] * values[0] <= 0.)
      return i;
  throw std::runtime_error("the wave did not oscillate in the time that it was given");
}

// Frequency and decay of a(t + 2s) = c1 a(t + s) + c2 a(t), with the stride s in samples.
std::complex<double> recurrence(const std::vector<double> &values, double step, std::size_t stride)
{
  const auto n = static_cast<Eigen::Index>(values.size() - 2 * stride);
  Eigen::MatrixXd A(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const auto at = static_cast<std::size_t>(i);
    A.row(i) << values[at + stride], values[at];
    b[i] = values[at + 2 * stride];
  }
  const Eigen::Vector2d c = support::least_squares(A, b);
  const std::complex<double> root = 0.5 * (c[0] + std::sqrt(std::complex<double>(c[0] * c[0] + 4. * c[1])));
  return std::log(root) / (static_cast<double>(stride) * step);
}

} // namespace

Sampling sampling_of(double frequency, double decay, double time_step, double per_period)
{
  if (!(frequency > 0.) || !std::isfinite(frequency) || !std::isfinite(decay))
    throw std::runtime_error("a wave does not oscillate: it is overdamped, or the sheet is unstable");
  const double steps = 2. * M_PI / frequency / time_step; // of a period
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(steps / per_period));
  return {time_step, stride,
          static_cast<std::size_t>(std::ceil(sampled_periods * steps / static_cast<double>(stride)))};
}

std::vector<Oscillation> followed(const Sampling &sampling, std::size_t max_steps, const std::string &sheet,
                                  const std::function<std::vector<double>()> &amplitudes,
                                  const std::function<void()> &advance)
{
  std::vector<std::vector<double>> values; // of each wave
  std::vector<unsigned int> turns;
  const auto is_over = [&]
  {
    return sampling.n_samples > 0
             ? !values.empty() && values[0].size() > sampling.n_samples
             : !turns.empty() && std::all_of(turns.begin(), turns.end(), [](unsigned int n) { return n >= 2; });
  };
  for (std::size_t step = 0; !is_over(); ++step)
  {
    if (step > max_steps)
      throw std::runtime_error("a wave of " + sheet + " did not oscillate: it is overdamped, or unstable");
    if (step > 0)
      advance();
    if (step % sampling.stride != 0)
      continue;
    const std::vector<double> now = amplitudes();
    values.resize(now.size());
    turns.resize(now.size());
    for (std::size_t w = 0; w < now.size(); ++w)
    {
      if (!std::isfinite(now[w]))
        throw std::runtime_error("a wave has an amplitude that is not finite");
      turns[w] += !values[w].empty() && now[w] * values[w].back() < 0. ? 1 : 0;
      values[w].push_back(now[w]);
    }
  }
  std::vector<Oscillation> found;
  for (const std::vector<double> &of_wave : values)
    found.push_back(fit_oscillation(of_wave, static_cast<double>(sampling.stride) * sampling.time_step));
  return found;
}

std::vector<Oscillation> extrapolated(const Sampling &whole, std::size_t half_stride,
                                      const std::function<std::vector<Oscillation>(const Sampling &)> &run)
{
  const std::vector<Oscillation> coarse = run(whole);
  std::vector<Oscillation> found = run({0.5 * whole.time_step, half_stride, whole.n_samples});
  for (std::size_t w = 0; w < found.size(); ++w)
  {
    found[w].frequency += (found[w].frequency - coarse[w].frequency) / 3.;
    found[w].decay += (found[w].decay - coarse[w].decay) / 3.;
  }
  return found;
}

Oscillation fit_oscillation(const std::vector<double> &values, double step)
{
  const std::size_t stride = std::max<std::size_t>(1, first_crossing(values) / 2);
  if (values.size() < 4 * stride + 4)
    throw std::runtime_error("the wave was followed for less than half a period");
  const std::complex<double> start = recurrence(values, step, stride);
  double g = -start.real(), w = std::abs(start.imag());

  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::Map<const Eigen::VectorXd> a(values.data(), n);
  Eigen::MatrixXd J(n, 4);
  Eigen::Vector2d amplitudes = Eigen::Vector2d::Zero();
  // Quadratic, since the values are an oscillation but for small terms; a handful of steps reach round-off.
  constexpr int max_iterations = 50;
  for (int iteration = 0; iteration < max_iterations; ++iteration)
  {
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const double t = static_cast<double>(i) * step, fade = std::exp(-g * t);
      J(i, 0) = fade * std::cos(w * t);
      J(i, 1) = fade * std::sin(w * t);
    }
    amplitudes = support::least_squares(J.leftCols<2>(), a);
    const Eigen::VectorXd left = a - J.leftCols<2>() * amplitudes;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const double wt = static_cast<double>(i) * step * w; // derivatives by g/w and by the logarithm of w
      J(i, 2) = -wt * (amplitudes[0] * J(i, 0) + amplitudes[1] * J(i, 1));
      J(i, 3) = wt * (-amplitudes[0] * J(i, 1) + amplitudes[1] * J(i, 0));
    }
    const Eigen::Vector4d change = support::least_squares(J, left);
    g += w * change[2];
    w *= 1. + change[3];
    if (!(w > 0.) || !std::isfinite(g))
      break;
    // Round-off of the values themselves can keep the last digits moving.
    if (std::abs(change[2]) + std::abs(change[3]) < (iteration > 8 ? 1e-10 : 1e-13))
      return {w, g};
  }
  throw std::runtime_error("no oscillation fits the wave's amplitude");
}

} // namespace latcon::claims
