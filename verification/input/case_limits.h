/// Limits of entries that are both declared and checked.
#pragma once

namespace latcon::input
{

/// More spacings along an edge exceed any sheet of rubber, and the integers of some indices.
inline constexpr double most_spacings = 1e6;
/// More force evaluations per step gain nothing: the stable step grows as their square, limited by accuracy.
inline constexpr unsigned int most_stages = 200;

} // namespace latcon::input
