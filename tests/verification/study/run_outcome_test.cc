// Which ended runs of a study are measurements: folders as the program leaves them, and damaged ones.
#include "verification/study/run_outcome.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace run_outcome_test
{

using namespace latcon;
using namespace study;

class EndedRun : public testing::Test
{
protected:
  // Writes a crack that ended with an exit code, and run.json with further members.
  void ended(const std::string &exit_code, const std::string &members) const
  {
    std::ofstream(folder_ / "crack.json") << R"({"pattern": "straight", "reason": "flat", "speed_lagrangian": 20.5})";
    std::ofstream(folder_ / "run.json") << R"({"exit_code": )" << exit_code << members << "}";
    std::ofstream(folder_ / "log.txt") << "latcon: last words\n";
  }

  RunOutcome outcome() const
  {
    PlannedRun run;
    run.run = "a";
    run.zeta = 0.5;
    return read_outcome(run, folder_.path());
  }

  TemporaryFolder folder_;
};

TEST_F(EndedRun, IsMeasuredIfAtMostPublishedValuesDiffer)
{
  for (const auto &[exit_code, members] : {std::pair("0", R"(, "failed_rows": {})"), std::pair("0", ""),
                                           std::pair("3", R"(, "failed_rows": {"fracture: wavelength": "reference"})")})
  {
    ended(exit_code, members);
    EXPECT_EQ(outcome().state, RunState::measured) << members;
    EXPECT_EQ(outcome().pattern, "straight");
    EXPECT_EQ(outcome().values.at("speed_lagrangian"), 20.5);
    EXPECT_EQ(outcome().problem, "");
  }
}

TEST_F(EndedRun, IsNoMeasurementIfAnotherRowFailed)
{
  ended("3", R"(, "failed_rows": {"fracture: energy imbalance": "ledger", "fracture: wavelength": "reference"})");
  const RunOutcome found = outcome();
  EXPECT_EQ(found.state, RunState::rejected);
  EXPECT_EQ(to_string(found.state), "failed its checks");
  EXPECT_EQ(found.problem, "fracture: energy imbalance (ledger)");
  EXPECT_EQ(found.pattern + found.reason, "");
  EXPECT_EQ(found.values, (Values{{"zeta", 0.5}}));
  // The numbers themselves are still there, for the comparison of two runs.
  PlannedRun run;
  const RunOutcome crack = read_crack(run, folder_.path());
  EXPECT_EQ(crack.values.at("speed_lagrangian"), 20.5);
  EXPECT_EQ(crack.problem, found.problem);
}

TEST_F(EndedRun, IsNoMeasurementIfItDoesNotSayWhatFailed)
{
  for (const char *members :
       {"", R"(, "failed_rows": {})", R"(, "failed_rows": 7)", R"(, "failed_rows": {"row": ["reference"]})"})
  {
    ended("3", members);
    EXPECT_EQ(outcome().state, RunState::rejected) << members;
    EXPECT_NE(outcome().problem, "") << members;
  }
}

TEST_F(EndedRun, IsRefusedOrFailedWithoutACrack)
{
  ended("3", R"(, "failed_rows": {"energy: moduli": "claim"})");
  std::filesystem::remove(folder_ / "crack.json");
  EXPECT_EQ(outcome().state, RunState::refused);
  EXPECT_EQ(outcome().problem, "latcon: last words");
  ended("4", "");
  EXPECT_EQ(outcome().state, RunState::failed);
}

} // namespace run_outcome_test
