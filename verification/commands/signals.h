/// Signals that end a run, from the keyboard, `kill`, closed terminals, and batch systems.
#pragma once

#include <cstddef>
#include <functional>

namespace latcon::commands
{

/// Opens /dev/null, read only, for each standard stream that is closed: it cannot become a file of MPI, which would take
/// what is printed, and printing fails. To be called first.
void occupy_closed_streams();

/// From here on SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM and SIGXCPU end the process with
/// ExitCode::interrupted, at once or after the deferral that is under way. A SIGHUP that is ignored when the program
/// starts (`nohup`) stays ignored. SIGPIPE and SIGXFSZ are ignored, so that writing fails instead. Starts a thread that
/// waits until the main thread has received one. To be called once by each program that the process runs.
void install_signal_handlers();

/// While one exists, a signal does not end the process: the phase polls any_rank_interrupted() and ends by itself, with
/// its state saved. A signal that no poll has found ends the process when the last deferral does. May be nested.
class SignalDeferral
{
public:
  SignalDeferral();
  ~SignalDeferral();
  SignalDeferral(const SignalDeferral &) = delete;
  SignalDeferral &operator=(const SignalDeferral &) = delete;
};

/// Returns whether a signal has come to any rank. If so, the caller saves its state and ends the program, on all ranks:
/// from then on signals have no effect. Collective.
bool any_rank_interrupted();

/// Returns whether any_rank_interrupted() has been true: the run ends early. The same on all ranks.
bool interrupted();

/// Sets the action of the waiting thread before it ends the process: save the results so far, without MPI, while the
/// other threads continue. Its exceptions are printed.
void on_interruption(std::function<void()> action);

/// From here on signals have no effect: the exit code is decided. Does not return while a signal ends the process.
void disregard_signals();

/// After disregard_signals() and before another program takes the place of this one: blocks signals in this thread,
/// until that program handles them, also one that was disregarded.
void pass_signals_on();

/// Time steps of a lattice between two calls of any_rank_interrupted(): less than some milliseconds, or a few steps of
/// a large sheet.
inline constexpr std::size_t steps_between_signals = 16;

} // namespace latcon::commands
