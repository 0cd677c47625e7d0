// A destination contains the old file or the new one, and only parts that this process created are ever written to.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "support/atomic_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace atomic_file_test
{

using namespace latcon::support;
namespace fs = std::filesystem;

// Returns the message of the error when a file is written; empty if there is none.
std::string complaint(const std::string &path, const std::string &text = "new")
{
  return message_of<OutputError>([&] { write_atomically(path, text, Sync::yes); });
}

std::vector<fs::path> entries(const TemporaryFolder &folder)
{
  return {fs::directory_iterator(folder.path()), fs::directory_iterator()};
}

// Returns the part in a folder that contains nothing else.
fs::path only_part(const TemporaryFolder &folder)
{
  const std::vector<fs::path> found = entries(folder);
  EXPECT_EQ(found.size(), 1U);
  return found.at(0);
}

// Limits the size of files of this process, as if the disk became full in the middle of a file.
class SmallDisk
{
public:
  explicit SmallDisk(rlim_t bytes)
  {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SmallDisk()
  {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

private:
  rlimit before_{};
};

TEST(AtomicFile, HasTheRightsOfAnyOtherFile)
{
  const TemporaryFolder folder;
  const mode_t before = umask(027);
  write_atomically(folder / "a.txt", "", Sync::no);
  umask(before);
  struct stat status
  {
  };
  ASSERT_EQ(stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777U, 0640U);
}

TEST(AtomicFile, LibrariesOpenItByName)
{
  const TemporaryFolder folder;
  AtomicFile file(folder / "a.txt");
  // Independent of changes to the name of the part in the meantime.
  const fs::path part = only_part(folder);
  std::ofstream(folder / "victim") << "mine";
  fs::rename(part, folder / "moved");
  fs::create_symlink(folder / "victim", part);
  std::ofstream(file.name()) << "whole";
  EXPECT_EQ(content_of(folder / "victim"), "mine");
  EXPECT_EQ(content_of(folder / "moved"), "whole");
  fs::rename(folder / "moved", part);
  file.commit(Sync::no);
  EXPECT_EQ(content_of(folder / "a.txt"), "whole");
}

TEST(AtomicFile, PartsHaveNamesThatNobodyForesees)
{
  const TemporaryFolder folder;
  const AtomicFile one(folder / "a"), other(folder / "a");
  const std::vector<fs::path> found = entries(folder);
  ASSERT_EQ(found.size(), 2U);
  for (const fs::path &part : found)
    EXPECT_EQ(part.filename().string().size(), std::string("a..part").size() + 16);
}

TEST(AtomicFile, FailuresNameTheReasonAndLeaveTheOldFile)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt", missing = folder / "missing/a.txt", pipe = folder / "pipe";
  write_atomically(path, "old", Sync::yes);
  EXPECT_EQ(complaint(missing), "cannot write " + missing + ": No such file or directory");
  EXPECT_NE(complaint("/proc/latcon_test"), ""); // not even root may create a file here
  {
    const SmallDisk disk(1000);
    EXPECT_EQ(complaint(path, std::string(2000, 'x')), "cannot write " + path + ": File too large");
  }
  if (geteuid() != 0)
  {
    ASSERT_EQ(chmod(folder.path().c_str(), 0500), 0);
    EXPECT_EQ(complaint(path), "cannot write " + path + ": Permission denied");
    ASSERT_EQ(chmod(folder.path().c_str(), 0700), 0);
  }
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(entries(folder).size(), 1U);

  fs::create_directory(folder / "sub");
  EXPECT_EQ(complaint(folder / "sub"), "cannot write " + (folder / "sub") + ": it is a folder");
  // A pipe represents all devices: code that fails this test as root would destroy a real device.
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(complaint(pipe), "cannot write " + pipe + ": it is not a regular file");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, ReadersAndWritersAtOnceSeeWholeFiles)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_atomically(path, std::string(50000, 'a'), Sync::no);
  std::vector<std::thread> writers;
  for (const char letter : {'b', 'c', 'd', 'e'})
    writers.emplace_back(
      [&path, letter]
      {
        for (int i = 0; i < 100; ++i)
          write_atomically(path, std::string(50000, letter), Sync::no);
      });
  int n_torn = 0;
  for (int i = 0; i < 500; ++i)
  {
    const std::string text = content_of(path);
    n_torn += text.size() == 50000 && text.find_first_not_of(text[0]) == std::string::npos ? 0 : 1;
  }
  for (std::thread &writer : writers)
    writer.join();
  EXPECT_EQ(n_torn, 0);
  EXPECT_EQ(entries(folder).size(), 1U);
}

TEST(StaleParts, OfKilledRunsAreRemoved)
{
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0)
  {
    AtomicFile file(folder / "a.txt");
    file.write("half");
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const fs::path part = only_part(folder);
  for (const char *other : {"a.txt", "a.txt.part", "a.0123456789abcde.part", "a.0123456789abcdeg.part", ".part"})
    std::ofstream(folder / other) << "not a part";
  const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const fs::path &path : entries(folder))
    if (path != part)
      fs::last_write_time(path, hour_ago - std::chrono::hours(1));
  EXPECT_EQ(remove_stale_parts(folder.path(), hour_ago), 0U);
  EXPECT_TRUE(fs::exists(part));
  fs::last_write_time(part, hour_ago - std::chrono::seconds(1));
  EXPECT_EQ(remove_stale_parts(folder.path(), hour_ago), 1U);
  EXPECT_FALSE(fs::exists(part));
  EXPECT_EQ(entries(folder).size(), 5U);
  EXPECT_EQ(remove_stale_parts(folder / "missing", fs::file_time_type::max()), 0U);
}

} // namespace atomic_file_test
