#include "verification/study/study_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace latcon::study
{
namespace
{

// Unit and scale for display.
struct Display
{
  double scale;
  std::string unit;
};

Display display(const std::string &unit)
{
  if (unit == "m")
    return {1e2, " cm"};
  if (unit == "m^2")
    return {1e6, " mm²"};
  if (unit == "s")
    return {1e3, " ms"};
  if (unit == "degrees")
    return {1., "°"};
  return {1., unit == "1" ? "" : " " + unit};
}

std::string format_number(const char *format, int digits, double value)
{
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

void add_mean(SeedStatistics &seeds, const std::vector<double> &values, const std::vector<double> &uncertainties)
{
  const auto n = static_cast<double>(values.size());
  double sum = 0.;
  for (const double value : values)
    sum += value;
  seeds.mean = sum / n;
  if (values.size() > 1)
  {
    double squares = 0.;
    for (const double value : values)
      squares += (value - *seeds.mean) * (value - *seeds.mean);
    seeds.deviation = std::sqrt(squares / (n - 1.));
  }
  if (uncertainties.empty())
    return;
  double squares = 0.;
  for (const double uncertainty : uncertainties)
    squares += uncertainty * uncertainty;
  seeds.uncertainty = std::sqrt(squares / static_cast<double>(uncertainties.size()));
}

} // namespace

SeedStatistics statistics(const std::string &run, const std::string &quantity, const std::vector<RunOutcome> &outcomes)
{
  SeedStatistics seeds;
  seeds.run = run;
  std::vector<double> values;
  std::vector<double> uncertainties;
  for (const RunOutcome &outcome : outcomes)
  {
    if (outcome.run != run)
      continue;
    ++seeds.n_seeds;
    const std::string seed = "seed " + std::to_string(outcome.seed) + " ";
    if (outcome.state != RunState::measured)
    {
      ++seeds.n_lost;
      seeds.missing.push_back(seed + to_string(outcome.state));
      continue;
    }
    if (quantity == pattern_quantity)
    {
      if (outcome.pattern == undecided_pattern)
      {
        ++seeds.n_undecided;
        seeds.missing.push_back(seed + outcome.pattern);
        continue;
      }
      ++seeds.patterns[outcome.pattern];
      ++seeds.n;
      continue;
    }
    const auto value = outcome.values.find(quantity);
    if (value == outcome.values.end())
    {
      seeds.missing.push_back(seed + outcome.pattern); // a crack with this pattern does not have this quantity
      continue;
    }
    ++seeds.n;
    values.push_back(value->second);
    if (const auto found = outcome.values.find(quantity + "_uncertainty"); found != outcome.values.end())
      uncertainties.push_back(found->second);
  }
  if (!values.empty())
    add_mean(seeds, values, uncertainties);
  return seeds;
}

SampleMean SeedStatistics::sample() const
{
  return {mean.value(), n, std::pow(deviation.value_or(0.), 2), std::pow(uncertainty.value_or(0.), 2)};
}

bool SeedStatistics::shows(const std::string &pattern) const
{
  return is_measured() && patterns.size() == 1 && patterns.count(pattern) == 1;
}

std::string SeedStatistics::text(const std::string &unit) const
{
  if (mean)
    return quantity_text(*mean, deviation, unit) + " (" + std::to_string(n) +
           (n < n_seeds ? " of " + std::to_string(n_seeds) : "") + ")";
  std::string words;
  const auto add = [&](const std::string &pattern, std::size_t count)
  { words += (words.empty() ? "" : ", ") + pattern + " " + std::to_string(count) + "/" + std::to_string(n_seeds); };
  for (const auto &[pattern, count] : patterns)
    add(pattern, count);
  if (n_undecided > 0)
    add(undecided_pattern, n_undecided);
  return words.empty() ? "not measured" : words;
}

std::string quantity_text(const double value, const std::optional<double> deviation, const std::string &unit)
{
  const Display shown = display(unit);
  // Equal values have a deviation of round-off.
  if (!deviation || !(*deviation > 1e-12 * std::abs(value)))
    return format_number("%.*g", 4, shown.scale * value) + shown.unit;
  // Two digits of the deviation, and the value to the same decimal place.
  const double spread = shown.scale * *deviation;
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(spread))), 0, 12);
  if (digits > 6 && std::abs(shown.scale * value) < 1e-3)
    return format_number("%.*e", 1, shown.scale * value) + " ± " + format_number("%.*e", 1, spread) + shown.unit;
  return format_number("%.*f", digits, shown.scale * value) + " ± " + format_number("%.*f", digits, spread) +
         shown.unit;
}

} // namespace latcon::study
