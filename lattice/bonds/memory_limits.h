#pragma once

#include <cstddef>

namespace latcon::lattice
{

/// Most history variables that a memory may have per bond.
inline constexpr std::size_t max_history_variables = 16;

} // namespace latcon::lattice
