#include <algorithm>
#include <functional>

#include "verification/input/case.h"

namespace latcon::input
{

void LoadingHistory::declare(Parameters &p)
{
  p.add("Loading", "history times", times, magnitude, "s",
        "increasing times after the start at which a motion of the lattice has the strains of the history; in between "
        "the edges move at a constant rate, after the last they stand; empty: they stand always")
    .read_by = ReadBy::claims_on_user_laws;
  for (std::vector<double> *strains : {&strain_x, &strain_y})
    p.add("Loading", strains == &strain_x ? "history strain x" : "history strain y", *strains,
          Range({-1., false}, {1000., true}), "1",
          std::string("engineering strain along ") + (strains == &strain_x ? "x" : "y") +
            " at each of the history times; empty: that of the loading")
      .read_by = ReadBy::claims_on_user_laws;
}

void LoadingHistory::check(Parameters &p) const
{
  for (const auto &[key, strains] :
       {std::pair("Loading/history strain x", &strain_x), std::pair("Loading/history strain y", &strain_y)})
    if (!strains->empty() && strains->size() != times.size())
      p.error(key,
              "one strain is needed for each of the " + std::to_string(times.size()) + " history times, not " +
                std::to_string(strains->size()),
              {"Loading/history times"});
  if (!std::is_sorted(times.begin(), times.end(), std::less_equal<>()))
    p.error("Loading/history times", "each time must be later than the one before");
  if (!times.empty() && strain_x.empty() && strain_y.empty())
    p.error("Loading/history times", "a history needs strains at its times; give `history strain x` or `y`",
            {"Loading/history strain x", "Loading/history strain y"});
}

std::vector<Eigen::Matrix2d> LoadingHistory::deformations(const Eigen::Matrix2d &start) const
{
  std::vector<Eigen::Matrix2d> found(times.size() + 1, start);
  for (std::size_t i = 0; i < std::min(strain_x.size(), times.size()); ++i)
    found[i + 1](0, 0) = 1. + strain_x[i];
  for (std::size_t i = 0; i < std::min(strain_y.size(), times.size()); ++i)
    found[i + 1](1, 1) = 1. + strain_y[i];
  return found;
}

void require_constant_loading(const Case &input, Parameters &p, const std::string &reason)
{
  if (!input.history.empty())
    p.error("Loading/history times", reason + "; give no times");
}

std::vector<lattice::Constraint> edge_constraints(const Case &input, const lattice::State &state,
                                                  const lattice::TriangularLattice &sheet)
{
  lattice::Constraint::Motion motion;
  if (!input.history.empty())
  {
    std::vector<double> times{0.};
    times.insert(times.end(), input.history.times.begin(), input.history.times.end());
    motion = lattice::piecewise_linear(std::move(times), input.history.deformations(input.deformation()));
  }
  std::vector<lattice::Constraint> constraints;
  if (motion)
    constraints.push_back({lattice::held_sites(state, sheet), true, true, motion});
  std::vector<std::pair<bool, bool>> fixed(sheet.n_places()); // along x and y; two rollers may share a corner
  for (std::size_t id = 0; id < 4; ++id)
  {
    const EdgeCase &edge = input.continuum.edges[id];
    if (!edge.is_roller())
      continue;
    lattice::Constraint roller{{}, edge.displacement.x != "free", edge.displacement.y != "free", motion};
    for (const std::size_t place : lattice::sites_at(sheet, input.material(), {id == 0, id == 1, id == 2, id == 3}))
    {
      bool &is_fixed = roller.along_x ? fixed[place].first : fixed[place].second;
      if (state.held[place] == 0 && state.removed[place] == 0 && !std::exchange(is_fixed, true))
        roller.sites.push_back(place);
    }
    constraints.push_back(std::move(roller));
  }
  return constraints;
}

} // namespace latcon::input
