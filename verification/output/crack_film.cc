#include "verification/output/crack_film.h"

#include <algorithm>
#include <vector>

namespace latcon::output
{

CrackFilm::CrackFilm(const input::Case &input, lattice::Simulation &simulation, const CrackRecord &record,
                     double seed_tip_X, std::filesystem::path directory, support::TaskThread &writing)
  : simulation_(simulation), record_(record), writing_(writing),
    frames_(std::make_shared<FieldWriter>(simulation.lattice(), simulation.material(), std::move(directory), "motion",
                                          FrameFields::motion)),
    is_enabled_(input.motion_frames > 0),
    pitch_((input.stop_position * simulation.lattice().length() - seed_tip_X) / std::max(1u, input.motion_frames)),
    next_frame_(seed_tip_X + pitch_)
{
}

void CrackFilm::begin(bool resumed)
{
  if (!resumed)
  {
    add_frame();
    pass(record_.tip().X());
  }
  else if (is_enabled_ && simulation_.band().is_first())
    frames_->write_collection();
}

void CrackFilm::end()
{
  add_frame();
  writing_.wait();
}

void CrackFilm::step()
{
  if (record_.tip().X() < next_frame_)
    return;
  add_frame();
  pass(record_.tip().X());
}

// The next frame is due after the tip has passed tip_X [m].
void CrackFilm::pass(double tip_X)
{
  while (tip_X >= next_frame_)
    next_frame_ += pitch_;
}

// Finds the frame that is next after those of a loaded record.
void CrackFilm::follow_record()
{
  std::vector<double> times{0.};
  for (const analysis::TipRecord &tip : record_.tip().records())
    if (tip.X >= next_frame_)
    {
      if (tip.t > 0.)
        times.push_back(tip.t);
      pass(tip.X);
    }
  if (is_enabled_)
    support::require(frames_->times() == times, "`times` of frames do not match the record of the tip");
}

void CrackFilm::add_frame()
{
  if (!is_enabled_)
    return;
  const lattice::State &whole = simulation_.gather();
  if (simulation_.band().is_first())
    writing_.add([frames = frames_, state = std::make_shared<const lattice::State>(whole)]
                 { frames->add_frame(*state); });
}

} // namespace latcon::output
