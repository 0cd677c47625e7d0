// Times of messages between two MPI ranks, as JSON: what the cost of a halo is estimated from.
#include <algorithm>
#include <iostream>
#include <limits>
#include <vector>

#include <mpi.h>
#include <nlohmann/json.hpp>

namespace
{

// Shortest mean time [s] of a call, of `n_rounds` rounds of `n_calls` calls each.
template <class Call>
double seconds(const Call &call, int n_calls, int n_rounds = 20)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (int round = 0; round < n_rounds; ++round)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    const double start = MPI_Wtime();
    for (int i = 0; i < n_calls; ++i)
      call();
    shortest = std::min(shortest, (MPI_Wtime() - start) / n_calls);
  }
  return shortest;
}

// Both ranks send and receive at once, as neighbours do that exchange their edge rows.
double exchange(int n_bytes)
{
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::vector<char> sent(static_cast<std::size_t>(n_bytes)), received(sent.size());
  const auto call = [&]
  {
    MPI_Sendrecv(sent.data(), n_bytes, MPI_CHAR, 1 - rank, 0, received.data(), n_bytes, MPI_CHAR, 1 - rank, 0,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  };
  return seconds(call, std::clamp(4'000'000 / n_bytes, 4, 1000));
}

double allreduce()
{
  double value = 1., sum = 0.;
  return seconds([&] { MPI_Allreduce(&value, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD); }, 1000);
}

} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int rank = 0, n_ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks != 2)
  {
    std::cerr << "messages: to be run on two ranks\n";
    MPI_Finalize();
    return 2;
  }
  nlohmann::ordered_json exchanges = nlohmann::ordered_json::array();
  for (int n_bytes = 8; n_bytes <= 1 << 23; n_bytes *= 4)
    exchanges.push_back({{"bytes", n_bytes}, {"seconds", exchange(n_bytes)}});
  const double reduction = allreduce();
  if (rank == 0)
    std::cout << nlohmann::ordered_json{{"exchanges", exchanges}, {"allreduce_seconds", reduction}}.dump() << "\n";
  MPI_Finalize();
  return 0;
}
