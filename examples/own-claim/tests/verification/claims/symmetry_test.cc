#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/subjects.h"
#include "verification/claims/claim_list.h"

using namespace latcon;

namespace
{

output::Results symmetry(const bridge::Subject &subject)
{
  return claims::check_symmetry({subject, subjects::paper_case(), true, {}}).results;
}

TEST(Symmetry, HoldsForBothShellSetsAndOrientations)
{
  faults::expect_holds(
    [](const input::Case &, const bridge::Subject &subject)
    {
      const output::Results results = symmetry(subject);
      EXPECT_EQ(results.rows().size(), 4u);
      return results;
    });
}

TEST(Symmetry, FailsForALawWithOneStifferDirection)
{
  bridge::Subject wrong = bridge::subject(subjects::paper_case());
  std::vector<continuum::FibreFamily> families = wrong.cauchy_born.families();
  families.front().weight *= 1.01;
  wrong.cauchy_born = continuum::CauchyBorn(families);
  EXPECT_EQ(faults::failing(symmetry(wrong), "rotated undeformed sheet"), 2u);
  EXPECT_EQ(faults::failing(symmetry(wrong), "rotated deformed sheet"), 0u);
}

} // namespace
