#include "verification/commands/signals.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <semaphore.h>
#include <mpi.h>
#include <unistd.h>

#include "support/errors.h"
#include "support/ranks.h"

namespace latcon::commands
{
namespace
{

constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU};

std::atomic<int> pending{0}; // the last signal that came; 0: none
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");
sem_t wake;

// Held by the waiting thread from its decision to end the process until the end.
std::mutex decision;
std::condition_variable deferral_ended;
std::size_t n_deferrals = 0;
bool is_disregarded = false; // the main thread ends the program by itself
std::function<void()> final_action;

void on_signal(int signal)
{
  const int kept = errno;
  pending = signal;
  sem_post(&wake);
  errno = kept;
}

void say(const std::string &text)
{
  // The stream of the main thread may be in any state. There is no better place for an error.
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

// Blocks all signals in this thread. @return those that were blocked before
sigset_t block_signals()
{
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  return before;
}

[[noreturn]] void end_process()
{
  constexpr int status = static_cast<int>(support::ExitCode::interrupted);
  try
  {
    if (final_action)
      final_action();
  }
  catch (const std::exception &error)
  {
    say(std::string("latcon: ") + error.what() + "\n");
  }
  const char *const name = sigabbrev_np(pending);
  say("latcon: interrupted by SIG" + std::string(name != nullptr ? name : "?") + "\n");
  int initialized = 0, finalized = 0;
  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  if (initialized != 0 && finalized == 0 && support::n_ranks() > 1)
    MPI_Abort(MPI_COMM_WORLD, status); // the other ranks would wait for this one
  std::_Exit(status);
}

void wait_for_signals()
{
  while (true)
  {
    while (sem_wait(&wake) != 0)
      ;
    std::unique_lock lock(decision);
    deferral_ended.wait(lock, [] { return n_deferrals == 0 || is_disregarded; });
    if (!is_disregarded)
      end_process();
  }
}

} // namespace

void occupy_closed_streams()
{
  // open() takes the lowest free number.
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (fcntl(stream, F_GETFD) == -1)
      (void)open("/dev/null", O_RDONLY);
}

void install_signal_handlers()
{
  if (sem_init(&wake, 0, 0) != 0)
    throw std::system_error(errno, std::generic_category(), "sem_init");
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  is_disregarded = false; // where the process has ended another program before
  // The main thread alone receives signals, so that pass_signals_on() keeps them all.
  const sigset_t before = block_signals();
  std::thread(wait_for_signals).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  for (const int signal : ending_signals)
  {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (signal == SIGHUP && action.sa_handler == SIG_IGN)
      continue;
    action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

SignalDeferral::SignalDeferral()
{
  const std::lock_guard lock(decision);
  ++n_deferrals;
}

SignalDeferral::~SignalDeferral()
{
  const std::lock_guard lock(decision);
  --n_deferrals;
  deferral_ended.notify_one();
}

bool any_rank_interrupted()
{
  const int signal = pending; // one that comes from here on is found by the next call
  const bool any = support::largest_on_ranks(signal != 0 ? 1 : 0) != 0;
  if (any)
    disregard_signals();
  return any;
}

bool interrupted()
{
  const std::lock_guard lock(decision);
  return is_disregarded;
}

void on_interruption(std::function<void()> action)
{
  const std::lock_guard lock(decision);
  final_action = std::move(action);
}

void disregard_signals()
{
  const std::lock_guard lock(decision);
  is_disregarded = true;
  final_action = nullptr;
  deferral_ended.notify_one();
}

void pass_signals_on()
{
  block_signals();
  if (const int signal = pending)
    raise(signal);
}

} // namespace latcon::commands
