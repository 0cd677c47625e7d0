// Child processes of a study: concurrency, termination, environment.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "tests/support/temporary_folder.h"
#include "verification/study/process_pool.h"

namespace study_pool_test
{

using namespace latcon;
using namespace study;

// Pool of shell scripts.
struct Scripts
{
  explicit Scripts(std::vector<std::string> texts, std::size_t limit = 2) : scripts(std::move(texts))
  {
    pool.n_jobs = scripts.size();
    pool.limit = limit;
    pool.start = [this](std::size_t job) -> ProcessPool::Job
    {
      started.push_back(job);
      return {{"/bin/sh", "-c", scripts[job]}, folder / std::to_string(job)};
    };
    pool.ended = [this](std::size_t job, int status) { statuses[job] = status; };
    pool.waiting = [this](const std::vector<std::size_t> &running)
    { most_at_once = std::max(most_at_once, running.size()); };
  }

  std::string log(std::size_t job) const { return content_of(folder / std::to_string(job)); }

  TemporaryFolder folder;
  std::vector<std::string> scripts;
  ProcessPool pool;
  std::vector<std::size_t> started;
  std::map<std::size_t, int> statuses;
  std::size_t most_at_once = 0;
};

TEST(StudyPool, AllJobsEndWithTheirStatusAndAFailureStopsNone)
{
  Scripts scripts({"true", "exit 4", "kill -9 $$", "echo out; echo err >&2"});
  EXPECT_TRUE(run_processes(scripts.pool));
  EXPECT_EQ(scripts.statuses, (std::map<std::size_t, int>{{0, 0}, {1, 4}, {2, 128 + 9}, {3, 0}}));
  EXPECT_EQ(scripts.log(3), "out\nerr\n");
  EXPECT_EQ(scripts.started, (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(StudyPool, NoMoreRunAtOnceThanAllowedAndAllThatMay)
{
  Scripts scripts({"sleep 0.1", "sleep 0.1", "sleep 0.1", "sleep 0.1", "sleep 0.1"}, 3);
  EXPECT_TRUE(run_processes(scripts.pool));
  EXPECT_EQ(scripts.most_at_once, 3u);
  EXPECT_EQ(scripts.statuses.size(), 5u);
}

TEST(StudyPool, ProgramThatIsNotThereGives127)
{
  Scripts scripts({"true"});
  scripts.pool.start = [&scripts](std::size_t) -> ProcessPool::Job {
    return {{"/no/such/program"}, scripts.folder / "log"};
  };
  EXPECT_TRUE(run_processes(scripts.pool));
  EXPECT_EQ(scripts.statuses.at(0), 127);
}

TEST(StudyPool, StopTellsRunningChildrenAndStartsNoMore)
{
  Scripts scripts({"trap 'echo told; exit 130' TERM; echo ready; while :; do sleep 0.02; done", "true"}, 1);
  scripts.pool.stop = [&scripts]
  { return std::filesystem::exists(scripts.folder / "0") && scripts.log(0) == "ready\n"; };
  EXPECT_FALSE(run_processes(scripts.pool));
  EXPECT_EQ(scripts.log(0), "ready\ntold\n");
  EXPECT_EQ(scripts.started, std::vector<std::size_t>{0});
  EXPECT_TRUE(scripts.statuses.empty());
}

TEST(StudyPool, ChildrenDoNotKnowTheMpiRunOfTheirParent)
{
  setenv("OMPI_COMM_WORLD_RANK", "3", 1);
  setenv("PMIX_RANK", "3", 1);
  setenv("LATCON_OTHER", "kept", 1);
  Scripts scripts({"echo $OMPI_COMM_WORLD_RANK$PMIX_RANK$LATCON_OTHER; read line || echo no input"});
  EXPECT_TRUE(run_processes(scripts.pool));
  EXPECT_EQ(scripts.log(0), "kept\nno input\n");
  for (const char *name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "LATCON_OTHER"})
    unsetenv(name);
}

TEST(StudyPool, ExceptionsEndTheChildrenFirst)
{
  Scripts scripts({"trap 'echo told; exit' TERM; echo ready; while :; do sleep 0.02; done", "true"});
  scripts.pool.ended = [&scripts](std::size_t, int)
  {
    while (scripts.log(0) != "ready\n")
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    throw latcon::support::OutputError("x", "full");
  };
  EXPECT_THROW(run_processes(scripts.pool), latcon::support::OutputError);
  EXPECT_EQ(scripts.log(0), "ready\ntold\n");
}

} // namespace study_pool_test
