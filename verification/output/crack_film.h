#pragma once

#include <filesystem>
#include <memory>

#include "lattice/simulation.h"
#include "support/task_thread.h"
#include "verification/input/case.h"
#include "verification/output/crack_record.h"
#include "verification/output/field_writer.h"

namespace latcon::output
{

/// Small frames of a crack for animations, at equal distances of its tip. All ranks call it, the root rank writes.
class CrackFilm
{
public:
  /// Creates a film. The simulation and the record of its crack must outlive this object.
  /// @param seed_tip_X reference X of the tip of the seed [m]; the film ends at the stop position
  /// @param writing thread that writes the frames
  CrackFilm(const input::Case &input, lattice::Simulation &simulation, const CrackRecord &record, double seed_tip_X,
            std::filesystem::path directory, support::TaskThread &writing);

  /// Adds the first frame or, in a resumed run, discards the frames after the checkpoint. Collective. @throws
  /// support::OutputError if a file cannot be written, as do step() and end(), of this frame or of an earlier one
  void begin(bool resumed);

  /// Adds a frame if the tip has reached the position of the next one. Collective.
  void step();

  /// Adds the last frame and waits until all are written. Collective.
  void end();

  /// Saves or loads the list of frames; see lattice::Simulation. The record of the crack must be loaded first.
  /// @throws std::invalid_argument if the frames do not match the record of the tip
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("frames", *frames_);
    if constexpr (Archive::loads)
      follow_record();
  }

private:
  void follow_record();
  void pass(double tip_X);
  void add_frame();

  lattice::Simulation &simulation_;
  const CrackRecord &record_;
  support::TaskThread &writing_;
  std::shared_ptr<FieldWriter> frames_; // also of the tasks that are pending
  bool is_enabled_;
  double pitch_;      // advance of the tip between frames [m]
  double next_frame_; // X of the tip at the next frame [m]
};

} // namespace latcon::output
