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
};

/// Exit status of a child that could not be started.
inline constexpr int not_started = 127;

/// Pointers to words that live on, followed by a null pointer, as execve() wants them.
std::vector<char *> pointers(std::vector<std::string> &words);

/// Starts a program without standard input. The child gets SIGTERM if this process dies. It ignores SIGINT: Ctrl-C in a
/// terminal reaches both processes, and this process handles it. @throws OutputError if the
/// process cannot be started
pid_t start_child(const ChildProgram &program);

/// Waits for a child. @return its exit status, 128 + the signal that killed it, or not_started
int wait_for_child(pid_t child);

/// Returns the exit status of a child as wait_for_child() does, or -1 while it runs.
int poll_child(pid_t child);

} // namespace latcon::support
