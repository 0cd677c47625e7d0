#include "support/ranks.h"

#include <algorithm>
#include <climits>

#include <mpi.h>

namespace latcon::support
{

unsigned int rank()
{
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return static_cast<unsigned int>(rank);
}

unsigned int n_ranks()
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return static_cast<unsigned int>(ranks);
}

int largest_on_ranks(int value)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return value;
}

std::string broadcast(const std::string &text)
{
  std::string shared(broadcast(text.size()), '\0');
  if (is_root_rank())
    shared = text;
  broadcast_bytes(shared.data(), shared.size());
  return shared;
}

void broadcast_bytes(void *bytes, std::size_t count)
{
  // MPI counts in int.
  for (auto *next = static_cast<char *>(bytes); count > 0;)
  {
    const std::size_t part = std::min(count, static_cast<std::size_t>(INT_MAX));
    MPI_Bcast(next, static_cast<int>(part), MPI_BYTE, 0, MPI_COMM_WORLD);
    next += part;
    count -= part;
  }
}

} // namespace latcon::support
