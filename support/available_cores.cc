#include "support/available_cores.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <vector>

#include <mpi.h>
#include <omp.h>
#include <sched.h>

#include "support/control_groups.h"

namespace latcon::support
{
namespace
{

constexpr std::size_t max_cores = 8192; // largest number that Linux can be configured for

// Returns a byte per hardware thread, 1 if this process may run on it; all 0 if the system does not report it.
std::vector<std::uint8_t> allowed_cores()
{
  cpu_set_t *const set = CPU_ALLOC(max_cores);
  const std::size_t size = CPU_ALLOC_SIZE(max_cores);
  std::vector<std::uint8_t> allowed(max_cores, 0);
  if (set != nullptr && sched_getaffinity(0, size, set) == 0)
    for (std::size_t core = 0; core < max_cores; ++core)
      allowed[core] = CPU_ISSET_S(core, size, set) ? 1 : 0;
  CPU_FREE(set);
  return allowed;
}

unsigned int number_of(const std::vector<std::uint8_t> &cores)
{
  return static_cast<unsigned int>(std::count(cores.begin(), cores.end(), 1));
}

// Processor time that a control group may take, in units of one core.
double quota_of(const std::filesystem::path &group, int version)
{
  double quota = 0., period = 0.;
  if (version == 2)
    std::ifstream(group / "cpu.max") >> quota >> period; // "max PERIOD": no limit, and no number
  else
  {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota; // -1: no limit
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0. && period > 0. ? quota / period : std::numeric_limits<double>::infinity();
}

// The whole cores of a quota, at least 1: more threads than that wait for each other.
unsigned int limited(unsigned int cores, double quota)
{
  return quota < cores ? std::max(1u, static_cast<unsigned int>(quota)) : cores;
}

} // namespace

double processor_quota(const std::filesystem::path &root)
{
  double quota = std::numeric_limits<double>::infinity();
  for_each_control_group(root, "cpu",
                         [&quota](const std::filesystem::path &group, int version)
                         { quota = std::min(quota, quota_of(group, version)); });
  return quota;
}

unsigned int available_cores()
{
  // With OMP_PROC_BIND the main thread is bound to one core before main; omp_get_num_procs() gives the original number.
  return limited(std::max({1u, number_of(allowed_cores()), static_cast<unsigned int>(omp_get_num_procs())}),
                 processor_quota());
}

unsigned int available_cores_per_rank()
{
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int n_ranks = 1;
  MPI_Comm_size(machine, &n_ranks);
  std::vector<std::uint8_t> cores = allowed_cores();
  MPI_Allreduce(MPI_IN_PLACE, cores.data(), static_cast<int>(cores.size()), MPI_UINT8_T, MPI_MAX, machine);
  unsigned int n_cores = available_cores();
  MPI_Allreduce(MPI_IN_PLACE, &n_cores, 1, MPI_UNSIGNED, MPI_MAX, machine);
  MPI_Comm_free(&machine);
  n_cores = limited(std::max(n_cores, number_of(cores)), processor_quota());
  return std::max(1u, n_cores / static_cast<unsigned int>(n_ranks));
}

} // namespace latcon::support
