#include "verification/resources/resources.h"

#include <algorithm>
#include <cmath>

#include "continuum/linear_solver.h"
#include "continuum/meshes.h"
#include "support/errors.h"
#include "support/ranks.h"
#include "support/text_wrap.h"

namespace latcon::resources
{
namespace
{

constexpr double seconds_of_unknown_in_frame = 6e-6; // measured on one core of 3 to 4 GHz

// Unknowns are numbered by signed integers of 32 bits in Trilinos.
constexpr double max_unknowns = 2147483647.;

// Returns the number of entries per row of the tangent, averaged over the nodes of a mesh of squares: a node couples to
// all nodes of its cells, which are one, two or four for a node inside a cell, on an edge or at a corner; with face
// terms also to those of the neighbouring cells.
double entries_per_row(const unsigned int degree, const bool has_face_terms)
{
  const double p = degree;
  const double inside = (p - 1.) * (p - 1.), on_edges = 2. * (p - 1.);
  if (has_face_terms)
    return 2. *
           (inside * (5. * p * p + 6. * p + 1.) + on_edges * (8. * p * p + 8. * p + 1.) + 12. * p * p + 9. * p + 1.) /
           (p * p);
  return 2. * (inside * (p + 1.) * (p + 1.) + on_edges * (2. * p + 1.) * (p + 1.) + (2. * p + 1.) * (2. * p + 1.)) /
         (p * p);
}

bool is_direct(const input::Case &input, const double unknowns)
{
  const auto &edges = input.continuum.edges;
  return unknowns <= input.continuum.direct_limit || edges[0].condition == input::EdgeCase::Condition::periodic ||
         edges[2].condition == input::EdgeCase::Condition::periodic;
}

} // namespace

ContinuumSize continuum_size(const input::Case &input)
{
  const input::ContinuumCase &c = input.continuum;
  const lattice::TriangularLattice sheet = input.lattice();
  const double p = c.degree;
  double coarse_cells = 0., halvings = c.refinements;
  if (!c.mesh_file.empty())
    coarse_cells = continuum::n_coarse_cells(c.mesh_file);
  else if (input.hole_radius > 0.)
    coarse_cells = continuum::n_coarse_cells(
      continuum::RectangleWithHole{sheet.length(), sheet.height(), input.hole_radius, c.refinements});
  else if (input.notch_length > 0.)
    coarse_cells = continuum::n_coarse_cells(
      continuum::NotchedRectangle{sheet.length(), sheet.height(), input.notch_length, c.refinements});
  else
  {
    coarse_cells = static_cast<double>(c.cells_x) * static_cast<double>(c.cells_y);
    for (halvings = 0.;
         std::fmod(c.cells_x, std::exp2(halvings + 1.)) == 0. && std::fmod(c.cells_y, std::exp2(halvings + 1.)) == 0.;
         halvings += 1.)
      coarse_cells /= 4.;
  }
  // Unknowns of a square mesh with this number of cells.
  const auto unknowns = [p](double cells) { return 2. * (p * p * cells + 2. * p * std::sqrt(cells) + 1.); };
  ContinuumSize size;
  size.cells = coarse_cells * std::pow(4., halvings);
  size.unknowns = unknowns(size.cells);
  // Each refined cell adds three cells.
  const double final_cells = size.cells * std::pow(1. + 3. * c.refined_fraction, c.adaptive_cycles);
  size.final_unknowns = unknowns(final_cells);
  size.coarse_unknowns = size.final_unknowns;
  if (!is_direct(input, size.final_unknowns))
  {
    const auto coarsest_size = static_cast<double>(continuum::LinearSettings().coarsest_size);
    double coarse = coarse_cells;
    while (4. * coarse <= size.cells && unknowns(4. * coarse) <= coarsest_size)
      coarse *= 4.;
    size.coarse_unknowns = unknowns(coarse);
  }
  if (size.final_unknowns > max_unknowns)
    throw support::InputError(support::text_of(
      "the finite element mesh would have about ", size.final_unknowns,
      " unknowns, more than the limit of 2147483647; give fewer cells, refinements or adaptive cycles"));
  return size;
}

MemoryNeed continuum_memory(const input::Case &input, const ContinuumSize &size)
{
  const input::ContinuumCase &c = input.continuum;
  const bool has_face_terms = c.gradient != input::ContinuumGradient::none;
  const double entries = entries_per_row(c.degree, has_face_terms);
  // Measured growth of the peak memory of runs on one rank, in bytes per unknown, per matrix entry and per entry of the
  // factors.
  const double of_unknown = 700. + 1000. / (c.degree * c.degree);
  const double of_entry = (is_direct(input, size.final_unknowns) ? 0. : 7.) +
                          (c.solution == input::ContinuumCase::Solution::motion ? 20. : 0.);
  const double of_factor = has_face_terms ? 85. : 50.;
  const double fill = 1. + 0.15 * std::max(0., std::log2(size.coarse_unknowns / 2e4));
  // Branches: a stretch per direction and an overstress per branch at each quadrature point, as per bond of a site; the
  // history, that of the start of the step, that of its end, and the image of a checkpoint.
  const double of_history = c.solution == input::ContinuumCase::Solution::motion
                              ? 4. * size.cells * std::pow(c.degree + 1., 2) * bytes_of_history(input.material(), input.lattice())
                              : 0.;
  return {size.final_unknowns * (of_unknown + entries * of_entry) + size.coarse_unknowns * entries * of_factor * fill +
            of_history,
          0.};
}

double continuum_seconds(const input::Case &input, const ContinuumSize &size, const double steps, const double frames)
{
  const input::ContinuumCase &c = input.continuum;
  const double entries = entries_per_row(c.degree, c.gradient != input::ContinuumGradient::none);
  constexpr double seconds_of_unknown = 8e-6, seconds_of_entry = 2e-7; // in a Newton iteration
  // Newton iterations of the loading, of an adaptive cycle, and of a time step.
  constexpr double of_loading = 8., of_cycle = 4., of_step = 2.;
  double work = c.solution == input::ContinuumCase::Solution::motion ? of_step * steps * size.unknowns : 0.;
  if (c.solution == input::ContinuumCase::Solution::equilibrium ||
      c.initial_base == input::ContinuumCase::Base::equilibrium)
    work += of_loading * size.unknowns;
  double unknowns = size.unknowns;
  for (unsigned int cycle = 0; cycle < c.adaptive_cycles; ++cycle)
  {
    unknowns *= 1. + 3. * c.refined_fraction;
    work += of_cycle * unknowns;
  }
  return seconds_of_start + (frames * seconds_of_unknown_in_frame * size.final_unknowns +
                             work * (seconds_of_unknown + entries * seconds_of_entry)) /
                              support::n_ranks();
}

} // namespace latcon::resources
