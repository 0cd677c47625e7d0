// Sweeps of the command line: values, messages that name the wrong part, and the equivalent study files.
#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/study/study_output.h"
#include "verification/study/study_plan.h"
#include "verification/study/sweep.h"

namespace sweep_test
{

using namespace latcon;
using namespace study;

using Texts = std::vector<std::string>;

std::string refusal(const std::string &text)
{
  try
  {
    (void)parse_sweep(text);
  }
  catch (const support::InputError &error)
  {
    return error.what();
  }
  return "nothing";
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

Study read(const std::string &text)
{
  return read_study(text, "folder/sweep.json", false);
}

TEST(Sweep, GridsHaveBothEndsAndShortNumbers)
{
  EXPECT_EQ(parse_sweep("Loading/strain y=1.5:1.9:5").values, (Texts{"1.5", "1.6", "1.7", "1.8", "1.9"}));
  EXPECT_EQ(parse_sweep("Loading/strain x = -0.1 : 0.2 : 4").values, (Texts{"-0.1", "0", "0.1", "0.2"}));
  EXPECT_EQ(parse_sweep("Sheet/height=1 cm:2cm:3").values, (Texts{"1 cm", "1.5 cm", "2 cm"}));
  EXPECT_EQ(parse_sweep("Nearest neighbours/a=1e5:+2e5:2").values, (Texts{"100000", "200000"}));
}

TEST(Sweep, ListsAreValuesOfAnyKind)
{
  EXPECT_EQ(parse_sweep("Sheet/orientation=rows-along-crack, rows-across-crack").values,
            (Texts{"rows-along-crack", "rows-across-crack"}));
  EXPECT_EQ(parse_sweep("Sheet/height=1 cm,5 cm").values, (Texts{"1 cm", "5 cm"}));
}

TEST(Sweep, MessagesNameTheWrongPart)
{
  EXPECT_HAS(refusal("Loading/strain z=1:2:3"),
             "'Loading/strain z' is not an entry of a case; nearest: Loading/strain");
  EXPECT_HAS(refusal("Loading/strain y"), "expected Section/Name=START:STOP:COUNT");
  EXPECT_HAS(refusal("Loading/strain y=1:2"), "'1:2' has 2 parts");
  EXPECT_HAS(refusal("Loading/strain y=a:2:3"), "START 'a': not a number");
  EXPECT_HAS(refusal("Loading/strain y=1:2 cm:3"), "STOP '2 cm': wrong unit");
  EXPECT_HAS(refusal("Loading/strain y=1::3"), "STOP is empty");
  EXPECT_HAS(refusal("Loading/strain y=1:2:1"), "COUNT '1' must be a whole number from 2");
  EXPECT_HAS(refusal("Loading/strain y=1:2:2.5"), "COUNT '2.5'");
  EXPECT_HAS(refusal("Loading/strain y=2:2:3"), "START and STOP must differ");
  EXPECT_HAS(refusal("Sheet/height=1 cm:20 mm:3"), "must have the same unit");
  EXPECT_HAS(refusal("Sheet/orientation=1:2:3"), "Sheet/orientation is not a number");
  EXPECT_HAS(refusal("Loading/strain y=1,,2"), "value 2 is empty");
  EXPECT_HAS(refusal("Loading/strain y=-1e308:1e308:3"), "START '-1e308' and STOP '1e308' are too far apart");
  EXPECT_HAS(refusal("Loading/strain y=1,2,1"), "the value 1 is given twice");
  EXPECT_HAS(refusal("Sheet/height=2 cm,3 cm,0.02 m"), "the value 0.02 m is given twice, also as 2 cm");
  EXPECT_HAS(refusal("Loading/strain x=0,-0"), "the value -0 is given twice, also as 0");
  EXPECT_HAS(refusal("Loading/strain y=1"), "expected two values or more; for one value use --set");
  EXPECT_HAS(refusal("Lattice/noise seed=1,2"), "seeds are set by --seeds");
}

TEST(Sweep, SeveralSweepsGiveAllCombinationsAsAStudyFile)
{
  const std::string text = sweep_study({"Loading/strain y=1.5:1.6:2", "Sheet/height=2 cm,3 cm"}, "fig1", "base.prm",
                                       {{"Material/density", "900"}}, 3);
  const Study study = read(text);
  EXPECT_EQ(study.title, "Sweep of Loading/strain y, Sheet/height (fig1)");
  EXPECT_EQ(study.base, "folder/base.prm");
  ASSERT_EQ(study.runs.size(), 4u);
  EXPECT_EQ(study.runs[0].name, "strain-y-1.5_height-2cm");
  EXPECT_EQ(study.runs[1].name, "strain-y-1.5_height-3cm");
  EXPECT_EQ(study.runs[3].own, (Settings{{"Loading/strain y", "1.6"}, {"Sheet/height", "3 cm"}}));
  EXPECT_EQ(study.runs[3].seeds, (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(study.settings, (Settings{{"Material/density", "900"}}));
  EXPECT_TRUE(study.claims.empty());
}

TEST(Sweep, NamesOfRunsAreDistinct)
{
  const Study study = read(sweep_study(
    {"Nearest neighbours/viscosity=1 N s/m,1 N s*m", "Next-nearest neighbours/viscosity=1,2"}, "x", "base.prm", {}, 0));
  std::set<std::string> names;
  for (const StudyRun &run : study.runs)
    names.insert(run.name);
  EXPECT_EQ(names.size(), 4u);
  EXPECT_EQ(study.runs[0].name, "Nearest-neighbours-viscosity-1Ns-m_Next-nearest-neighbours-viscosity-1");
}

// Of a combination alone, so that the quick version, or a study with further values, names it alike.
TEST(Sweep, NamesThatAreTooLongDependOnTheirValuesAlone)
{
  const std::string first = "lam^2 + " + std::string(200, '1'), second = first + " + lam";
  const Sweep pair{"Nearest neighbours/psi", {first, second}}, swapped{pair.entry, {second, first}};
  const std::vector<SweptCase> found = combinations({pair}, 1), other = combinations({swapped}, 1);
  EXPECT_EQ(found[0].name, other[1].name);
  EXPECT_EQ(found[1].name, other[0].name);
  EXPECT_NE(found[0].name, found[1].name);
  EXPECT_TRUE(std::regex_match(found[0].name, std::regex("psi-lam-21{124}-[0-9a-f]{16}"))) << found[0].name;
}

TEST(Sweep, EntriesSweptTwiceOrAlsoSetAreRefused)
{
  const Sweep sweep = parse_sweep("Sheet/height=2 cm,3 cm");
  EXPECT_THROW((void)combinations({sweep, sweep}, 1), support::InputError);
  EXPECT_THROW((void)sweep_study({"Sheet/height=2 cm,3 cm"}, "x", "x", {{"Sheet/height", "1"}}, 1),
               support::InputError);
}

TEST(Sweep, RunsAreLimitedWithAllTheirSeeds)
{
  const Sweep sweep = parse_sweep("Loading/strain y=1:2:1000");
  EXPECT_EQ(combinations({sweep}, 100).size(), 1000u);
  EXPECT_THROW((void)combinations({sweep}, 101), support::InputError);
  EXPECT_THROW((void)combinations({sweep, parse_sweep("Loading/strain x=1:2:101")}, 1), support::InputError);
  EXPECT_THROW((void)read(sweep_study({"Loading/strain y=1:2:1000"}, "x", "x", {}, 101)), support::InputError);
}

TEST(Sweep, StudyFilesSweepBesideNamedRunsAndInTheirQuickVersion)
{
  const std::string text = R"({"title": "t", "base": "b.prm", "seeds": [4, 5], "sweep": ["Sheet/height=2 cm:4 cm:3"],
    "quick": {"seeds": [7], "sweep": ["Sheet/height=2 cm,4 cm"]}, "runs": {"own": {}},
    "claims": [{"claim": "c", "rows": [{"run": "height-2cm", "quantity": "pattern"}]}]})";
  const Study study = read(text);
  ASSERT_EQ(study.runs.size(), 4u);
  EXPECT_EQ(study.runs[1].name, "height-3cm");
  EXPECT_EQ(study.runs[1].seeds, (std::vector<std::uint64_t>{4, 5}));
  EXPECT_EQ(study.runs[3].name, "own");
  const Study quick = read_study(text, "folder/sweep.json", true);
  ASSERT_EQ(quick.runs.size(), 3u);
  EXPECT_EQ(quick.runs[1].own, (Settings{{"Sheet/height", "4 cm"}}));
  EXPECT_EQ(quick.runs[1].seeds, (std::vector<std::uint64_t>{7}));
  EXPECT_EQ(quick.swept, Texts{"Sheet/height"});
  // Claims may be about runs of the full sweep alone.
  const std::string of_full = std::regex_replace(text, std::regex("height-2cm"), "height-3cm");
  EXPECT_EQ(read_study(of_full, "folder/sweep.json", true).left_out, Texts{"height-3cm"});
  EXPECT_EQ(read(of_full).left_out, Texts());
  try
  {
    (void)read(R"({"title": "t", "base": "b.prm", "sweep": ["Sheet/hight=1,2"]})");
    FAIL();
  }
  catch (const support::InputError &error)
  {
    EXPECT_HAS(std::string(error.what()), "folder/sweep.json: sweep: sweep 'Sheet/hight=1,2': 'Sheet/hight' is not an");
  }
  for (const bool is_quick : {false, true})
    try
    {
      (void)read_study(
        R"({"title": "t", "base": "b.prm", "quick": {"sweep": ["Sheet/height=1,2"]}, "runs": {"own": {}}})",
        "folder/sweep.json", is_quick);
      FAIL();
    }
    catch (const support::InputError &error)
    {
      EXPECT_HAS(std::string(error.what()), "folder/sweep.json: quick/sweep: needs the key 'sweep' of the study");
    }
}

TEST(Sweep, EntriesOfAnyKindAreVariedAndNoneIsSetAsWell)
{
  const std::string base = std::filesystem::path(study_path("paper")).parent_path().parent_path() / "cases/quick.prm";
  Study study = read(sweep_study({"Sheet/orientation=rows-along-crack,rows-across-crack", "Sheet/height=2 cm,3 cm",
                                  "Next-nearest neighbours/present=false,true"},
                                 "quick", "base.prm", {}, 2));
  study.base = base;
  // A run that leaves an entry as it is in the base case, and an entry whose value is the same in all runs.
  study.runs.resize(2);
  study.runs[0].own = {{"Next-nearest neighbours/present", "true"}, {"Fracture/seed sites", "6"}};
  study.runs[1].own = {{"Sheet/orientation", "rows-across-crack"}, {"Fracture/seed sites", "6"}};
  for (StudyRun &run : study.runs)
    run.all = run.own;
  StudyResults results;
  results.study = study;
  results.plan = plan_runs(study, input::read_input_file(base), {});
  for (const PlannedRun &planned : results.plan)
  {
    results.outcomes.emplace_back();
    results.outcomes.back().run = planned.run;
  }
  const auto document = nlohmann::json::parse(study_json(results));
  EXPECT_EQ(document["swept"].size(), 3u);
  EXPECT_EQ(document["varied"].size(), 1u) << document["varied"];
  EXPECT_EQ(document["varied"][0]["entry"], "Sheet/orientation");
  EXPECT_EQ(document["varied"][0]["values"], (Texts{"rows-along-crack", "rows-across-crack"}));
  try
  {
    (void)plan_runs(study, input::read_input_file(base), {"Sheet/height=2 cm"});
    FAIL();
  }
  catch (const support::InputError &error)
  {
    EXPECT_HAS(std::string(error.what()), "--set: Sheet/height is also an entry of the sweep of folder/sweep.json");
  }
}

// A hundred seeds cost no more cases, and no text is kept.
TEST(Sweep, ACaseIsResolvedOnceForAllItsSeeds)
{
  Study study = read(sweep_study({"Loading/strain y=1.5:1.9:3"}, "quick", "base.prm", {}, 100));
  study.base = std::filesystem::path(study_path("paper")).parent_path().parent_path() / "cases/quick.prm";
  const std::vector<PlannedRun> plan = plan_runs(study, input::read_input_file(study.base), {});
  ASSERT_EQ(plan.size(), 300u);
  std::set<const PlannedCase *> resolved;
  std::set<const void *> shared;
  std::set<std::string> hashes;
  for (const PlannedRun &run : plan)
  {
    resolved.insert(run.planned_case.get());
    shared.insert(run.planned_case->base.get());
    shared.insert(run.planned_case->keys.get());
    hashes.insert(run.case_sha256);
  }
  EXPECT_EQ(resolved.size(), 3u);
  EXPECT_EQ(shared.size(), 2u);
  EXPECT_EQ(hashes.size(), 300u); // the seed is a part of the case

  // Each seed has the case that it would have alone.
  Study alone = study;
  alone.runs = {study.runs[1]};
  alone.runs[0].seeds = {70};
  const PlannedRun one = plan_runs(alone, input::read_input_file(study.base), {}).at(0);
  const PlannedRun &same = plan.at(169);
  EXPECT_EQ(one.folder(), same.folder());
  EXPECT_EQ(one.case_sha256, same.case_sha256);
  EXPECT_EQ(one.case_text(), same.case_text());
  EXPECT_HAS(same.case_text(), "set noise seed      = 70");
  EXPECT_DOUBLE_EQ(same.value(seed_entry).value(), 70.);
}

} // namespace sweep_test
