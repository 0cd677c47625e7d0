/// Faults of files, for tests: a library to preload that counts what a program does to the files of one folder and, at
/// the n-th such call, kills the program or lets the disk be full from then on.
///
///     LATCON_FAULT=kill|full|count  LATCON_FAULT_AT=n  LATCON_FAULT_IN=FOLDER  [LATCON_FAULT_LOG=FILE]
///
/// Counted are creating, writing, syncing, renaming and deleting, each from the program or its libraries. FOLDER is
/// absolute. With `count` nothing happens but that the number of calls is written to FILE at the end.
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{

std::atomic<long> calls{0};

const char *setting(const char *name)
{
  const char *value = std::getenv(name);
  return value != nullptr ? value : "";
}

bool is_inside(const char *path)
{
  const std::string folder = setting("LATCON_FAULT_IN");
  return path != nullptr && !folder.empty() && std::strncmp(path, folder.c_str(), folder.size()) == 0;
}

bool is_inside(int descriptor)
{
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t n = ::readlink(link.c_str(), path, sizeof(path) - 1);
  if (n <= 0)
    return false;
  path[n] = '\0';
  return is_inside(path);
}

// Counts a call; kills at the chosen one. @return whether the disk is full by now
bool count_call()
{
  const long call = ++calls;
  const long at = std::atol(setting("LATCON_FAULT_AT"));
  const std::string fault = setting("LATCON_FAULT");
  if (fault == "kill" && call == at)
    ::kill(::getpid(), SIGKILL);
  return fault == "full" && call >= at;
}

template <class Function>
Function *next(const char *name)
{
  return reinterpret_cast<Function *>(::dlsym(RTLD_NEXT, name));
}

struct Log
{
  ~Log()
  {
    // Processes that the program starts, such as those of MPI, are none of those that are counted.
    if (calls == 0)
      return;
    if (const char *path = std::getenv("LATCON_FAULT_LOG"))
      if (std::FILE *file = std::fopen(path, "w"))
      {
        std::fprintf(file, "%ld\n", calls.load());
        std::fclose(file);
      }
  }
} log_at_end;

} // namespace

extern "C"
{

  ssize_t write(int descriptor, const void *bytes, size_t n)
  {
    if (is_inside(descriptor) && count_call())
    {
      errno = ENOSPC;
      return -1;
    }
    static const auto real = next<ssize_t(int, const void *, size_t)>("write");
    return real(descriptor, bytes, n);
  }

  ssize_t writev(int descriptor, const iovec *pieces, int n)
  {
    if (is_inside(descriptor) && count_call())
    {
      errno = ENOSPC;
      return -1;
    }
    static const auto real = next<ssize_t(int, const iovec *, int)>("writev");
    return real(descriptor, pieces, n);
  }

  int fsync(int descriptor)
  {
    if (is_inside(descriptor) && count_call())
    {
      errno = ENOSPC;
      return -1;
    }
    static const auto real = next<int(int)>("fsync");
    return real(descriptor);
  }

  // These need no room on a disk.

  int rename(const char *from, const char *to) noexcept
  {
    if (is_inside(to))
      count_call();
    static const auto real = next<int(const char *, const char *)>("rename");
    return real(from, to);
  }

  int unlink(const char *path) noexcept
  {
    if (is_inside(path))
      count_call();
    static const auto real = next<int(const char *)>("unlink");
    return real(path);
  }

  FILE *fopen(const char *path, const char *mode)
  {
    if (is_inside(path) && std::strpbrk(mode, "wa+") != nullptr)
      count_call();
    static const auto real = next<FILE *(const char *, const char *)>("fopen");
    return real(path, mode);
  }

  FILE *fopen64(const char *path, const char *mode)
  {
    if (is_inside(path) && std::strpbrk(mode, "wa+") != nullptr)
      count_call();
    static const auto real = next<FILE *(const char *, const char *)>("fopen64");
    return real(path, mode);
  }
}
