/// Child processes.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace latcon::support
{

/// Program to start as a child process.
struct ChildProgram
{
  std::vector<std::string> command;     ///< path of the program, followed by its arguments
  std::vector<std::string> environment; ///< `NAME=value`
  std::string log; ///< file for standard output and standard error, replaced if it exists; empty: inherit
};

/// Exit status of a child that could not be started.
inline constexpr int not_started = 127;

/// Starts a program without standard input. The child gets SIGTERM if this process dies. It ignores SIGINT: Ctrl-C in a
/// terminal reaches both processes, and this process handles it. @throws OutputError if the log cannot be written or
/// the process cannot be started
pid_t start_child(const ChildProgram &program);

/// Waits for a child. @return its exit status, 128 + the signal that killed it, or not_started
int wait_for_child(pid_t child);

/// Returns the exit status of a child as wait_for_child() does, or -1 while it runs.
int poll_child(pid_t child);

} // namespace latcon::support
