#pragma once

#include <cstdint>

namespace latcon::lattice
{

/// SplitMix64 (Steele, Lea, Flood 2014) as a counter-based generator: random bits as a function of a counter, so that
/// no order of sites or bonds is implied.
inline std::uint64_t splitmix64(std::uint64_t counter)
{
  std::uint64_t z = counter + 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Uniform in [-1, 1), from the upper 53 bits.
inline double symmetric_uniform(std::uint64_t bits)
{
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1.;
}

} // namespace latcon::lattice
