#include "verification/claims/steady_crack/steady_crack_claim.h"

#include <algorithm>

#include <unsupported/Eigen/FFT>

#include "support/largest_error.h"

namespace latcon::claims
{
namespace
{

using Complex = HalfStrip::Complex;
using Spectrum = std::vector<Complex>;

constexpr double two_pi = 2. * M_PI;

// Even samples of a time record and of its transform, f(omega) = integral f(s) exp(-i omega s) ds; the first half of
// either is s or omega >= 0.
class Record
{
public:
  Record(double duration, std::size_t samples) : duration_(duration), samples_(samples)
  {
    fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum); // of omega >= 0
  }

  std::size_t samples() const { return samples_; }
  double step() const { return duration_ / static_cast<double>(samples_); }
  double omega(std::size_t i) const { return two_pi / duration_ * signed_index(i); }
  double time(std::size_t i) const { return step() * signed_index(i); }

  /// Values in time of a transform that is given for omega >= 0.
  std::vector<double> in_time(Spectrum spectrum)
  {
    for (Complex &z : spectrum)
      z /= step();
    spectrum.back() = spectrum.back().real();
    std::vector<double> values;
    fft_.inv(values, spectrum);
    return values;
  }

  /// Transform of values in time, for omega >= 0.
  Spectrum transform(const std::vector<double> &values)
  {
    Spectrum spectrum;
    fft_.fwd(spectrum, values);
    for (Complex &z : spectrum)
      z *= step();
    return spectrum;
  }

  /// Time integral of a rate that vanishes at both ends, 0 at the start of the record: exact at every frequency, the
  /// mean rate as a ramp.
  std::vector<double> integral(const Spectrum &rate)
  {
    Spectrum wave(samples_ / 2 + 1);
    for (std::size_t i = 1; i < samples_ / 2; ++i)
      wave[i] = rate[i] / Complex(0., omega(i));
    std::vector<double> values = in_time(wave);
    const double mean = rate[0].real() / duration_;
    for (std::size_t i = 0; i < samples_; ++i)
      values[i] += mean * time(i);
    const double start = values[samples_ / 2];
    for (double &value : values)
      value -= start;
    return values;
  }

private:
  double signed_index(std::size_t i) const
  {
    return i < samples_ / 2 ? static_cast<double>(i) : static_cast<double>(i) - static_cast<double>(samples_);
  }

  double duration_;
  std::size_t samples_;
  Eigen::FFT<double> fft_;
};

// Phi-, the factor of Phi whose logarithm belongs to times before the breaking.
Spectrum factor_before(const HalfStrip &half, Record &record)
{
  const std::size_t n = record.samples();
  Spectrum logarithm(n / 2 + 1);
  double argument = 0.;
  for (std::size_t i = 0; i <= n / 2; ++i)
  {
    const double omega = std::abs(record.omega(i));
    const Complex phi = half.phi(omega);
    argument += std::remainder(std::arg(phi) - argument, two_pi);
    logarithm[i] = {std::log(std::abs(phi)), argument};
  }
  std::vector<double> before = record.in_time(logarithm);
  before[0] *= 0.5;
  before[n / 2] *= 0.5;
  std::fill(before.begin() + 1, before.begin() + static_cast<std::ptrdiff_t>(n / 2), 0.);
  Spectrum factor = record.transform(before);
  for (Complex &z : factor)
    z = std::exp(z);
  return factor;
}

double largest(const std::vector<double> &values, double base)
{
  support::Extremes extremes;
  for (const double value : values)
    extremes.add(base + value);
  return extremes.largest();
}

} // namespace

SteadyFields steady_fields(const CrackStrip &strip, double speed, double duration, std::size_t samples)
{
  const HalfStrip half(strip, speed);
  Record record(duration, samples);
  SteadyFields fields{};
  fields.driving = steady_driving(strip, speed);
  // Elongation far ahead, in units of the breaking one.
  const double ahead = fields.driving / std::sqrt(static_cast<double>(strip.layers()));

  // Rate of the force across the crack (S.7), and the rates of all elongations that it causes.
  const Spectrum factor = factor_before(half, record);
  const std::size_t n_frequencies = samples / 2 + 1;
  std::vector<std::vector<HalfStrip::Layer>> rates(n_frequencies);
  for (std::size_t i = 0; i < n_frequencies; ++i)
  {
    const Complex force = -ahead * factor[0] / factor[i];
    rates[i] = half.elongations(std::abs(record.omega(i)), strip.free_rows + 1);
    for (HalfStrip::Layer &layer : rates[i])
      layer = {layer.right * force, layer.left * force, layer.along * force};
  }
  const auto spectrum = [&](std::size_t layer, Complex HalfStrip::Layer::*bond)
  {
    Spectrum rate(n_frequencies);
    for (std::size_t i = 0; i < n_frequencies; ++i)
      rate[i] = rates[i][layer].*bond;
    return rate;
  };

  support::Extremes elsewhere, before;
  const auto visit_whole_bond = [&](std::size_t layer, Complex HalfStrip::Layer::*bond, double base)
  {
    const Spectrum rate = spectrum(layer, bond);
    elsewhere.add(largest(record.integral(rate), base));
    double power = 0.5 * std::norm(rate[0]); // Parseval over omega >= 0
    for (std::size_t i = 1; i < n_frequencies; ++i)
      power += std::norm(rate[i]);
    fields.dissipation += strip.viscosity * power * 2. / duration;
  };
  for (std::size_t layer = 0; layer <= strip.free_rows; ++layer)
  {
    if (layer < strip.free_rows)
      visit_whole_bond(layer, &HalfStrip::Layer::along, 0.);
    if (layer > 0)
    {
      visit_whole_bond(layer, &HalfStrip::Layer::right, ahead);
      visit_whole_bond(layer, &HalfStrip::Layer::left, ahead);
    }
  }

  // The bond across the crack works until it breaks.
  const Spectrum rate = spectrum(0, &HalfStrip::Layer::right);
  const std::vector<double> across = record.integral(rate), across_rate = record.in_time(rate);
  const double interval = 0.5 / speed;
  double power = 0.5 * across_rate[0] * across_rate[0];
  for (std::size_t i = samples / 2; i < samples + samples / 2; ++i)
  {
    const std::size_t j = i % samples;
    fields.time.push_back(record.time(j));
    fields.elongation.push_back(ahead + across[j]);
    if (record.time(j) < -0.1 * interval)
      before.add(fields.elongation.back());
    if (record.time(j) < 0.)
      power += across_rate[j] * across_rate[j];
  }
  fields.largest_elsewhere = elsewhere.largest();
  fields.largest_before = before.largest();
  fields.dissipation += strip.viscosity * power * record.step();
  fields.dissipation *= 2.; // over k e_c^2 / 2
  return fields;
}

} // namespace latcon::claims
