#include "verification/study/statistical_tests.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace latcon::study
{
namespace
{

// Consecutive means that the isotonic fit pools.
struct Block
{
  double mean, weight;
  std::size_t n;
};

// Computes the isotonic fit by pooling adjacent violators.
std::vector<Block> pool_blocks(const std::vector<double> &means, const std::vector<double> &weights)
{
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < means.size(); ++i)
  {
    Block last{means[i], weights[i], 1};
    while (!blocks.empty() && blocks.back().mean >= last.mean)
    {
      const Block &before = blocks.back();
      const double weight = before.weight + last.weight;
      last = {(before.weight * before.mean + last.weight * last.mean) / weight, weight, before.n + last.n};
      blocks.pop_back();
    }
    blocks.push_back(last);
  }
  return blocks;
}

std::vector<double> weights_of(const std::vector<SampleMean> &samples)
{
  std::vector<double> weights;
  for (const SampleMean &sample : samples)
    weights.push_back(static_cast<double>(sample.n));
  return weights;
}

// Returns P(F >= statistic / freedom); 1 if the statistic is 0.
double exceedance(double statistic, std::size_t freedom, double freedom_of_error)
{
  const auto n = static_cast<double>(freedom);
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(n, freedom_of_error), statistic / n));
}

} // namespace

std::optional<double> welch_p_value(const SampleMean &smaller, const SampleMean &larger)
{
  if (smaller.n < 2 || larger.n < 2)
    return {};
  struct Share
  {
    double spread, error; // squared standard error, from the sample variance and from the floored variance
    double freedom;
  };
  const auto share = [](const SampleMean &sample)
  {
    const auto n = static_cast<double>(sample.n);
    return Share{sample.variance / n, sample.floored_variance() / n, n - 1.};
  };
  const Share a = share(smaller), b = share(larger);
  if (!(a.spread + b.spread > 0.))
    return {};
  // From the sample variances, so that the floor does not add degrees of freedom.
  const double freedom =
    std::floor(std::pow(a.spread + b.spread, 2) / (a.spread * a.spread / a.freedom + b.spread * b.spread / b.freedom) +
               1e-9); // compensates round-off below an integer
  const double t = (larger.mean - smaller.mean) / std::sqrt(a.error + b.error);
  if (!std::isfinite(t) || !std::isfinite(freedom))
    return {};
  return boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), t));
}

std::vector<double> adjust_by_holm(const std::vector<double> &p_values)
{
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (!std::isnan(p_values[i]))
      order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted = p_values;
  // A comparison without a p-value counts as well.
  double last = 0.;
  for (std::size_t rank = 0; rank < order.size(); ++rank)
  {
    const double p = static_cast<double>(p_values.size() - rank) * p_values[order[rank]];
    last = p > last ? p : last;
    adjusted[order[rank]] = last < 1. ? last : 1.;
  }
  return adjusted;
}

std::vector<double> level_probabilities(const std::vector<double> &weights)
{
  constexpr std::size_t n_draws = 20000;
  std::mt19937_64 generator(19590601);
  const boost::math::normal normal;
  std::vector<double> probabilities(weights.size(), 0.), z(weights.size());
  for (std::size_t draw = 0; draw < n_draws; ++draw)
  {
    for (std::size_t i = 0; i < z.size(); ++i)
    {
      // In (0, 1), and identical on every machine, unlike the distributions of the standard library.
      const double uniform = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
      z[i] = boost::math::quantile(normal, uniform) / std::sqrt(weights[i]);
    }
    probabilities[pool_blocks(z, weights).size() - 1] += 1. / n_draws;
  }
  return probabilities;
}

std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples, const std::vector<double> &levels)
{
  const std::size_t k = samples.size();
  const std::vector<double> weights = weights_of(samples);
  std::vector<double> means;
  double total = 0., weighted_mean = 0., freedom = 0., squares = 0., least = 0.;
  for (const SampleMean &sample : samples)
  {
    const auto n = static_cast<double>(sample.n);
    means.push_back(sample.mean);
    total += n;
    weighted_mean += n * sample.mean;
    least += n * sample.min_variance;
    if (sample.n < 2)
      continue;
    freedom += n - 1.;
    squares += (n - 1.) * sample.variance;
  }
  weighted_mean /= total;
  if (k < 2 || !(squares > 0.))
    return {};
  const double variance = SampleMean{0., 1, squares / freedom, least / total}.floored_variance();

  const std::vector<Block> fit = pool_blocks(means, weights);
  double explained = 0., left = 0.;
  std::size_t i = 0;
  for (const Block &block : fit)
  {
    explained += block.weight * std::pow(block.mean - weighted_mean, 2) / variance;
    for (const std::size_t end = i + block.n; i < end; ++i)
      left += weights[i] * std::pow(means[i] - block.mean, 2) / variance;
  }
  if (!std::isfinite(explained) || !std::isfinite(left))
    return {};
  TrendTest test{0., 0.};
  for (std::size_t l = 1; l <= k; ++l)
  {
    test.p_rise += levels[l - 1] * (l > 1 ? exceedance(explained, l - 1, freedom) : 0.);
    test.p_fall += levels[l - 1] * (l < k ? exceedance(left, k - l, freedom) : 0.);
  }
  // If the fit explains nothing, or everything, every sequence is at least as extreme.
  if (fit.size() == 1)
    test.p_rise = 1.;
  if (fit.size() == k)
    test.p_fall = 1.;
  return test;
}

std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples)
{
  return isotonic_test(samples, level_probabilities(weights_of(samples)));
}

} // namespace latcon::study
