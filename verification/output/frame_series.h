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

/// Frames of one sheet over time, for ParaView: `NAME.pvd` and a file `NAME-NNNN.vtp` a frame, in one directory. Every
/// file is written beside its place and renamed.
class FrameSeries
{
public:
  FrameSeries(std::filesystem::path directory, std::string name);

  /// Adds a frame, in the place of the last one if that is of the same time, and notes the time in it (TimeValue).
  /// @param time [s] @throws support::OutputError if a file cannot be written
  void add(vtkPolyData &frame, double time);

  /// Writes `NAME.pvd`, so that it names the frames there are. @throws support::OutputError
  void write_collection() const;

  std::size_t n_frames() const { return times_.size(); }

  /// Of the frames, in their order [s].
  const std::vector<double> &times() const { return times_; }

  /// Saves or loads which frames there are; see Simulation. @throws std::invalid_argument if their times do not grow
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("times", times_);
    if constexpr (Archive::loads)
      lattice::require_archived(std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) ==
                                    times_.end() &&
                                  (times_.empty() || times_.front() >= 0.),
                                "`times` of frames do not grow from 0 on");
  }

private:
  std::string file_name(std::size_t frame) const;

  std::filesystem::path directory_;
  std::string name_;
  std::vector<double> times_; // of the frames [s]
};

} // namespace latcon::output
