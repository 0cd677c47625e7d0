#include "lattice/cutout.h"
#include "lattice/simulation.h"
#include "verification/input/case.h"

namespace latcon::input
{

std::unique_ptr<lattice::Simulation> cracked_sheet(const Case &input, const lattice::RowPartition &band)
{
  const lattice::Material material = input.material();
  const lattice::Edges edges{input.left_end == Case::End::held, input.right_end == Case::End::held,
                             !input.continuum.edges[2].is_roller(), !input.continuum.edges[3].is_roller()};
  lattice::State state = lattice::homogeneous_state(band, material, input.deformation(), edges);
  const std::vector<lattice::Constraint> constraints = edge_constraints(input, state, band.lattice());
  for (const lattice::Constraint &constraint : constraints)
    lattice::constrain(state, band, constraint);
  lattice::add_noise(state, band, input.noise_amplitude * input.spacing, input.noise_seed);
  auto simulation = std::make_unique<lattice::Simulation>(
    band, material, std::move(state), input.fracture_time_stepping(),
    lattice::Fracture(band, material, input.breaking_rule(), input.toughening_rule(), input.deformation()));
  for (const lattice::Constraint &constraint : constraints)
    simulation->constrain(constraint);
  if (!edges.left || !edges.right)
    simulation->load_ends(input.deformation(), input.left_end, input.right_end);
  if (input.has_contact)
    simulation->enable_contact(input.contact_law());
  const lattice::TriangularLattice &sheet = band.lattice();
  if (sheet.is_triangular())
    simulation->cut(input.seed(sheet));
  else
  {
    const Case::Cut cut = input.seed_cut(sheet);
    simulation->cut_bonds(lattice::bonds_across(sheet, cut.from, cut.to, cut.Y));
  }
  return simulation;
}

} // namespace latcon::input
