#pragma once

#include "lattice/state.h"
#include "verification/output/frame_series.h"

namespace latcon::output
{

/// Writes frames with displacement and velocity only, for animations; a tenth of the size of the frames of FieldWriter.
/// `motion.pvd`, and a file `motion-NNNN.vtp` per frame, in one directory.
///
/// Points are the sites at their reference positions [m], in the order of FieldWriter, each a vertex; warp by
/// `displacement` for the current ones. Point data: displacement [m], velocity [m/s]. All in single precision.
class MotionWriter
{
public:
  /// Creates a writer. The lattice must outlive this object.
  MotionWriter(const lattice::TriangularLattice &lattice, std::filesystem::path directory);

  /// Adds the state as the next frame; replaces the last frame if it has the same time. @throws support::OutputError if
  /// a file cannot be written
  void add_frame(const lattice::State &state);

  /// Writes `motion.pvd` with the current list of frames. @throws support::OutputError
  void write_collection() const { series_.write_collection(); }

  /// Returns the times of the frames [s].
  const std::vector<double> &times() const { return series_.times(); }

  /// Saves or loads the list of frames; see Simulation.
  template <class Archive>
  void archive(Archive &archive)
  {
    series_.archive(archive);
  }

private:
  const lattice::TriangularLattice &lattice_;
  FrameSeries series_;
};

} // namespace latcon::output
