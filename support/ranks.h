/// Collective operations on all ranks (MPI_COMM_WORLD).
#pragma once

#include <string>
#include <type_traits>

namespace latcon::support
{

/// Returns the rank of this process, 0 for the root rank.
[[nodiscard]] unsigned int rank();

/// Returns true on the root rank.
[[nodiscard]] inline bool is_root_rank()
{
  return rank() == 0;
}

/// Returns the number of ranks.
[[nodiscard]] unsigned int n_ranks();

/// Returns the largest of the values of all ranks. Collective.
[[nodiscard]] int largest_on_ranks(int value);

/// Returns the text of the root rank. Collective.
[[nodiscard]] std::string broadcast(const std::string &text);

/// Copies the bytes of the root rank to all ranks. Collective.
void broadcast_bytes(void *bytes, std::size_t count);

/// Returns the value of the root rank. Collective.
template <class Value>
[[nodiscard]] Value broadcast(Value value)
{
  static_assert(std::is_trivially_copyable_v<Value>);
  broadcast_bytes(&value, sizeof value);
  return value;
}

} // namespace latcon::support
