#include "verification/fracture/crack_film.h"

#include <algorithm>

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

void CrackFilm::add_frame()
{
  if (!wanted_)
    return;
  const lattice::State &whole = simulation_.gather();
  if (simulation_.band().is_first())
    frames_.add_frame(whole);
}

} // namespace verification
