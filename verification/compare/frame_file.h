/// Selection of a frame: a file, a frame of a series, or a frame in an output directory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace latcon::compare
{

/// Side of a comparison.
enum class Side
{
  lattice,
  continuum
};

/// Returns "lattice" or "continuum".
std::string to_string(Side side);

/// File of a frame, with data from its series.
struct FrameFile
{
  std::filesystem::path path;
  std::optional<double> time; ///< time in the series [s], or load factor [-]; empty for a file given directly
  std::vector<double> times;  ///< times of all frames of the series
  bool chosen = false;        ///< true if the user gave the time
};

/// Tolerance for equal times, relative to the larger one. Times are sums of time steps: the round-off of a million of
/// them is below half of 1e6 times 2^-52, which is 1.1e-10.
inline constexpr double time_tolerance = 1e-9;

/// Returns true if two times [s], or load factors [-], are equal to time_tolerance.
bool is_same_time(double one, double other);

/// Finds the frame given by an argument of the command line.
/// @param name frame (.vtp of the lattice; .vtu or .pvtu of the continuum), series (.pvd), or output directory of a
/// run, which means its lattice.pvd or continuum.pvd
/// @param time required time [s], or load factor [-]; none: last frame of a series. For a file given directly, the
/// reader of the file compares the time.
/// @throws InputError if the file does not exist or is of the other side, if a series cannot be read, is empty or has
/// several files at that time, or if it has no frame at that time; the message lists the nearest times
FrameFile find_frame(const std::string &name, Side side, std::optional<double> time);

/// Formats times for a message: "0, 0.5, 1"; abbreviates long lists.
std::string list_of_times(const std::vector<double> &times);

} // namespace latcon::compare
