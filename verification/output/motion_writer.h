#pragma once

#include "lattice/state.h"
#include "verification/output/frame_series.h"

namespace latcon::output
{

/// Writes where the sites are and how they move, and nothing else: frames of a tenth of the size of FieldWriter's, for
/// animations. `motion.pvd` and a file `motion-NNNN.vtp` a frame, in one directory.
///
/// Points are the sites at their reference positions [m], in the order of FieldWriter's, each a vertex; warp by
/// `displacement` for the current ones. Point data: displacement [m], velocity [m/s]. All in single precision.
class MotionWriter
{
public:
  /// The lattice must outlive this object.
  MotionWriter(const lattice::TriangularLattice &lattice, std::filesystem::path directory);

  /// Adds the state as the next frame, in the place of the last one if that is of the same time. @throws
  /// support::OutputError if a file cannot be written
  void add_frame(const lattice::State &state);

  /// Writes `motion.pvd`, so that it names the frames there are. @throws support::OutputError
  void write_collection() const { series_.write_collection(); }

  /// Of the frames, in their order [s].
  const std::vector<double> &times() const { return series_.times(); }

  /// Saves or loads which frames there are; see Simulation.
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
