// Summary of a crack for the terminal.
#include "verification/analysis/crack_measurement.h"
#include "verification/commands/command.h"

#include <gtest/gtest.h>

namespace crack_summary_test
{

using namespace latcon;

using namespace commands;
using namespace output;

Result checked(const std::string &claim, const std::string &quantity, double error)
{
  return {claim, quantity, "1", {}, {}, {}, error, 0.01};
}

TEST(CrackSummary, SaysWhatWasMeasuredBesideTheReferenceAndWhichRowsFail)
{
  input::Case input;
  input.reference_wavelength = 0.023;
  input.reference_speed = 20.9;
  analysis::CrackMeasurement crack;
  crack.pattern = analysis::CrackPattern::oscillating;
  crack.reason = "it winds " + std::string(100, 'x') + " and winds";
  crack.speed_lagrangian = analysis::Measured{20.2, 0.84};
  crack.speed_laboratory = analysis::Measured{40., 1.};
  crack.wavelength = analysis::Measured{0.02359, 0.00026};
  crack.amplitude = analysis::Measured{0.00154, 0.00014}; // has no reference
  Results results;
  results.add(checked("energy", "one", 0.));
  results.add(checked("prestretch", "far", 0.005));
  for (int i = 0; i < 6; ++i)
    results.add(checked("energy", "row " + std::to_string(i), i == 0 ? 0. : 0.25));
  results.add({"fracture", "speed", "m/s", 3., {}, {}, {}, {}});
  EXPECT_EQ(crack_summary(input, crack, results),
            "The crack is oscillating: it winds\n" + std::string(100, 'x') + R"( and winds
  Lagrangian crack speed    20.20 ± 0.84 m/s        reference 20.9 m/s, -3.3 %
  laboratory crack speed    40.0 ± 1.0 m/s
  wavelength, undeformed    2.359 ± 0.026 cm        reference 2.3 cm, +2.6 %
  amplitude, undeformed     0.154 ± 0.014 cm
  energy                    5 of 7 checks fail
  prestretch                1 check holds
  fracture                  nothing was checked
5 of 8 checks fail:
  energy: row 1: error 0.25, tolerance 0.01
  energy: row 2: error 0.25, tolerance 0.01
  energy: row 3: error 0.25, tolerance 0.01
  energy: row 4: error 0.25, tolerance 0.01
  and 1 more, see results.csv
)");
}

TEST(CrackSummary, SaysWhatCouldNotBeMeasured)
{
  input::Case input;
  input.reference_amplitude = 0.0017;
  analysis::CrackMeasurement crack;
  crack.reason = "too short";
  EXPECT_EQ(crack_summary(input, crack, {}), "The pattern of the crack is undecided: too short\n"
                                             "  amplitude, undeformed     not measured            reference 0.17 cm\n");
  EXPECT_EQ(times_text({{"claims", 8.06}, {"fracture", 61.4}}), "claims 8.1 s, fracture 61 s");
}

} // namespace crack_summary_test
