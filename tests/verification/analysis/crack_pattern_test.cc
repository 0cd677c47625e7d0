// Branching and arrest of synthetic cracks, and invalid records and options.

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/verification/analysis/synthetic_crack.h"

namespace crack_pattern_test
{

using namespace latcon;

using namespace synthetic_crack;

// A crack that splits at X = 50 mm into two branches at +-30 degrees, which are alternately slightly ahead.
TEST(CrackMeasurement, TwoDivergingStrandsBranch)
{
  const double X_branch = 0.05;
  const auto branch = [=](double X) { return std::max(0., std::tan(pi / 6.) * (X - X_branch)); };
  SyntheticCrack crack;
  crack.path = [=](double X)
  {
    const auto turn = static_cast<unsigned int>(X / (5. * d));
    return (std::mt19937(turn)() >> 16) % 2 == 0 ? branch(X) : -branch(X);
  };
  const std::vector<TipRecord> tip = crack.record(1);
  std::vector<BreakRecord> breaks;
  break_along(breaks, branch, seed_tip, crack.X_last);
  break_along(
    breaks, [=](double X) { return -branch(X); }, X_branch, crack.X_last);
  const CrackMeasurement m = measure_crack(tip, breaks, options_for(tip));
  EXPECT_EQ(m.pattern, CrackPattern::branching) << m.reason;
  EXPECT_FALSE(m.wavelength);
  // From where the distance of the strands is 10 d (plus 2 d of width), 12 d / (2 tan 30) after the fork, to 0.9 L, to
  // within a column of 4 d at each end.
  const double expected = (0.9 * length - X_branch - 12. * d / (2. * std::tan(pi / 6.))) / (0.9 * length - seed_tip);
  EXPECT_NEAR(m.branched_fraction, expected, 8. * d / (0.9 * length - seed_tip));
  const CrackMeasurement without_breaks = measure_crack(tip, {}, options_for(tip));
  EXPECT_EQ(without_breaks.pattern, CrackPattern::undecided) << without_breaks.reason;
  EXPECT_EQ(without_breaks.branched_fraction, 0.);
}

class CrackMeasurementDamage : public testing::Test
{
protected:
  CrackMeasurementDamage()
  {
    crack.path = sinusoid(wavelength, amplitude);
    crack.hops = 0.5 * d;
    break_along(breaks, crack.path, seed_tip, 0.98 * length);
  }

  SyntheticCrack crack;
  std::vector<BreakRecord> breaks;
};

// Damage on the path and beside it that is no branch of it.
TEST_F(CrackMeasurementDamage, BesideThePathIsNoBranch)
{
  const auto &path = crack.path;
  const std::vector<BreakRecord> on_path = breaks;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> offset(-60. * d, 60. * d);
  const std::pair<const char *, std::function<void()>> cases[] = {
    {"none", [] {}},
    {"a band in the wake", [&] { break_along(breaks, path, seed_tip, 0.98 * length, 6. * d); }},
    // At a distance of 14 d over the whole length, with a width of 1 d on both sides: the gap is never more than 12 d.
    {"a row",
     [&]
     {
       break_along(
         breaks, [&](double X) { return path(X) + 14. * d; }, seed_tip, 0.98 * length);
     }},
    // With a gap that varies between 4 d and 16 d every 37 d: above 10 d for less than 20 d at a time.
    {"straggling damage",
     [&]
     {
       break_along(
         breaks, [&](double X) { return path(X) + (12. + 6. * std::sin(2. * pi * X / wavelength)) * d; }, seed_tip,
         0.98 * length);
     }},
    // Secondary cracks of 14 d that branch off every second crest at 60 degrees and stop.
    {"a spur at every crest",
     [&]
     {
       for (double X = 0.03; X < 0.13; X += wavelength)
         break_along(
           breaks, [&](double s) { return path(X) + std::tan(pi / 3.) * (s - X); }, X, X + 14. * d);
     }},
    // One broken bond per 2 d of length, at random up to 60 d from the path.
    {"debris", [&]
     {
       for (double X = seed_tip; X < 0.98 * length; X += 2. * d)
         breaks.push_back({1e-3, X, path(X) + offset(generator)});
     }}};
  for (const auto &[name, damage] : cases)
  {
    breaks = on_path;
    damage();
    const CrackMeasurement m = measure(crack, 1, breaks);
    EXPECT_EQ(m.pattern, CrackPattern::oscillating) << name << ": " << m.reason;
    EXPECT_LT(m.branched_fraction, 0.1) << name;
  }
}

// Bonds along an inclined path, and several broken bonds in its flanks at known distances.
TEST(FlankDamage, IsMeasuredFromTheNearestPointOfThePath)
{
  std::vector<TipRecord> tip;
  const double slope = 0.75; // a 3-4-5 triangle: the distance is 0.8 times that along Y
  for (int i = 0; i <= 100; ++i)
    tip.push_back({1e-5 * i, i * d, slope * i * d, 0., 0.});
  std::vector<BreakRecord> breaks;
  for (int i = 0; i < 96; ++i)
    breaks.push_back({0., (2. + i) * d, slope * (2. + i) * d + (i % 2 == 0 ? 0.5 : -0.5) * d});
  const auto whole = flank_damage(tip, breaks, 0., 100. * d, d);
  ASSERT_TRUE(whole);
  EXPECT_NEAR(whole->depth, 0.8 * 0.5 * d, 1e-12 * d);
  EXPECT_EQ(whole->share, 0.);
  for (const double offset : {7.45, 7.55, -12.}) // 5.96, 6.04 and 9.6 d away
    breaks.push_back({0., 50.2 * d, (slope * 50.2 + offset) * d});
  breaks.push_back({0., 20. * d, 15. * d + 20. * d});
  const auto torn = flank_damage(tip, breaks, 22. * d, 90. * d, d); // without the last bond, and 27 bonds of the path
  ASSERT_TRUE(torn);
  EXPECT_NEAR(torn->depth, 9.6 * d, 1e-12 * d);
  EXPECT_DOUBLE_EQ(torn->share, 2. / (96 - 27 + 3));
  EXPECT_NEAR(flank_damage(tip, breaks, 0., 100. * d, d)->depth, 16. * d, 1e-12 * d);
  // Beyond the ends of the path the nearest point is its last point.
  EXPECT_NEAR(flank_damage(tip, {{0., 103. * d, 79. * d}}, 0., 200. * d, d)->depth, 5. * d, 1e-12 * d);
  EXPECT_NEAR(flank_damage(tip, {{0., -3. * d, -4. * d}}, -10. * d, 0., d)->depth, 5. * d, 1e-12 * d);
  EXPECT_FALSE(flank_damage(tip, breaks, 100. * d, 120. * d, d));
  EXPECT_FALSE(flank_damage({}, breaks, 0., 100. * d, d));
}

TEST_F(CrackMeasurementDamage, OfTheFlanksIsThatInTheWindow)
{
  const auto beside = [&](double X, double offset) { return BreakRecord{1e-3, X, crack.path(X) + offset}; };
  breaks.push_back(beside(0.1 * length, 30. * d));  // before the window
  breaks.push_back(beside(0.95 * length, 30. * d)); // after the window
  CrackMeasurement m = measure(crack, 1, breaks);
  ASSERT_TRUE(m.flanks);
  // Bonds at d on both sides of a path that is known at the sites of its tip, with errors of about d / 2.
  EXPECT_NEAR(m.flanks->depth, d, 0.75 * d);
  EXPECT_EQ(m.flanks->share, 0.);
  breaks.push_back(beside(0.6 * length, 12. * d));
  m = measure(crack, 1, breaks);
  EXPECT_GT(m.flanks->depth, 9. * d); // less than along Y: the slope of the path is up to 25 degrees
  EXPECT_LT(m.flanks->depth, 12.75 * d);
  EXPECT_GT(m.flanks->share, 0.);
}

// A tip that stands for a tenth of the strip over its speed, or never ran, is arrested; at the clamp it is not.
TEST(CrackMeasurement, CrackThatStopsIsArrested)
{
  const auto pattern = [](double X_last, double times_the_run, double more = 0.)
  {
    SyntheticCrack crack;
    crack.X_last = X_last;
    const std::vector<TipRecord> tip = crack.record(1);
    CrackMeasurementOptions options = options_for(tip);
    options.end_time = times_the_run * tip.back().t + more;
    const CrackMeasurement m = measure_crack(tip, {}, options);
    if (X_last > 0.25 * length) // of the time before arrest
    {
      EXPECT_NEAR(m.speed_lagrangian.value().value, speed, 6. * d / (0.25 * length) * speed);
    }
    return m.pattern;
  };
  EXPECT_EQ(pattern(0.45 * length, 2.), CrackPattern::arrested);
  EXPECT_EQ(pattern(seed_tip + 4. * d, 3.), CrackPattern::arrested);
  EXPECT_EQ(pattern(0.91 * length, 5.), CrackPattern::straight);
  EXPECT_EQ(pattern(0.6 * length, 1., 0.05 * length / speed), CrackPattern::straight); // a pause
  EXPECT_EQ(pattern(0.6 * length, 1., 0.15 * length / speed), CrackPattern::arrested);

  const CrackMeasurement of_none = measure_crack({}, {}, options_for({}));
  EXPECT_EQ(of_none.pattern, CrackPattern::arrested);
  EXPECT_FALSE(of_none.speed_lagrangian || of_none.speed_laboratory || of_none.wavelength || of_none.sinusoid);
  CrackMeasurementOptions at_once = options_for({});
  at_once.end_time = 0.;
  const CrackMeasurement before = measure_crack({}, {}, at_once);
  EXPECT_EQ(before.pattern, CrackPattern::undecided);
  EXPECT_NE(before.reason.find("before its first step"), std::string::npos) << before.reason;

  // A bond that breaks long after the stop changes nothing.
  SyntheticCrack crack;
  crack.X_last = 0.5 * length;
  std::vector<TipRecord> tip = crack.record(1);
  tip.push_back(tip.back());
  tip.back().t *= 3.;
  tip.back().X += 0.5 * d;
  EXPECT_EQ(measure_crack(tip, {}, options_for(tip)).pattern, CrackPattern::arrested);
}

TEST(CrackMeasurement, SentenceNamesTheCriterionThatDecided)
{
  const auto expect = [](const CrackMeasurement &m, CrackPattern pattern, std::initializer_list<const char *> parts)
  {
    EXPECT_EQ(m.pattern, pattern) << m.reason;
    EXPECT_EQ(m.wavelength.has_value(), pattern == CrackPattern::oscillating);
    for (const char *part : parts)
      EXPECT_NE(m.reason.find(part), std::string::npos) << m.reason;
  };
  SyntheticCrack crack;
  crack.on_sites = false;
  expect(measure(crack), CrackPattern::straight, {"the path has no waviness"});
  crack.path = sinusoid(wavelength, 0.4 * d);
  expect(measure(crack), CrackPattern::straight, {"an amplitude of 0.4 d, less than the 0.75 d of an oscillation"});
  crack.path = sinusoid(wavelength, 3. * d);
  expect(measure(crack), CrackPattern::oscillating,
         {"an amplitude of 3 d, at least the 0.75 d of an oscillation", "% of the path"});
  crack.path = sinusoid(0.7 * length / 1.2, 6. * d);
  expect(measure(crack), CrackPattern::undecided, {"an amplitude of", "fewer than 1.5 periods: it may be a bend"});
}

// All window lengths, also with a tenth of the entries: all numbers must be finite. Up to 25 mm, less than the run-in
// and 12 columns, the pattern is undecided.
TEST(CrackMeasurement, AnyPartOfARecordCanBeMeasured)
{
  SyntheticCrack crack;
  crack.path = sinusoid(wavelength, amplitude);
  crack.hops = d;
  const std::vector<TipRecord> whole = crack.record(2);
  for (std::size_t n = 1; n < whole.size(); n += n < 30 ? 1 : 7)
    for (const std::size_t stride : {1u, 10u})
    {
      SCOPED_TRACE(testing::Message() << n << ' ' << stride);
      std::vector<TipRecord> tip;
      for (std::size_t i = 0; i < n; i += stride)
        tip.push_back(whole[i]);
      const CrackMeasurement m = measure_crack(tip, {}, options_for(tip));
      for (const auto &measured : {m.speed_lagrangian, m.speed_laboratory, m.wavelength, m.amplitude})
        if (measured)
        {
          EXPECT_TRUE(std::isfinite(measured->value) && std::isfinite(measured->uncertainty));
          EXPECT_GE(measured->uncertainty, 0.);
        }
      if (tip.back().X >= 0.2 * length + 12. * d)
        continue;
      EXPECT_EQ(m.pattern, CrackPattern::undecided);
      EXPECT_FALSE(m.wavelength);
      EXPECT_FALSE(m.reason.empty());
      EXPECT_LE(m.X_begin, m.X_end);
    }
}

TEST(CrackMeasurement, RefusesBadRecordsAndOptions)
{
  const std::vector<TipRecord> good = SyntheticCrack().record(1);
  EXPECT_NO_THROW(measure_crack(good, {}, options_for(good)));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const auto &[value, wrong] :
       std::vector<std::pair<double TipRecord::*, double>>{{&TipRecord::t, nan},
                                                           {&TipRecord::X, infinity},
                                                           {&TipRecord::Y, nan},
                                                           {&TipRecord::x, nan},
                                                           {&TipRecord::y, infinity},
                                                           {&TipRecord::t, good[49].t - 1e-9},
                                                           {&TipRecord::X, good[49].X - 0.1 * d}})
  {
    std::vector<TipRecord> tip = good;
    tip[50].*value = wrong;
    EXPECT_THROW(measure_crack(tip, {}, options_for(good)), std::invalid_argument) << wrong;
  }
  EXPECT_THROW(measure_crack(good, {{1e-3, nan, 0.}}, options_for(good)), std::invalid_argument);
  EXPECT_THROW(measure_crack(good, {}, CrackMeasurementOptions()), std::invalid_argument);
  using Options = CrackMeasurementOptions;
  for (const auto &[option, wrong] :
       std::vector<std::pair<double Options::*, double>>{{&Options::strip_length, nan},
                                                         {&Options::lattice_spacing, nan},
                                                         {&Options::lattice_spacing, 0.},
                                                         {&Options::end_time, nan},
                                                         {&Options::end_time, -1e-9},
                                                         {&Options::end_time, 0.5 * good.back().t},
                                                         {&Options::seed_tip_X, nan},
                                                         {&Options::seed_tip_X, length}})
  {
    CrackMeasurementOptions options = options_for(good);
    options.*option = wrong;
    EXPECT_THROW(measure_crack(good, {}, options), std::invalid_argument) << wrong;
  }
}

} // namespace crack_pattern_test
