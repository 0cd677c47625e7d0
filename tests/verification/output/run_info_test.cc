// Content of run.json: program, libraries, times, outcome.
#include "verification/output/run_info.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <limits>
#include <regex>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace run_info_test
{

using namespace latcon;
using latcon::support::ExitCode;
using output::RunInfo;
using output::Stopwatch;

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

TEST(RunInfo, TellsLibrariesAndWhatTheRunAddsButNotTheMachine)
{
  RunInfo run({"latcon", "verify", "--set", "a=\xff"});
  run.stopwatch().add("assembly", 1.5);
  run.add("skip_verification", false);
  run.add("skip_verification", true);
  run.add("sites", std::uint64_t(1) << 60);
  run.add("time_step_s", 0.1);
  run.add("residual", std::numeric_limits<double>::infinity());
  run.add("verification", {{"hash", "abc"}, {"reused", true}, {"residual", 0.1}});
  EXPECT_THROW(run.add("version", "mine"), std::logic_error);
  const std::string text = run.json(ExitCode::claim_failed, "fails");
  const nlohmann::json document = nlohmann::json::parse(text);
  const std::string commit = document["git_commit"];
  EXPECT_TRUE(commit == "unknown" || commit.find_first_not_of("0123456789abcdef") >= 40) << commit;
  for (const char *library : {"deal.II", "Trilinos", "p4est", "VTK", "Eigen", "MPI"})
    EXPECT_TRUE(std::regex_search(document["libraries"][library].get<std::string>(), std::regex("[0-9]\\.[0-9]")))
      << library;
  EXPECT_EQ(document["command_line"].size(), 4u);
  EXPECT_EQ(document["wall_time_s"]["assembly"], 1.5);
  EXPECT_EQ(document["skip_verification"], true);
  EXPECT_EQ(document["sites"].get<std::uint64_t>(), std::uint64_t(1) << 60);
  EXPECT_EQ(document["time_step_s"].get<double>(), 0.1);
  EXPECT_EQ(document["residual"], "inf");
  EXPECT_EQ(document["verification"], (nlohmann::json{{"hash", "abc"}, {"reused", true}, {"residual", 0.1}}));
  char host[256] = {};
  ASSERT_EQ(gethostname(host, sizeof(host) - 1), 0);
  EXPECT_TRUE(std::string(host).size() < 4 ||
              text.find(host) == std::string::npos); // a short one may be part of a word
}

} // namespace run_info_test
