/// Which file of a run is meant: a frame itself, one of a series, or one of those in an output directory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace latcon::compare
{

/// Whose frame it is.
enum class Side
{
  lattice,
  continuum
};

/// "lattice" or "continuum".
std::string to_string(Side side);

/// A file with one frame, and what the series says about it.
struct FrameFile
{
  std::filesystem::path path;
  std::optional<double> time; ///< of the series [s], or load factor [-]; empty for a file given by itself
  std::vector<double> times;  ///< of all frames of the series
  bool chosen = false;        ///< whether its time was asked for
};

/// How far two times may be apart, relative to the larger, to be the same. Times are sums of time steps: the round-off
/// of a million of them is below half of 1e6 times 2^-52, which is 1.1e-10.
inline constexpr double time_tolerance = 1e-9;

/// Whether two times [s], or load factors [-], are the same to time_tolerance.
bool same_time(double one, double other);

/// Finds the frame that an argument of the command line names.
/// @param name a frame (.vtp of the lattice; .vtu or .pvtu of the continuum), a series (.pvd), or the output directory
/// of a run, which stands for its lattice.pvd or continuum.pvd
/// @param time of the frame wanted [s], or load factor [-]; none: the last of a series. Of a file given by itself it is
/// left to the reader of the file to compare.
/// @throws InputError if there is no such file, if it is of the other side, if a series cannot be read or is empty or
/// has several files at that time, or if it has no frame at that time, naming the nearest
FrameFile find_frame(const std::string &name, Side side, std::optional<double> time);

/// Times for a message: "0, 0.5, 1", the middle left out of long lists.
std::string list_of_times(const std::vector<double> &times);

} // namespace latcon::compare
