// Speed, wavelength and amplitude of synthetic crack paths with known answers.
//
// Tolerances. For a sinusoid of n periods, amplitude a, in N entries with independent noise sigma, least squares gives
//   sd(wavelength) = wavelength (sqrt6 / pi) (sigma / a) / (n sqrt N),   sd(amplitude) = sigma sqrt(2 / N)
// (Cramer-Rao bound). Rounding to the nearest site of a column, where every second row has one, adds sigma = d / 2.
// Ensembles have 200 seeds: a fraction p has a standard deviation of sqrt(p (1 - p) / 200), 0.033 at p = 0.68 and 0.015
// at p = 0.95.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/verification/analysis/synthetic_crack.h"

namespace crack_measurement_test
{

using namespace latcon;
using namespace synthetic_crack;

constexpr unsigned int n_seeds = 200;

/// Counts of the patterns found in an ensemble of cracks, and of measurements within one and two uncertainties.
struct Ensemble
{
  unsigned int n_likely_oscillating = 0, n_oscillating = 0, n_straight = 0, n_decided = 0;
  unsigned int wavelength_within_1 = 0, wavelength_within_2 = 0, amplitude_within_1 = 0, amplitude_within_2 = 0;
  unsigned int speed_within_1 = 0, speed_within_2 = 0;

  static void count(const analysis::Measured &measured, double truth, unsigned int &within_1, unsigned int &within_2)
  {
    const double deviation = std::abs(measured.value - truth) / measured.uncertainty;
    within_1 += deviation < 1.;
    within_2 += deviation < 2.;
  }

  explicit Ensemble(const SyntheticCrack &crack, double true_wavelength = wavelength, double true_amplitude = amplitude)
  {
    for (unsigned int seed = 1; seed <= n_seeds; ++seed)
    {
      const CrackMeasurement m = measure(crack, seed);
      n_likely_oscillating += m.wavelength.has_value();
      n_oscillating += m.pattern == CrackPattern::oscillating;
      n_straight += m.pattern == CrackPattern::straight;
      n_decided += m.pattern != CrackPattern::undecided;
      // Coverage is of the fit for any pattern, because excluding unclear cases would be biased.
      count(m.sinusoid.value().wavelength, true_wavelength, wavelength_within_1, wavelength_within_2);
      count(m.sinusoid.value().amplitude, true_amplitude, amplitude_within_1, amplitude_within_2);
      count(m.speed_lagrangian.value(), speed, speed_within_1, speed_within_2);
    }
  }
};

/// 1 sigma must cover 68 %: from three standard deviations below up to the coverage of an uncertainty that is 1.6 times
/// too large. 2 sigma must cover 95 %: at least 85 %, to allow for the error of the uncertainty.
#define EXPECT_COVERS(within_1, within_2)                                                                              \
  do                                                                                                                   \
  {                                                                                                                    \
    EXPECT_GE(within_1, 0.58 * n_seeds);                                                                               \
    EXPECT_LE(within_1, 0.90 * n_seeds);                                                                               \
    EXPECT_GE(within_2, 0.85 * n_seeds);                                                                               \
  } while (false)

// On a path that drifts by 4.5 mm along the window, three amplitudes. The short wave, averaged over columns of 2 d,
// would have an amplitude that is (pi 2 d / wavelength)^2 / 6 = 6 % too small if the model were not averaged as well.
TEST(CrackMeasurement, PureSinusoidIsExact)
{
  for (const auto &[lambda, error] : {std::pair(wavelength, 1e-6 * amplitude), {10.3 * d, 1e-5 * amplitude}})
  {
    SyntheticCrack crack;
    crack.path = [&, lambda = lambda](double X) { return 0.045 * X - 0.002 + sinusoid(lambda, amplitude)(X); };
    crack.on_sites = false;
    const CrackMeasurement m = measure(crack);
    ASSERT_EQ(m.pattern, CrackPattern::oscillating) << m.reason;
    // The wave number is found to a relative 1e-7; the amplitude is stationary there.
    EXPECT_NEAR(m.wavelength->value, lambda, std::min(1e-6 * wavelength, 1e-6 * d));
    EXPECT_NEAR(m.amplitude->value, amplitude, error);
    EXPECT_NEAR(m.sinusoid->R_squared, 1., 1e-6);
    EXPECT_NEAR(m.sinusoid->share_of_path, 1., 1e-6);
    // Entries are on columns at distances of d / 2, with up to three columns skipped at the ends.
    EXPECT_NEAR(m.X_begin, 0.2 * length, 3. * d);
    EXPECT_NEAR(m.X_end, 0.9 * length, 3. * d);
    EXPECT_NEAR(m.periods, 0.7 * length / lambda, 6. * d / lambda);
    EXPECT_NEAR(m.sinusoid->curve.slope, 0.045, 1e-7);
    EXPECT_NEAR(m.sinusoid->curve(0.05), crack.path(0.05), 1e-5 * amplitude);
    EXPECT_NEAR(m.sinusoid->curve.about(0.)(0.05), m.sinusoid->curve(0.05), 1e-13 * length);
  }
}

TEST(CrackMeasurement, CrestsOfASinusoidAreItsAmplitude)
{
  SyntheticCrack crack;
  crack.path = sinusoid(wavelength, amplitude);
  for (unsigned int seed = 1; seed <= 20; ++seed)
  {
    const CrackMeasurement m = measure(crack, seed);
    ASSERT_TRUE(m.crest_amplitude) << m.reason;
    // Highest of the 18 columns of a wavelength, each with an error of d / 2 divided by the root of its two or three
    // entries: at most two standard deviations too high.
    EXPECT_NEAR(m.crest_amplitude->value, amplitude, 2. * 0.5 * d / std::sqrt(2.));
    EXPECT_GT(m.crest_amplitude->uncertainty, 0.09 * d);
    EXPECT_GT(m.amplitude->uncertainty, 0.09 * d);
  }
  crack.path = straight;
  EXPECT_FALSE(measure(crack).crest_amplitude);
}

struct Noise
{
  double hops, wander, memory; // [m], memory 0: that of SyntheticCrack
  double found;                // least share of seeds
};

using NoisyOscillation = testing::TestWithParam<Noise>;

TEST_P(NoisyOscillation, IsCoveredByItsUncertainties)
{
  SyntheticCrack crack;
  crack.path = sinusoid(wavelength, amplitude);
  crack.hops = GetParam().hops;
  crack.wander = GetParam().wander;
  if (GetParam().memory > 0.)
    crack.memory = GetParam().memory;
  const Ensemble ensemble(crack);
  EXPECT_GE(ensemble.n_likely_oscillating, GetParam().found * n_seeds);
  EXPECT_COVERS(ensemble.wavelength_within_1, ensemble.wavelength_within_2);
  EXPECT_COVERS(ensemble.amplitude_within_1, ensemble.amplitude_within_2);
}

// Independent noise, also hops that exceed the amplitude of 2.7 d: errors of the record, not part of the path;
// correlated noise, of which 1 sigma would cover about 40 % if it were taken for independent; noise of a long memory.
INSTANTIATE_TEST_SUITE_P(Kinds, NoisyOscillation,
                         testing::Values(Noise{d, 0., 0., 1.}, Noise{3. * d, 0., 0., 0.85}, Noise{d, d, 0., 0.95},
                                         Noise{0.5 * d, d, 12. * d, 0.95}));

TEST(CrackMeasurement, GrowingPartIsLeftOut)
{
  // Amplitude a / (1 + exp(-(X - X0) / l)), X0 = 55 mm, l = 6 mm: 27 % at 49 mm, 92 % at 70 mm.
  SyntheticCrack crack;
  crack.path = [](double X) { return sinusoid(wavelength, amplitude)(X) / (1. + std::exp(-(X - 0.055) / 0.006)); };
  crack.hops = 0.5 * d;
  double sum = 0., sum_of_whole = 0.;
  const unsigned int n = 40;
  for (unsigned int seed = 1; seed <= n; ++seed)
  {
    const std::vector<TipRecord> tip = crack.record(seed);
    CrackMeasurementOptions options = options_for(tip);
    const CrackMeasurement m = measure_crack(tip, {}, options);
    ASSERT_EQ(m.pattern, CrackPattern::oscillating) << m.reason;
    EXPECT_GT(m.X_begin, 0.049);
    EXPECT_LT(m.X_begin, 0.070);
    EXPECT_GE(m.periods, 2.);
    // Six standard deviations of the formula above with n = 3.3 periods, N = 150, sigma = 0.7 d, because a part of the
    // growth remains.
    EXPECT_NEAR(m.wavelength->value, wavelength, 6. * 0.14e-3);
    sum += m.amplitude->value / n;
    options.steady_amplitude = 0.01;
    sum_of_whole += measure_crack(tip, {}, options).sinusoid->amplitude.value / n;
  }
  // The remaining growth, from 27 to 100 % over a fifth of the window, reduces the mean by a few per cent. With the
  // growing part, 25 mm of 105 mm would have almost no amplitude, which would reduce it by more than a tenth.
  EXPECT_NEAR(sum, amplitude, 0.06 * amplitude);
  EXPECT_LT(sum_of_whole, 0.88 * amplitude);
}

TEST(CrackMeasurement, LateOnsetKeepsTwoWavelengths)
{
  // 55 to 65 mm, 1.6 to 1.9 wavelengths, are steady. The window must not be reduced to this part.
  const double lambda = 0.035;
  SyntheticCrack crack;
  crack.hops = 0.3 * d;
  for (const double onset : {0.07, 0.075, 0.08})
  {
    crack.path = [=](double X) { return X < onset ? 0. : amplitude * std::sin(2. * pi * (X - onset) / lambda); };
    const CrackMeasurement m = measure(crack);
    ASSERT_TRUE(m.sinusoid);
    EXPECT_GT(m.X_begin, 0.05) << m.reason; // the beginning did move
    EXPECT_GE(m.periods, 2.) << m.reason;
  }
}

TEST(CrackMeasurement, FewerThanTwoPeriodsAreFoundButNotConclusive)
{
  // 1.8 periods in the window of 105 mm.
  const double lambda = 0.7 * length / 1.8;
  SyntheticCrack crack;
  crack.path = sinusoid(lambda, amplitude);
  crack.hops = 0.3 * d;
  crack.wander = 0.2 * d;
  const Ensemble ensemble(crack, lambda);
  EXPECT_GE(ensemble.n_likely_oscillating, 0.9 * n_seeds);
  EXPECT_EQ(ensemble.n_oscillating, 0u);
  EXPECT_COVERS(ensemble.wavelength_within_1, ensemble.wavelength_within_2);
}

// Straight paths with noise: largest shares of the seeds that are found likely to oscillate and oscillating, and
// smallest and largest shares that are decided.
TEST(CrackMeasurement, NoiseDoesNotOscillate)
{
  const struct
  {
    double hops, wander, memory, walk;
    double likely, oscillating, least_decided, most_decided;
  } cases[] = {
    // Odds of 20 to 1 occur by chance in less than 1 of 20 straight paths, and in practice much less often: 1 %.
    {0.5 * d, 0., 5. * d, 0., 0.01, 0.01, 0.98, 1.},
    {2. * d, 0., 5. * d, 0., 0.01, 0.01, 0.98, 1.},
    // Correlated over 5 d and 20 d, as strong as an oscillation of amplitude 2.8 d. Sinusoids fit much of the slower
    // noise, so not every path is found straight; but none may be found oscillating.
    {0.5 * d, 2. * d, 5. * d, 0., 0.02, 0., 0., 1.},
    {0.5 * d, 2. * d, 20. * d, 0., 0.02, 0., 0., 1.},
    // Random walk of 0.5 d sqrt(168) = 6.5 d along the window. The best sinusoid explains more than half of the
    // variance
    // of most such paths, over one to two periods. The evidence shows that a wandering path explains as much, so the
    // result is undecided: neither straight nor oscillating.
    {0., 0., 5. * d, 0.5 * d, 0.03, 0.01, 0., 0.6}};
  for (const auto &[hops, wander, memory, walk, likely, oscillating, least_decided, most_decided] : cases)
  {
    SyntheticCrack crack;
    crack.hops = hops;
    crack.wander = wander;
    crack.memory = memory;
    crack.walk = walk;
    const Ensemble ensemble(crack);
    EXPECT_LE(ensemble.n_likely_oscillating, likely * n_seeds);
    EXPECT_LE(ensemble.n_oscillating, oscillating * n_seeds);
    EXPECT_GE(ensemble.n_decided, least_decided * n_seeds);
    EXPECT_LE(ensemble.n_decided, most_decided * n_seeds);
  }
}

TEST(CrackMeasurement, RippleOnAWanderingPathIsNotItsPattern)
{
  // A clear sinusoid of 10 mm wavelength and 1 mm amplitude on a path that additionally wanders by 3 d.
  SyntheticCrack crack;
  crack.path = sinusoid(0.01, 0.001);
  crack.wander = 3. * d;
  crack.memory = 40. * d;
  unsigned int n_ripples = 0;
  for (unsigned int seed = 1; seed <= 100; ++seed)
  {
    const CrackMeasurement m = measure(crack, seed);
    if (m.sinusoid.value().log_evidence < 3. || m.sinusoid->share_of_path >= 0.5)
      continue;
    EXPECT_NE(m.pattern, CrackPattern::oscillating) << m.reason;
    EXPECT_FALSE(m.wavelength);
    ++n_ripples;
  }
  EXPECT_GE(n_ripples, 10u) << "nothing was tested";
}

TEST(CrackMeasurement, SteadySpeed)
{
  // Constant speed, tip on columns at distances up to 3 d: the error of the straight line is less than that in 105 mm.
  const CrackMeasurement m = measure(SyntheticCrack());
  ASSERT_TRUE(m.speed_lagrangian && m.speed_laboratory);
  EXPECT_NEAR(m.speed_lagrangian->value, speed, 3. * d / (0.7 * length) * speed);
  EXPECT_GT(m.speed_lagrangian->uncertainty, 0.);
  EXPECT_LT(m.speed_lagrangian->uncertainty, 0.02 * speed);
  // x is an affine function of X here: exact up to round-off, the uncertainty up to its resolution of 1e-3 d.
  EXPECT_NEAR(m.speed_laboratory->value, stretch_x * m.speed_lagrangian->value, 1e-9 * speed);
  EXPECT_NEAR(m.speed_laboratory->uncertainty, stretch_x * m.speed_lagrangian->uncertainty, 1e-3 * speed);
  // A tip that lags behind its reference position at 3 m/s.
  std::vector<TipRecord> tip = SyntheticCrack().record(1);
  for (TipRecord &entry : tip)
    entry.x -= 3. * entry.t;
  EXPECT_NEAR(measure_crack(tip, {}, options_for(tip)).speed_laboratory->value, stretch_x * speed - 3.,
              3. * d / (0.7 * length) * stretch_x * speed);
}

TEST(CrackMeasurement, SpeedUncertaintyCoversTheTruth)
{
  // Slowness that varies by 30 %, correlated over 8 d, so that the position wanders away from the straight line.
  SyntheticCrack crack;
  crack.path = sinusoid(wavelength, amplitude);
  crack.slowness_noise = 0.3;
  const Ensemble ensemble(crack);
  EXPECT_COVERS(ensemble.speed_within_1, ensemble.speed_within_2);
}

} // namespace crack_measurement_test
