#include "verification/claims/nonlocal/nonlocal_claim.h"

#include <cmath>
#include <utility>

#include "lattice/forces.h"
#include "lattice/seed.h"
#include "lattice/simulation.h"

namespace latcon::claims
{

StencilSheet::StencilSheet(const bridge::Subject &subject, const lattice::Grid &grid,
                           std::vector<lattice::HalfBond> half_bonds)
  : material_(lattice::without_dashpots(subject.material)), half_bonds_(std::move(half_bonds)),
    sheet_(grid, half_bonds_, subject.spacing, 12. * subject.spacing, 12. * subject.spacing)
{
}

Eigen::Matrix2d StencilSheet::wave_stiffness(const Eigen::Matrix2d &F, const Eigen::Vector2d &K) const
{
  const lattice::State at_rest = lattice::homogeneous_state(sheet_, material_, F, lattice::Edges::free);
  const std::size_t crest = sheet_.index(2 * (sheet_.rows() / 4), sheet_.columns() / 2);
  const double amplitude = 1e-5 / K.norm();
  lattice::Forces forces(sheet_, material_);
  const auto force = [&](const Eigen::Vector2d &displacement)
  {
    lattice::State state = at_rest;
    for (std::size_t row = 0; row < sheet_.rows(); ++row)
      for (std::size_t column = 0; column < sheet_.sites_in_row(row); ++column)
      {
        const std::size_t place = sheet_.index(row, column);
        const double phase = std::cos(K.dot(sheet_.reference(place) - sheet_.reference(crest)));
        state.x[place] += phase * displacement.x();
        state.y[place] += phase * displacement.y();
      }
    forces.evaluate(state, state.vx, state.vy);
    return Eigen::Vector2d(forces.fx()[crest], forces.fy()[crest]);
  };
  Eigen::Matrix2d stiffness;
  for (int i = 0; i < 2; ++i)
  {
    const Eigen::Vector2d p = amplitude * Eigen::Vector2d::Unit(i);
    stiffness.col(i) = (force(-p) - force(p)) / (2. * amplitude * lattice::site_mass(material_, sheet_));
  }
  return stiffness;
}

StencilSheet::Cut StencilSheet::cut(double stretch) const
{
  const Eigen::Matrix2d F = stretch * Eigen::Matrix2d::Identity();
  lattice::Simulation cut(sheet_, material_, lattice::homogeneous_state(sheet_, material_, F, lattice::Edges::held),
                          lattice::TimeStepping(1.),
                          lattice::Fracture(sheet_, material_, 1.5 * stretch, lattice::NoToughening(), F));
  // Whole periods of the grid along x. The ends of the cut are off all points, and its line is between two of points.
  const lattice::Grid &grid = sheet_.grid();
  const double h = grid.spacing;
  const bool is_square = grid.kind == lattice::Grid::Kind::square;
  const double period =
    is_square || grid.orientation == lattice::Orientation::rows_along_crack ? h : std::sqrt(3.) * h;
  const double length = std::floor(0.5 * sheet_.length() / period) * period;
  const double from = 0.25 * sheet_.length() + 0.013 * h;
  cut.cut_bonds(lattice::bonds_across(sheet_, from, from + length, 0.217 * h));
  return {cut.energies().broken / length, sheet_.reference(cut.tip().value()).x() - (from + length), period};
}

Eigen::Matrix2d StencilSheet::relaxed_stress(const lattice::Material &material, const Eigen::Matrix2d &F, double step,
                                             std::size_t n_steps) const
{
  lattice::Simulation held(sheet_, material, suddenly_strained(sheet_, material, F), lattice::TimeStepping(step));
  for (std::size_t i = 0; i < n_steps; ++i)
    held.step();
  return bridge::edge_stress(sheet_, material,
                             [&](std::size_t place)
                             { return held.forces().on_site(held.state(), held.state().vx, held.state().vy, place); });
}

} // namespace latcon::claims
