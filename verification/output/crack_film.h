#pragma once

#include <filesystem>

#include "lattice/simulation.h"
#include "verification/input/case.h"
#include "verification/output/crack_record.h"
#include "verification/output/motion_writer.h"

namespace latcon::output
{

/// Light frames of a crack for animations, evenly spread over the way of its tip. On every rank alike; the first
/// writes.
class CrackFilm
{
public:
  /// The simulation and the record of its crack must outlive this object.
  /// @param seed_tip_X where the crack starts [m]; its way ends at the stop position
  CrackFilm(const input::Case &input, lattice::Simulation &simulation, const CrackRecord &record, double seed_tip_X,
            std::filesystem::path directory);

  /// Writes the first frame, or, of a run that goes on from a checkpoint, takes back what was written after that.
  /// Collective. @throws support::OutputError if a file cannot be written, as the others do
  void begin(bool resumed);

  /// Adds a frame if the tip has come to where the next one is due. Collective.
  void step();

  /// Adds the last frame. Collective.
  void end() { add_frame(); }

  /// Saves or loads which frames there are; see lattice::Simulation. The record of the crack is loaded before.
  /// @throws std::invalid_argument unless they are those for which the way of the tip calls
  template <class Archive>
  void archive(Archive &archive)
  {
    const double first = next_frame_;
    archive("frames", frames_);
    archive("next_frame", next_frame_);
    if constexpr (Archive::loads)
      check_loaded(first);
  }

private:
  void check_loaded(double first) const;
  double due_beyond(double tip_X, double due) const;
  void add_frame();

  lattice::Simulation &simulation_;
  const CrackRecord &record_;
  MotionWriter frames_;
  bool wanted_;
  double pitch_;      // of the tip between frames [m]
  double next_frame_; // X of the tip [m]
};

} // namespace latcon::output
