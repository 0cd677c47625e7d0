#include "verification/fracture/crack_film.h"

#include <algorithm>
#include <cmath>

namespace verification
{

CrackFilm::CrackFilm(const Case &input, lattice::Simulation &simulation, double seed_tip_X,
                     std::filesystem::path directory)
  : simulation_(simulation), frames_(simulation.lattice(), std::move(directory)), wanted_(input.motion_frames > 0),
    pitch_((input.stop_position * simulation.lattice().length() - seed_tip_X) / std::max(1u, input.motion_frames)),
    next_frame_(seed_tip_X + pitch_)
{
}

void CrackFilm::begin(bool resumed)
{
  if (!resumed)
    add_frame();
  else if (wanted_ && simulation_.band().is_first())
    frames_.write_collection();
}

void CrackFilm::step(double tip_X)
{
  if (tip_X < next_frame_)
    return;
  add_frame();
  while (tip_X >= next_frame_)
    next_frame_ += pitch_;
}

// The next frame is the first that the tip has yet to reach. @param first of all [m]
void CrackFilm::check_loaded(double first) const
{
  const std::optional<std::size_t> tip = simulation_.tip();
  const double tip_X = tip ? simulation_.lattice().reference(*tip).x() : 0.;
  const double rounding = 1e-9 * std::abs(pitch_);
  lattice::require_archived(next_frame_ == first ||
                              (next_frame_ > std::max(tip_X, first) && next_frame_ <= tip_X + pitch_ + rounding),
                            "`next_frame` is not the first that is due");
}

void CrackFilm::add_frame()
{
  if (!wanted_)
    return;
  const lattice::State &whole = simulation_.gather();
  if (simulation_.band().is_first())
    frames_.add_frame(whole);
}

} // namespace verification
