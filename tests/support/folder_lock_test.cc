// Only one process at a time holds the lock of a folder, until it ends for any reason.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "support/atomic_file.h"
#include "support/folder_lock.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace folder_lock_test
{

using namespace latcon::support;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

// Returns the message with which a lock is refused; empty if it is granted.
std::string refusal(const std::string &folder)
{
  return message_of<InputError>([&] { const FolderLock lock(folder, 0ms); });
}

// Process that locks a folder and waits for a signal.
class Holder
{
public:
  explicit Holder(const std::string &folder)
  {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    process_ = fork();
    if (process_ == 0)
    {
      const FolderLock lock(folder);
      EXPECT_EQ(write(ready[1], "x", 1), 1);
      pause();
    }
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Holder()
  {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }

  pid_t process() const { return process_; }

private:
  pid_t process_ = 0;
};

TEST(FolderLock, WaitsForAProcessThatIsAboutToEnd)
{
  const TemporaryFolder folder;
  const Holder holder(folder.path());
  const pid_t helper = fork();
  if (helper == 0)
  {
    usleep(100000);
    kill(holder.process(), SIGKILL);
    _exit(0);
  }
  EXPECT_TRUE(FolderLock(folder.path(), 30s).is_held());
  waitpid(helper, nullptr, 0);
}

TEST(FolderLock, IsNotInherited)
{
  const TemporaryFolder folder;
  std::optional<FolderLock> lock(folder.path());
  EXPECT_TRUE(lock->is_held());
  EXPECT_NE(refusal(folder.path()), "");
  const pid_t child = fork();
  if (child == 0)
    execl("/bin/sleep", "sleep", "30", nullptr);
  // Until exec the child has the descriptors of this process.
  lock.reset();
  EXPECT_TRUE(FolderLock(folder.path(), 20s).is_held());
  EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST(FolderLock, FilesAreNotWrittenToAFolderThatTookThePlace)
{
  const TemporaryFolder folder;
  const std::string out = folder / "out", file = out + "/a.txt", below = out + "/sub/b.txt";
  const std::string why = ": the folder " + out + " was removed or replaced during the run";
  fs::create_directories(out + "/sub");
  {
    const FolderLock lock(out + "/"); // another spelling of the path
    EXPECT_NO_THROW(write_atomically(file, "mine", Sync::no));
    EXPECT_NO_THROW(write_atomically(out + "/../out/sub/b.txt", "mine", Sync::no));
    AtomicFile begun(file);
    fs::remove_all(out);
    fs::create_directories(out + "/sub");
    EXPECT_THROW(begun.commit(Sync::no), OutputError);
    for (const std::string &place : {file, below})
      EXPECT_EQ(message_of<OutputError>([&] { write_atomically(place, "mine", Sync::no); }),
                "cannot write " + place + why);
    EXPECT_NO_THROW(write_atomically(folder / "beside.txt", "mine", Sync::no));
    EXPECT_TRUE(fs::is_empty(out + "/sub"));
    EXPECT_EQ(std::distance(fs::directory_iterator(out), fs::directory_iterator()), 1);
  }
  EXPECT_NO_THROW(write_atomically(file, "mine", Sync::no)); // without a lock there is no check
}

TEST(FolderLock, FollowsNoLinksAndWaitsForNoPipes)
{
  const TemporaryFolder folder;
  std::ofstream(folder / "victim") << "mine";
  fs::create_symlink(folder / "victim", folder / ".latcon.lock");
  EXPECT_THROW(FolderLock(folder.path()), OutputError);
  EXPECT_EQ(content_of(folder / "victim"), "mine");
  fs::remove(folder / ".latcon.lock");
  fs::create_hard_link(folder / "victim", folder / ".latcon.lock");
  EXPECT_NO_THROW(FolderLock(folder.path()));
  EXPECT_EQ(content_of(folder / "victim"), "mine");
  fs::remove(folder / ".latcon.lock");
  ASSERT_EQ(mkfifo((folder / ".latcon.lock").c_str(), 0600), 0);
  EXPECT_THROW(FolderLock(folder.path()), OutputError);
  EXPECT_THROW(FolderLock(folder / "missing"), OutputError);
}

} // namespace folder_lock_test
