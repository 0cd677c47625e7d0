// Study files: content, precedence of settings, and error messages with positions.
#include <filesystem>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case.h"
#include "verification/study/study_file.h"
#include "verification/study/study_plan.h"

namespace study_file_test
{

using namespace latcon;
using namespace input;
using namespace study;

const std::string cases = std::filesystem::path(study_path("paper")).parent_path().parent_path() / "cases";

nlohmann::ordered_json example()
{
  return nlohmann::ordered_json::parse(R"({
    "title": "Example", "base": ")" + cases +
                                       R"(/quick.prm",
    "set": {"Sheet/height": "2 cm", "Fracture/seed sites": 6},
    "quick": {"set": {"Sheet/length": "3 cm", "Fracture/seed sites": 4}, "seeds": [9]},
    "runs": {
      "one": {"set": {"Fracture/seed sites": 5}, "seeds": [3, 1]},
      "a-2": {"quick": {"set": {"Sheet/length": "3.5 cm"}, "seeds": [7, 8]}},
      "big": {"about": "large", "set": {"Next-nearest neighbours/present": false}, "quick": false}
    },
    "claims": [{"claim": "c", "paper": "p", "note": "n", "rows": [
      {"run": "one", "quantity": "wavelength", "is near": 0.02, "tolerance": 0.1, "quick": false},
      {"runs": ["a-2", "one"], "quantity": "amplitude", "falls": true, "against": "zeta"},
      {"runs": ["a-2", "big"], "quantity": "pattern", "bracket": {"from": "straight", "to": "branching"},
       "against": "Sheet/height"},
      {"run": "one", "quantity": "speed_lagrangian", "below": {"run": "big"}},
      {"run": "one", "quantity": "pattern", "is": "arrested"},
      {"run": "one", "quantity": "periods"}
    ]}],
    "pictures": ["big"]
  })");
}

Study read(const nlohmann::ordered_json &document, bool quick = false)
{
  return read_study(document.dump(), "folder/x.json", quick);
}

// Returns the error message for a text that is not a valid study.
std::string refusal(const std::string &text)
{
  try
  {
    (void)read_study(text, "x.json", false);
  }
  catch (const latcon::support::InputError &error)
  {
    return error.what();
  }
  return "nothing";
}

std::vector<PlannedRun> plan_of(const Study &study, const std::vector<std::string> &settings = {})
{
  return plan_runs(study, read_input_file(study.base), settings);
}

// Returns the only problem of the example after `change`.
template <typename Change>
std::string problem_after(const Change &change)
{
  nlohmann::ordered_json document = example();
  change(document);
  try
  {
    const Study study = read(document);
    (void)plan_of(study);
  }
  catch (const latcon::support::InputError &error)
  {
    EXPECT_EQ(error.problems().size(), 1u) << error.what();
    EXPECT_EQ(error.problems().front().find("folder/x.json: "), 0u) << error.what();
    return error.problems().front();
  }
  return "no problem";
}

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(StudyFile, RunsKeepTheirOrderAndTheNearestSettingWins)
{
  const Study study = read(example());
  ASSERT_EQ(study.runs.size(), 3u);
  EXPECT_EQ(study.runs[0].name, "one");
  EXPECT_EQ(study.runs[0].all, (Settings{{"Sheet/height", "2 cm"}, {"Fracture/seed sites", "5"}}));
  EXPECT_EQ(study.runs[0].own, (Settings{{"Fracture/seed sites", "5"}}));
  EXPECT_EQ(study.runs[0].seeds, (std::vector<std::uint64_t>{3, 1}));
  EXPECT_EQ(study.runs[1].seeds, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(study.runs[2].own, (Settings{{"Next-nearest neighbours/present", "false"}}));
  EXPECT_TRUE(study.left_out.empty());
}

TEST(StudyFile, QuickVersionHasAnotherBaseAndLeavesRunsOut)
{
  const Study study = read(example(), true);
  ASSERT_EQ(study.runs.size(), 2u);
  EXPECT_EQ(study.runs[0].all,
            (Settings{{"Sheet/height", "2 cm"}, {"Fracture/seed sites", "5"}, {"Sheet/length", "3 cm"}}));
  EXPECT_EQ(study.runs[0].seeds, (std::vector<std::uint64_t>{9}));
  EXPECT_EQ(study.runs[1].all,
            (Settings{{"Sheet/height", "2 cm"}, {"Fracture/seed sites", "4"}, {"Sheet/length", "3.5 cm"}}));
  EXPECT_EQ(study.runs[1].seeds, (std::vector<std::uint64_t>{7, 8}));
  EXPECT_EQ(study.left_out, std::vector<std::string>{"big"});
  EXPECT_EQ(study.claims[0].rows[0].rule, Rule::reported);
  EXPECT_EQ(read(example()).claims[0].rows[0].rule, Rule::is_near);
}

TEST(StudyFile, BaseCaseHasTheSettingsOfAllRuns)
{
  const Study study = read(example());
  const InputFile file = read_input_file(study.base);
  EXPECT_EQ(base_case(study, file, {}).height, 0.02);
  EXPECT_EQ(base_case(study, file, {" Sheet/height = 1.5 cm "}).height, 0.015);
  EXPECT_THROW((void)base_case(study, file, {"Sheet/height"}), latcon::support::InputError);
}

TEST(StudyFile, RowsHaveTheirRules)
{
  const std::vector<StudyRow> rows = read(example()).claims[0].rows;
  EXPECT_DOUBLE_EQ(rows[0].bound, 0.02);
  EXPECT_DOUBLE_EQ(rows[0].tolerance, 0.1);
  EXPECT_EQ(rows[1].rule, Rule::falls);
  EXPECT_EQ(rows[1].against, "zeta");
  EXPECT_EQ(rows[2].rule, Rule::bracket);
  EXPECT_EQ(rows[2].from + " " + rows[2].to, "straight branching");
  EXPECT_EQ(rows[3].bound_run, "big");
  EXPECT_EQ(rows[4].pattern, "arrested");
  EXPECT_EQ(rows[5].rule, Rule::reported);
}

TEST(StudyFile, PlanResolvesEveryCase)
{
  const std::vector<PlannedRun> plan = plan_of(read(example()), {"Fracture/seed sites=3"});
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_EQ(plan[0].folder(), "one-3");
  EXPECT_EQ(plan[2].folder(), "a-2-1");
  EXPECT_DOUBLE_EQ(plan[0].value("Lattice/noise seed").value(), 3.);
  EXPECT_DOUBLE_EQ(plan[0].value("Sheet/height").value(), 0.02);
  EXPECT_DOUBLE_EQ(plan[0].value("Fracture/seed sites").value(), 3.);
  EXPECT_DOUBLE_EQ(plan[0].value("Output/frame interval").value(), 0.);
  EXPECT_FALSE(plan[0].value("Sheet/orientation").has_value());
  // theory.md, eq. (L.5): (eta / a) / (d / sqrt(a / rho)) = 65.625 / 1e5 / (0.625e-3 / sqrt(1e5 / 944))
  EXPECT_NEAR(plan[0].zeta.value(), 10.80695, 1e-5);
  EXPECT_GT(plan[0].size, 1000.);
  EXPECT_GT(plan[0].seconds, 0.);
  EXPECT_NE(plan[0].case_text().find("set noise seed"), std::string::npos);
}

TEST(StudyFile, RunsHaveTheSideOfTheStudyUnlessTheyNameTheirOwn)
{
  nlohmann::ordered_json document = example();
  document["set"]["Damage/threshold energy"] = "9 MPa";
  document["set"]["Damage/cells per length"] = 2;
  document["runs"]["one"]["side"] = "continuum";
  const std::vector<PlannedRun> plan = plan_of(read(document));
  EXPECT_EQ(plan[0].side(), "continuum");
  EXPECT_EQ(plan[2].side(), "lattice");
  // Two cells per spacing of 0.625 mm: 128 in 4 cm; up to 2 cm an odd number of rows, 63 at most.
  const double rows = plan[0].size / 128.;
  EXPECT_TRUE(rows == 63. || rows == 61.) << rows;
  EXPECT_GT(plan[0].seconds, 0.);
  document["side"] = "continuum";
  document["runs"]["one"]["side"] = "lattice";
  const std::vector<PlannedRun> other = plan_of(read(document));
  EXPECT_EQ(other[0].side(), "lattice");
  EXPECT_EQ(other[2].side(), "continuum");
}

TEST(StudyFile, ProblemsOfTheContinuumAreFoundBeforeTheFirstRun)
{
  using Json = nlohmann::ordered_json;
  EXPECT_HAS(problem_after([](Json &d) { d["side"] = "contnuum"; }),
             "side: 'contnuum' is not a known side; nearest: continuum");
  EXPECT_HAS(problem_after(
               [](Json &d)
               {
                 d["runs"]["one"]["side"] = "continuum";
                 d["runs"]["one"]["set"]["Nearest neighbours/branch moduli"] = "0.1 MPa";
                 d["runs"]["one"]["set"]["Nearest neighbours/relaxation times"] = "1 ms";
               }),
             "does not support bonds with memory");
  EXPECT_HAS(problem_after(
               [](Json &d)
               {
                 d["runs"]["one"]["side"] = "continuum";
                 d["runs"]["one"]["set"]["Damage/threshold energy"] = "1 kPa";
               }),
             "would be damaged everywhere");
}

TEST(StudyFile, LinearBondsHaveNoZeta)
{
  nlohmann::ordered_json document = example();
  document["runs"]["one"]["set"]["Nearest neighbours/law"] = "linear";
  EXPECT_FALSE(plan_of(read(document))[0].zeta.has_value());
}

TEST(StudyFile, TheMostExpensiveRunComesFirst)
{
  std::vector<PlannedRun> plan(3);
  for (std::size_t i = 0; i < plan.size(); ++i)
  {
    plan[i].seconds = i == 1 ? 20. : 10.;
  }
  EXPECT_EQ(longest_first(plan), (std::vector<std::size_t>{1, 0, 2}));
}

TEST(StudyFile, UnknownWordsAreNamedWithTheirPlaceAndTheNearestKnownOne)
{
  using Json = nlohmann::ordered_json;
  EXPECT_HAS(problem_after([](Json &d) { d["pictuers"] = d["pictures"]; }),
             "unknown key 'pictuers'; nearest: pictures");
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["one"]["set"]["Sheet/spacin"] = 1; }),
             "runs/one/set/Sheet/spacin: not an entry of a case; nearest: Sheet/spacing");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][5]["run"] = "onee"; }),
             "claims/1/rows/6/run: 'onee' is not a known run; nearest: one");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][5]["quantity"] = "wavelenght"; }),
             "claims/1/rows/6/quantity: 'wavelenght' is not a known quantity; nearest: wavelength");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][4]["is"] = "wavy"; }), "'wavy' is not a known pattern");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][1]["against"] = "zetta"; }), "nearest: zeta");
  EXPECT_HAS(problem_after([](Json &d) { d["pictures"][0] = "nothing"; }), "pictures/1: 'nothing' is not a known run");
  EXPECT_HAS(problem_after(
               [](Json &d) {
                 d["claims"][0]["rows"][1]["runs"] = {"one", "a-2", "one"};
               }),
             "claims/1/rows/2/runs/3: 'one' is given twice");
  EXPECT_HAS(problem_after([](Json &d) { d["checks"] = {"steady-crack"}; }), "unknown key 'checks'");
}

TEST(StudyFile, NoMessageListsThousandsOfRuns)
{
  const std::string problem = problem_after(
    [](nlohmann::ordered_json &d)
    {
      for (int run = 0; run < 3000; ++run)
        d["runs"]["r" + std::to_string(run)] = nlohmann::ordered_json::object();
      d["pictures"][0] = "nothing";
    });
  EXPECT_HAS(problem, "... (3003 in all)");
  EXPECT_LT(problem.size(), 1000u);
}

TEST(StudyFile, WordsOfAStudyOfOnesOwnMayBeLeftOut)
{
  nlohmann::ordered_json document = example();
  document["claims"][0].erase("paper");
  document["claims"][0]["note"] = "";
  document["runs"]["big"]["about"] = "";
  const Study study = read(document);
  EXPECT_EQ(study.claims.front().paper, "");
  EXPECT_EQ(study.claims.front().note, "");
  EXPECT_EQ(study.run("big").about, "");
  EXPECT_HAS(problem_after([](nlohmann::ordered_json &d) { d["claims"][0]["paper"] = 3; }),
             "paper: must be a non-empty text");
}

TEST(StudyFile, RowsKnowTheUnitOfWhatTheyAreAgainst)
{
  const std::vector<StudyRow> rows = read(example()).claims.front().rows;
  EXPECT_EQ(rows[1].against_unit, "1"); // zeta
  EXPECT_EQ(rows[2].against_unit, "m"); // Sheet/height
  EXPECT_EQ(rows[4].against_unit, "");
}

TEST(StudyFile, ShippedStudiesAreThoseInTheFolder)
{
  EXPECT_EQ(shipped_studies(),
            (std::vector<std::string>{"continuum-paper", "map", "onset", "paper", "patterns", "time-stepping"}));
  EXPECT_EQ(study_choices(),
            "study file (.json), or a shipped one: continuum-paper, map, onset, paper, patterns, time-stepping");
  try
  {
    (void)read_study_file(study_path("nosuch"), false);
    FAIL();
  }
  catch (const latcon::support::InputError &error)
  {
    EXPECT_HAS(std::string(error.what()),
               "nosuch: cannot read the study: No such file or directory; give a " + study_choices());
  }
}

TEST(StudyFile, WrongTypesAndMissingKeysAreNamed)
{
  using Json = nlohmann::ordered_json;
  EXPECT_HAS(problem_after([](Json &d) { d.erase("title"); }), "the key 'title' is missing");
  EXPECT_HAS(problem_after([](Json &d) { d["seeds"] = 3; }), "seeds: must be a non-empty list");
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["one"]["seeds"][1] = 1.5; }), "runs/one/seeds/2: must be a whole");
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["one"]["seeds"][1] = 3; }), "this seed is given twice");
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["one"]["set"]["Lattice/noise seed"] = 3; }), "is set by \"seeds\"");
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["../x"] = Json::object(); }), "the name of a run");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][0]["is near"] = "2 cm"; }), "must be a number");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][0].erase("tolerance"); }), "must be given together");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][0]["above"] = 1; }), "a row can have only one rule");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][1].erase("against"); }), "needs \"against\"");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][1]["falls"] = false; }), "falls: must be true");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][4]["quantity"] = "periods"; }), "\"pattern\"");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][3]["quantity"] = "pattern"; }), "not for patterns");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][1]["run"] = "one"; }), "either \"run\" or \"runs\"");
}

TEST(StudyFile, CasesThatAreWrongAreNamedOnceWithTheirRun)
{
  using Json = nlohmann::ordered_json;
  EXPECT_HAS(problem_after([](Json &d) { d["runs"]["one"]["set"]["Fracture/breaking stretch"] = 2.; }),
             "runs/one: --set: Fracture/breaking stretch = 2.0");
  EXPECT_HAS(problem_after([](Json &d) { d["set"]["Material/density"] = -1; }), "Material/density = -1");
  EXPECT_HAS(problem_after([](Json &d) { d["claims"][0]["rows"][1]["against"] = "Sheet/orientation"; }),
             "is not a number in any of these runs");
}

TEST(StudyFile, OnsetExponentHasATolerance)
{
  using Json = nlohmann::ordered_json;
  const auto row = [](Json &d) -> Json & { return d["claims"][0]["rows"][1]; };
  Json document = example();
  row(document).erase("falls");
  row(document)["onset exponent"] = 0.5;
  row(document)["tolerance"] = 0.2;
  const StudyRow read_row = read(document).claims.front().rows[1];
  EXPECT_EQ(read_row.rule, Rule::onset_exponent);
  EXPECT_EQ(read_row.bound, 0.5);
  EXPECT_EQ(read_row.tolerance, 0.2);
  const auto problem = [&](const auto &change)
  {
    return problem_after(
      [&](Json &d)
      {
        d = document;
        change(row(d));
      });
  };
  EXPECT_HAS(problem([](Json &r) { r["onset exponent"] = 0; }), "onset exponent: must be larger than 0");
  EXPECT_HAS(problem([](Json &r) { r.erase("tolerance"); }), "must be given together");
  EXPECT_HAS(problem([](Json &r) { r.erase("against"); }), "needs \"against\"");
  EXPECT_HAS(problem([](Json &r) { r["falls"] = true; }), "only one rule");
  EXPECT_HAS(problem([](Json &r) { r["quantity"] = "pattern"; }), "not for patterns");
}

TEST(StudyFile, RefinementNeedsASweepOfNumbers)
{
  using Json = nlohmann::ordered_json;
  Json document = example();
  document["sweep"] = {"Loading/strain y=1.7,1.8", "Sheet/height=1 cm:2 cm:3"};
  document["set"].erase("Sheet/height");
  document["refine"] = 2;
  EXPECT_EQ(read(document).refine, 2u);
  EXPECT_EQ(read(document, true).refine, 2u);
  document["quick"]["refine"] = 0;
  EXPECT_EQ(read(document).refine, 2u);
  EXPECT_EQ(read(document, true).refine, 0u);
  EXPECT_EQ(read(example()).refine, 0u);
  const std::vector<StudyRun> runs = read(document).runs;
  EXPECT_TRUE(runs.front().is_swept);
  EXPECT_FALSE(runs.back().is_swept);
  const auto problem = [&](const auto &change)
  {
    return problem_after(
      [&](Json &d)
      {
        d = document;
        change(d);
      });
  };
  EXPECT_HAS(problem([](Json &d) { d["refine"] = 7; }), "refine: must be a whole number from 0 to 6");
  EXPECT_HAS(problem([](Json &d) { d["refine"] = -1; }), "refine: must be a whole number from 0 to 6");
  EXPECT_HAS(problem([](Json &d) { d["quick"]["refine"] = "1"; }), "quick/refine: must be a whole number");
  EXPECT_HAS(problem([](Json &d) { d.erase("sweep"); }), "refine: needs the key 'sweep'");
  EXPECT_HAS(problem([](Json &d) { d["sweep"] = {"Fracture/seed sites=6,8"}; }), "refine: needs sweeps of numbers");
  EXPECT_HAS(problem([](Json &d) { d["sweep"] = {"Sheet/orientation=rows-along-crack,rows-across-crack"}; }),
             "refine: needs sweeps of numbers");
}

TEST(StudyFile, TextThatIsNoStudyIsRefused)
{
  EXPECT_THROW((void)read_study("[1]", "x.json", false), latcon::support::InputError);
  EXPECT_THROW((void)read_study("{", "x.json", false), latcon::support::InputError);
  EXPECT_HAS(refusal(example().dump() + std::string("\0anything", 9)), "it holds zero bytes");
  EXPECT_THROW((void)read_study_file("/no/such/file.json", false), latcon::support::InputError);
  try
  {
    (void)read_study(R"({"title": "a", "title": "b"})", "x.json", false);
    FAIL();
  }
  catch (const latcon::support::InputError &error)
  {
    EXPECT_HAS(std::string(error.what()), "'title' occurs twice");
  }
}

TEST(StudyFile, TheShippedStudyIsWhole)
{
  for (const bool quick : {false, true})
  {
    const Study study = read_study_file(study_path("paper"), quick);
    EXPECT_FALSE(plan_of(study).empty());
    EXPECT_GT(study.claims.size(), 10u);
  }
}

// Deep nesting could overflow the stack, and a number could be out of range.
TEST(StudyFile, RefusesNumbersAndDepthBeyondAllSense)
{
  for (const std::string &text :
       {std::string(100000, '['), "{\"title\": " + std::string(100, '[') + std::string(100, ']') + "}",
        std::string("{\"seeds\": [1e999]}"), std::string("{\"title\": \"\xff\"}")})
    try
    {
      (void)read_study(text, "folder/x.json", false);
      FAIL() << text.substr(0, 40);
    }
    catch (const latcon::support::InputError &error)
    {
      EXPECT_HAS(std::string(error.what()), "folder/x.json: not");
    }
}

} // namespace study_file_test
