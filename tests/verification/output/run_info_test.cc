// Content of run.json: program, libraries, times, outcome.
#include "tests/support/temporary_folder.h"

#include "verification/output/run_info.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace run_info_test
{

using namespace latcon;
using latcon::support::ExitCode;
using output::RunInfo;
using output::Stopwatch;

// Returns true if the text contains a number, a point, and a number.
bool is_version(const std::string &text)
{
  const std::size_t point = text.find('.');
  return point != std::string::npos && point > 0 && point + 1 < text.size() && std::isdigit(text[point - 1]) != 0 &&
         std::isdigit(text[point + 1]) != 0;
}

TEST(Stopwatch, AddsUpThePhases)
{
  Stopwatch stopwatch;
  for (int i = 0; i < 2; ++i)
  {
    const auto phase = stopwatch.phase("sleep");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  auto phase = stopwatch.phase("nothing");
  phase.reset();
  ASSERT_EQ(stopwatch.times().size(), 2u);
  const double seconds = stopwatch.times()[1].second;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  phase.reset();
  ASSERT_EQ(stopwatch.times().size(), 2u);
  EXPECT_EQ(stopwatch.times()[0].first, "sleep");
  EXPECT_GE(stopwatch.times()[0].second, 0.04);
  EXPECT_LT(stopwatch.times()[0].second, 30.);
  EXPECT_EQ(stopwatch.times()[1].second, seconds);
}

TEST(RunInfo, TellsProgramLibrariesAndMachine)
{
  RunInfo run({"latcon", "verify", "--set", "a=\xff"});
  run.stopwatch().add("assembly", 1.5);
  const nlohmann::json document = nlohmann::json::parse(run.json(ExitCode::claim_failed, "fails"));
  EXPECT_TRUE(is_version(document["version"]));
  const std::string commit = document["git_commit"];
  EXPECT_TRUE(commit == "unknown" || commit.find_first_not_of("0123456789abcdef") >= 40) << commit;
  EXPECT_NE(document["compiler"], "");
  for (const char *library : {"deal.II", "Trilinos", "p4est", "VTK", "Eigen", "MPI"})
    EXPECT_TRUE(is_version(document["libraries"][library])) << library;
  EXPECT_GE(document["threads"].get<int>(), 1);
  EXPECT_EQ(document["mpi_ranks"].get<int>(), 1);
  EXPECT_EQ(document["command_line"].size(), 4u);
  EXPECT_EQ(document["command_line"][1], "verify");
  EXPECT_EQ(document["wall_time_s"]["assembly"].get<double>(), 1.5);
  EXPECT_GE(document["wall_time_total_s"].get<double>(), 0.);
  EXPECT_EQ(document["exit_code"].get<int>(), 3);
  EXPECT_EQ(document["verdict"], "fails");
}

TEST(RunInfo, OutcomeIsNullWhileTheRunIsUnderWay)
{
  const nlohmann::json document = nlohmann::json::parse(RunInfo({"latcon"}).json({}));
  EXPECT_TRUE(document["exit_code"].is_null());
  EXPECT_TRUE(document["verdict"].is_null());
}

TEST(RunInfo, HoldsWhatTheRunAdds)
{
  RunInfo run({"latcon"});
  run.add("skip_verification", false);
  run.add("skip_verification", true);
  run.add("sites", std::uint64_t(1) << 60);
  run.add("time_step_s", 0.1);
  run.add("residual", std::numeric_limits<double>::infinity());
  run.add("case", "fig1.prm");
  run.add("verification", {{"hash", "abc"}, {"reused", true}, {"residual", 0.1}});
  EXPECT_THROW(run.add("version", "mine"), std::logic_error);
  const nlohmann::json document = nlohmann::json::parse(run.json(ExitCode::done));
  EXPECT_EQ(document["skip_verification"], true);
  EXPECT_EQ(document["sites"].get<std::uint64_t>(), std::uint64_t(1) << 60);
  EXPECT_EQ(document["time_step_s"].get<double>(), 0.1);
  EXPECT_EQ(document["residual"], "inf");
  EXPECT_EQ(document["case"], "fig1.prm");
  EXPECT_EQ(document["verification"], (nlohmann::json{{"hash", "abc"}, {"reused", true}, {"residual", 0.1}}));
}

TEST(RunInfo, DoesNotNameTheMachine)
{
  char host[256] = {};
  ASSERT_EQ(gethostname(host, sizeof(host) - 1), 0);
  const std::string name = host;
  if (name.size() > 3) // a shorter name may be part of any word
  {
    EXPECT_EQ(RunInfo({"latcon"}).json({}).find(name), std::string::npos);
  }
}

TEST(RunInfo, WritesTheFile)
{
  const TemporaryFolder folder;
  RunInfo({"latcon"}).write(folder / "run.json", ExitCode::done);
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "run.json"))["program"], "latcon");
  EXPECT_THROW(RunInfo({"latcon"}).write(folder / "missing/run.json", ExitCode::done), latcon::support::OutputError);
}

} // namespace run_info_test
