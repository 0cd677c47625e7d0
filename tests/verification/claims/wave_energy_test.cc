// Energies of fields that vary, and what makes the claim about them fail.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"

namespace wave_energy_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

// The excess is there, with its sign: the gradient continuum holds more energy than the local one, the lattice less.
void expect_that_the_local_energy_is_between(const Table &table)
{
  const auto column = [&](const std::string &name)
  {
    const auto found = std::find(table.columns().begin(), table.columns().end(), name);
    return static_cast<std::size_t>(found - table.columns().begin());
  };
  EXPECT_EQ(table.rows().size(), 2u * 2u * 2u); // directions, kd, waves
  for (const auto &row : table.rows())
  {
    EXPECT_LT(std::get<double>(row[column("lattice")]), 1. - 1e-3);
    EXPECT_GT(std::get<double>(row[column("gradient")]), 1. + 1e-3);
  }
}

// theory-comparison.md, eqs. (W.4) and (W.5).
TEST(WaveEnergy, HoldsForBothShellSetsAcrossTheCrack)
{
  faults::expect_holds(
    [](const Case &input, const Subject &subject)
    {
      const ClaimOutcome outcome = parts::energy_of_waves(subject, {faults::state_for(input, subject)});
      EXPECT_EQ(outcome.results.count(Verdict::reported), 0u);
      if (subject.material.next_nearest) // nearest neighbours alone leave less than it judges
        expect_that_the_local_energy_is_between(outcome.tables.at("sinusoidal_energy"));
      return outcome.results;
    });
}

// The ratio of the constants of a bond is not that of the sheet.
TEST(Energy, FailsForTheRatioOfTheBondConstants)
{
  const Case input = subjects::paper_case();
  Subject wrong = subject(input);
  wrong.mooney_rivlin = with_ratio(input.lattice(), input.material(), input.deformation(), 0.6);
  EXPECT_EQ(faults::failing(energy_claim(wrong, 10), "calibrated ratio"), 1u);
  // As a choice of the user's it is nothing to judge.
  wrong.ratio_is_calibrated = false;
  const Results given = energy_claim(wrong, 10);
  EXPECT_EQ(std::count_if(given.rows().begin(), given.rows().end(),
                          [](const Result &row) {
                            return row.quantity.find("given ratio r") != std::string::npos &&
                                   row.verdict() == Verdict::reported;
                          }),
            1);
}

} // namespace wave_energy_test
