/// Programs that this one starts.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace latcon::support
{

/// A program to start.
struct ChildProgram
{
  std::vector<std::string> command;     ///< path of the program, then its arguments
  std::vector<std::string> environment; ///< `NAME=value`
  std::string log;                      ///< file for its standard output and standard error; replaced. Empty: ours
};

/// Exit status of a child that could not be started.
inline constexpr int not_started = 127;

/// Starts a program without standard input. It gets SIGTERM if this process dies, and ignores SIGINT: what the keyboard
/// sends to both is for this process to act on. @throws OutputError if its log cannot be written or no process started
pid_t start_child(const ChildProgram &program);

/// Waits for a child. @return its exit status, 128 + the signal that killed it, or not_started
int wait_for_child(pid_t child);

/// Exit status of a child as above, or -1 while it runs.
int poll_child(pid_t child);

} // namespace latcon::support
