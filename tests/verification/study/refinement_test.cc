// Refinement of a sweep: points between neighbours that differ, and nowhere else.
#include "verification/study/refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace refinement_test
{

using namespace latcon;
using namespace study;

// Sweep of both strains over 3 x 2 points with two seeds, whose outcomes are made up.
class MadeUpSweep
{
public:
  MadeUpSweep()
  {
    study.swept = {"Loading/strain x", "Loading/strain y"};
    for (const char *x : {"1", "1.4", "2"})
      for (const char *y : {"1.5", "1.7"})
        add({std::string("strain-x-") + x + "_strain-y-" + y,
             "",
             {{"Loading/strain x", x}, {"Loading/strain y", y}},
             {{"Sheet/height", "2 cm"}, {"Loading/strain x", x}, {"Loading/strain y", y}},
             {1, 2},
             true,
             0});
  }

  void add(const StudyRun &run)
  {
    study.runs.push_back(run);
    const auto planned_case = std::make_shared<PlannedCase>();
    planned_case->keys = std::make_shared<const std::vector<std::string>>(
      std::vector<std::string>{"Loading/strain x", "Loading/strain y"});
    for (const auto &[key, value] : run.own)
      planned_case->numbers.push_back(std::stod(value));
    for (const std::uint64_t seed : run.seeds)
    {
      PlannedRun planned;
      planned.run = run.name;
      planned.seed = seed;
      planned.planned_case = planned_case;
      plan.push_back(planned);
      RunOutcome outcome;
      outcome.run = run.name;
      outcome.seed = seed;
      outcome.state = RunState::measured;
      outcome.pattern = "straight";
      outcomes.push_back(outcome);
    }
  }

  RunOutcome &outcome(const std::string &run, std::uint64_t seed)
  {
    return *std::find_if(outcomes.begin(), outcomes.end(),
                         [&](const RunOutcome &known) { return known.run == run && known.seed == seed; });
  }

  void show(const std::string &run, const std::string &first, const std::string &second)
  {
    outcome(run, 1).pattern = first;
    outcome(run, 2).pattern = second;
  }

  std::vector<StudyRun> refined(std::size_t level) const { return refined_runs(study, plan, outcomes, level); }

  std::vector<std::string> names(std::size_t level) const
  {
    std::vector<std::string> found;
    for (const StudyRun &run : refined(level))
      found.push_back(run.name);
    return found;
  }

  Study study;
  std::vector<PlannedRun> plan;
  std::vector<RunOutcome> outcomes;
};

using Names = std::vector<std::string>;

TEST(Refinement, NothingBetweenEqualPatterns)
{
  EXPECT_TRUE(MadeUpSweep().refined(1).empty());
}

TEST(Refinement, AddsThePointsBetweenNeighboursThatDiffer)
{
  MadeUpSweep sweep;
  sweep.show("strain-x-2_strain-y-1.7", "oscillating", "oscillating");
  EXPECT_EQ(sweep.names(1), (Names{"strain-x-1.7_strain-y-1.7", "strain-x-2_strain-y-1.6"}));
  const StudyRun run = sweep.refined(1).front();
  EXPECT_EQ(run.level, 1u);
  EXPECT_TRUE(run.is_swept);
  EXPECT_EQ(run.seeds, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(run.own, (Settings{{"Loading/strain x", "1.7"}, {"Loading/strain y", "1.7"}}));
  EXPECT_EQ(run.all, (Settings{{"Sheet/height", "2 cm"}, {"Loading/strain x", "1.7"}, {"Loading/strain y", "1.7"}}));
}

// Each level halves the bracket of the boundary.
TEST(Refinement, GoesOnBetweenThePointsOfTheLevelBefore)
{
  MadeUpSweep sweep;
  for (const char *name : {"strain-x-2_strain-y-1.5", "strain-x-2_strain-y-1.7"})
    sweep.show(name, "oscillating", "oscillating");
  const std::vector<StudyRun> first = sweep.refined(1);
  ASSERT_EQ(first.size(), 2u);
  for (const StudyRun &run : first)
    sweep.add(run);
  EXPECT_TRUE(sweep.refined(1).empty()); // no point twice
  EXPECT_EQ(sweep.names(2), (Names{"strain-x-1.85_strain-y-1.5", "strain-x-1.85_strain-y-1.7"}));
  sweep.show("strain-x-1.7_strain-y-1.5", "oscillating", "oscillating");
  EXPECT_EQ(sweep.names(2), (Names{"strain-x-1.55_strain-y-1.5", "strain-x-1.85_strain-y-1.7"}));
}

TEST(Refinement, SeedsThatDisagreeDifferFromAllNeighbours)
{
  MadeUpSweep sweep;
  sweep.show("strain-x-1_strain-y-1.5", "straight", "oscillating");
  const Names both{"strain-x-1_strain-y-1.6", "strain-x-1.2_strain-y-1.5"};
  EXPECT_EQ(sweep.names(1), both);
  sweep.show("strain-x-1_strain-y-1.7", "oscillating", "straight"); // as mixed as its neighbour
  EXPECT_EQ(sweep.names(1), (Names{both[0], both[1], "strain-x-1.2_strain-y-1.7"}));
  sweep.show("strain-x-1_strain-y-1.7", "straight", "straight");
  sweep.show("strain-x-1_strain-y-1.5", "undecided", "undecided");
  EXPECT_EQ(sweep.names(1), both);
}

TEST(Refinement, RunsWithoutAMeasurementDifferFromNothing)
{
  MadeUpSweep sweep;
  sweep.show("strain-x-1_strain-y-1.5", "", "");
  for (const std::uint64_t seed : {1, 2})
    sweep.outcome("strain-x-1_strain-y-1.5", seed).state = RunState::failed;
  EXPECT_TRUE(sweep.refined(1).empty());
  sweep.outcome("strain-x-1_strain-y-1.5", 2).state = RunState::measured; // one seed is enough
  sweep.outcome("strain-x-1_strain-y-1.5", 2).pattern = "branching";
  EXPECT_EQ(sweep.refined(1).size(), 2u);
}

TEST(Refinement, RunsBesideTheSweepTakeNoPart)
{
  MadeUpSweep sweep;
  StudyRun other = sweep.study.runs.front();
  other.name = "strain-x-1.7_strain-y-1.7";
  other.is_swept = false;
  sweep.add(other);
  EXPECT_TRUE(sweep.refined(1).empty());
  sweep.show("strain-x-2_strain-y-1.7", "oscillating", "oscillating");
  EXPECT_EQ(sweep.names(1), (Names{"level-1-1", "strain-x-2_strain-y-1.6"})); // the name is taken
}

TEST(Refinement, NeedsASweepOfNumbers)
{
  MadeUpSweep sweep;
  EXPECT_THROW((void)sweep.refined(0), std::logic_error);
  sweep.study.swept = {"Sheet/orientation"};
  EXPECT_THROW((void)sweep.refined(1), std::logic_error);
  sweep.study.swept.clear();
  EXPECT_THROW((void)sweep.refined(1), std::logic_error);
}

} // namespace refinement_test
