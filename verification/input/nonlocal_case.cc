#include <algorithm>
#include <stdexcept>

#include "verification/input/case.h"

namespace latcon::input
{

void NonlocalCase::declare(Parameters &p)
{
  p.add("Nonlocal", "grid", grid,
        {{"square", lattice::Grid::Kind::square}, {"triangular", lattice::Grid::Kind::triangular}},
        "grid of the points of the nonlocal continuum that `latcon fracture --side continuum` breaks; its rows have the "
        "orientation of the lattice's");
  p.add(
    "Nonlocal", "refinement", refinement, Range{1., 20.}, "1",
    "m: spacing of the lattice over that of the grid; bonds keep the lengths of the lattice's shells, up to a spacing "
    "of the grid; a point has at most 127 pairs of opposite ones");
  p.add("Nonlocal", "half width", half_width, Range{0., 0.5236}, "rad",
        "bonds leave points within this angle of the lattice's six directions in each shell: 0 rad: in these alone; 30 "
        "deg: in all directions");
  p.add(
    "Nonlocal", "scatter", scatter, Range{0., 0.5}, "1",
    "points are displaced from the grid at random by up to this share of its spacing along x and along y, from `noise "
    "seed`; 0: a grid; 0.5: without any long-range order");
}

void NonlocalCase::check(const Case &input, Parameters &p) const
{
  if (!is_used)
    return;
  const auto refuse_scatter = [&](bool is_refused, const std::string &entry, const std::string &give)
  {
    if (scatter > 0. && is_refused)
      p.error(entry, "scattered points do not support this; give " + give + ", or Nonlocal/scatter = 0",
              {"Nonlocal/scatter"});
  };
  refuse_scatter(half_width < M_PI / 6. * (1. - 1e-4), "Nonlocal/half width", "30 deg");
  refuse_scatter(input.left_end == Case::End::free, "Fracture/left end", "held");
  refuse_scatter(input.right_end == Case::End::free, "Fracture/right end", "held");
  refuse_scatter(input.toughening == Case::Toughening::retraction, "Fracture/toughening", "behind-tip or none");
  refuse_scatter(input.breaking.needs_energy(), "Fracture/rule", "critical-stretch or rate-stretch");
  if (input.has_sheet())
    try
    {
      (void)sheet(input);
    }
    catch (const std::invalid_argument &problem)
    {
      p.error("Nonlocal/refinement", problem.what(),
              {"Nonlocal/grid", "Nonlocal/half width", "Nonlocal/scatter", "Sheet/spacing", "Sheet/orientation"});
    }
  for (const auto &[name, end] : {std::pair("left end", input.left_end), std::pair("right end", input.right_end)})
    if (end == Case::End::absorbing)
      p.error(std::string("Fracture/") + name, "an end of the nonlocal continuum does not absorb; give held or free");
  if (input.seed_shape == Case::SeedShape::slit && input.seed_height > 0.)
    p.error("Fracture/seed height", "the seed crack of the nonlocal continuum is a cut without height; give 0",
            {"Fracture/seed shape"});
}

lattice::TriangularLattice NonlocalCase::sheet(const Case &input) const
{
  if (scatter == 0.)
    return new_sheet(input);
  constexpr int half = 32; // of the bits of a seed, each of which a double holds
  const std::vector<double> made_of{double(input.noise_seed >> half),
                                    double(static_cast<std::uint32_t>(input.noise_seed)),
                                    scatter,
                                    refinement,
                                    double(grid),
                                    double(input.orientation),
                                    input.spacing,
                                    input.length,
                                    input.height,
                                    double(input.has_next_nearest),
                                    double(input.has_third_nearest)};
  if (!last_ || last_->first != made_of)
    last_ =
      std::make_shared<const std::pair<std::vector<double>, lattice::TriangularLattice>>(made_of, new_sheet(input));
  return last_->second;
}

lattice::TriangularLattice NonlocalCase::new_sheet(const Case &input) const
{
  const lattice::Grid points{grid, input.spacing / refinement, input.orientation, {scatter, input.noise_seed}};
  std::vector<lattice::Ring> rings =
    lattice::lattice_rings(input.spacing, input.orientation, std::min(half_width, M_PI / 6.));
  rings.push_back({2. * input.spacing, rings[0].direction, 2, rings[0].half_width});
  rings.erase(std::remove_if(rings.begin(), rings.end(),
                             [&](const lattice::Ring &ring) { return !input.has_shell(ring.shell); }),
              rings.end());
  return {points, lattice::ring_stencil(points, rings), input.spacing, input.length, input.height};
}

} // namespace latcon::input
