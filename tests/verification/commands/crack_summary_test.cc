// Summary of a crack for the terminal.
#include "verification/analysis/crack_measurement.h"
#include "verification/commands/command.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace crack_summary_test
{

using namespace latcon;

using namespace commands;
using namespace input;
using namespace output;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

Result checked(const std::string &quantity, double error)
{
  return {"energy", quantity, "1", {}, {}, {}, error, 0.01};
}

analysis::CrackMeasurement oscillating()
{
  analysis::CrackMeasurement crack;
  crack.pattern = analysis::CrackPattern::oscillating;
  crack.reason = "it winds";
  crack.speed_lagrangian = analysis::Measured{20.2, 0.84};
  crack.wavelength = analysis::Measured{0.02359, 0.00026};
  crack.amplitude = analysis::Measured{0.00154, 0.00014};
  return crack;
}

TEST(CrackSummary, SaysWhatWasMeasuredBesideTheReference)
{
  Case input;
  input.reference_wavelength = 0.023;
  input.reference_speed = 20.9;
  Results results;
  results.add(checked("one", 0.));
  results.add(checked("two", 0.005));
  const std::string text = crack_summary(input, oscillating(), results);
  EXPECT_HAS(text, "The crack is oscillating: it winds\n");
  EXPECT_HAS(text, "20.20 ± 0.84 m/s");
  EXPECT_HAS(text, "reference 20.9 m/s, -3.3 %");
  EXPECT_HAS(text, "2.359 ± 0.026 cm");
  EXPECT_HAS(text, "reference 2.3 cm, +2.6 %");
  EXPECT_HAS(text, "0.154 ± 0.014 cm\n"); // has no reference
  EXPECT_EQ(text.find("laboratory"), std::string::npos);
  EXPECT_HAS(text, "  energy                    2 checks hold\n");
}

TEST(CrackSummary, HasALineForEachClaim)
{
  Results results;
  results.add(checked("one", 0.));
  results.add({"prestretch", "far", "1", {}, {}, {}, 0.5, 0.01});
  results.add(checked("two", 0.));
  results.add({"fracture", "speed", "m/s", 3., {}, {}, {}, {}});
  EXPECT_EQ(claim_lines(results), "  energy                    2 checks hold\n"
                                  "  prestretch                1 of 1 check fails\n"
                                  "  fracture                  nothing was checked\n");
}

TEST(CrackSummary, TimesHaveTwoDigits)
{
  EXPECT_EQ(times_text({{"claims", 8.06}, {"fracture", 61.4}}), "claims 8.1 s, fracture 61 s");
  EXPECT_EQ(times_text({}), "");
}

TEST(CrackSummary, SaysWhatCouldNotBeMeasured)
{
  Case input;
  input.reference_amplitude = 0.0017;
  analysis::CrackMeasurement crack;
  crack.reason = "too short";
  const std::string text = crack_summary(input, crack, {});
  EXPECT_HAS(text, "The pattern of the crack is undecided: too short\n");
  EXPECT_HAS(text, "not measured");
  EXPECT_HAS(text, "reference 0.17 cm\n");
}

TEST(CrackSummary, NamesRowsThatFailAndStaysShort)
{
  Case input;
  input.reference_wavelength = input.reference_amplitude = 0.023;
  input.reference_speed = 20.9;
  analysis::CrackMeasurement crack = oscillating();
  crack.speed_laboratory = analysis::Measured{40., 1.};
  crack.reason = std::string(200, 'x') + " " + std::string(80, 'y');
  Results results;
  for (int i = 0; i < 30; ++i)
    results.add(checked("row " + std::to_string(i), i % 2 == 0 ? 0. : 0.25));
  const std::string text = crack_summary(input, crack, results);
  EXPECT_HAS(text, "15 of 30 checks fail:\n  energy: row 1: error 0.25, tolerance 0.01\n");
  EXPECT_HAS(text, "and 11 more");
  EXPECT_HAS(text, "  energy                    15 of 30 checks fail\n");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 15);
}

} // namespace crack_summary_test
