#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lattice/archive_rows.h"

class vtkPolyData;

namespace latcon::output
{

/// Time series of frames of a sheet for ParaView: `NAME.pvd`, and a file `NAME-NNNN.vtp` per frame, in one directory.
/// Every file is replaced atomically.
class FrameSeries
{
public:
  FrameSeries(std::filesystem::path directory, std::string name);

  /// Adds a frame and stores the time in it (TimeValue); replaces the last frame if it has the same time.
  /// @param time [s] @throws support::OutputError if a file cannot be written
  void add(vtkPolyData &frame, double time);

  /// Writes `NAME.pvd` with the current list of frames. @throws support::OutputError
  void write_collection() const;

  std::size_t n_frames() const { return times_.size(); }

  /// Returns the times of the frames [s].
  const std::vector<double> &times() const { return times_; }

  /// Saves or loads the list of frames; see Simulation. @throws std::invalid_argument if their times do not increase
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("times", times_);
    if constexpr (Archive::loads)
      lattice::require_archived(std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) ==
                                    times_.end() &&
                                  (times_.empty() || times_.front() >= 0.),
                                "`times` of frames do not increase from 0");
  }

private:
  std::string file_name(std::size_t frame) const;

  std::filesystem::path directory_;
  std::string name_;
  std::vector<double> times_; // of the frames [s]
};

} // namespace latcon::output
