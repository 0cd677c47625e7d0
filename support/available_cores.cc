#include "support/available_cores.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <mpi.h>
#include <omp.h>
#include <sched.h>

namespace latcon::support
{
namespace
{

constexpr std::size_t most_cores = 8192; // that Linux can be configured for

// A byte for each hardware thread: 1 if this process may run on it, none if the system does not say.
std::vector<std::uint8_t> allowed_cores()
{
  cpu_set_t *const set = CPU_ALLOC(most_cores);
  const std::size_t size = CPU_ALLOC_SIZE(most_cores);
  std::vector<std::uint8_t> allowed(most_cores, 0);
  if (set != nullptr && sched_getaffinity(0, size, set) == 0)
    for (std::size_t core = 0; core < most_cores; ++core)
      allowed[core] = CPU_ISSET_S(core, size, set) ? 1 : 0;
  CPU_FREE(set);
  return allowed;
}

unsigned int number_of(const std::vector<std::uint8_t> &cores)
{
  return static_cast<unsigned int>(std::count(cores.begin(), cores.end(), 1));
}

} // namespace

unsigned int available_cores()
{
  // With OMP_PROC_BIND the first thread is bound to one core before main; OpenMP then knows how many there were.
  return std::max({1u, number_of(allowed_cores()), static_cast<unsigned int>(omp_get_num_procs())});
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
  return std::max(1u, std::max(n_cores, number_of(cores)) / static_cast<unsigned int>(n_ranks));
}

} // namespace latcon::support
