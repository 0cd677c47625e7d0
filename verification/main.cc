#include "support/errors.h"
#include "support/mpi_session.h"
#include "verification/commands/command_line.h"
#include "verification/commands/signals.h"
#include "verification/elements/elements.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <unistd.h>

// Lets the threads of OpenMP sleep after they have waited for a fifth of a millisecond. By default they wait busily for
// up to milliseconds, which takes the cores from the threads that they wait for wherever other programs run. Asks for
// memory in huge pages too, unless GLIBC_TUNABLES is set: equilibria of finite elements fill matrices for the first
// time, and are 6 % faster where the kernel gives such pages only to programs that ask. Both are read from the
// environment while libraries are loaded, so the program starts anew, once. Does nothing where OMP_WAIT_POLICY or
// GOMP_SPINCOUNT is set, or where the program cannot start anew.
static void let_waiting_threads_sleep(char **arguments)
{
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr)
    return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  // 0.2 ms, which 99 % of what one thread does alone between two loops takes less than; see also DynamicThreads.
  if (!error && setenv("GOMP_SPINCOUNT", "20000", 1) == 0 && setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0) == 0)
    execv(program.c_str(), arguments);
}

int main(int argc, char **argv)
{
  // Options may come before the command.
  constexpr std::string_view with_threads[] = {"verify", "lattice", "continuum", "fracture", "gate"};
  if (std::find_first_of(argv + 1, argv + argc, std::begin(with_threads), std::end(with_threads)) != argv + argc)
    let_waiting_threads_sleep(argv);
  latcon::commands::occupy_closed_streams();
  try
  {
    latcon::commands::install_signal_handlers();
    const latcon::support::MpiSession mpi;
    const latcon::support::ExitCode exit_code = latcon::commands::run_program(argc, argv);
    latcon::elements::finish();
    return static_cast<int>(exit_code);
  }
  catch (const std::exception &error) // of the start, such as no further thread under `ulimit -u`
  {
    std::fprintf(stderr, "latcon: cannot start: %s\n", error.what());
    return static_cast<int>(latcon::support::ExitCode::internal_error);
  }
}
