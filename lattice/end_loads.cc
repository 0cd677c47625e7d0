#include "lattice/end_loads.h"

#include <cmath>

#include "support/dense.h"
#include "support/require.h"

namespace latcon::lattice
{
namespace
{

// Returns whether a site is outermost at an end: the last of its row if rows run along x, a site of the first or last
// row if they run across.
bool outermost(const TriangularLattice &lattice, std::size_t place, bool left)
{
  const std::size_t row = lattice.row_of(place);
  if (lattice.orientation() == Orientation::rows_across_crack)
    return row == (left ? 0 : lattice.rows() - 1);
  return lattice.column_of(place) == (left ? 0 : lattice.sites_in_row(row) - 1);
}

// Force of the bonds that a site lacks, as they would be in the sheet at x = F X.
Eigen::Vector2d missing_force(const TriangularLattice &lattice, const Material &material, std::size_t place,
                              const Eigen::Matrix2d &F)
{
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (const Shell *shell = material.shell(lattice, kind))
    {
      const Eigen::Vector2d bond = F * lattice.bond_vector(kind);
      const double length = bond.norm(), axial = cross_section(*shell, lattice, kind) *
                                                 lattice::force(shell->law, length / lattice.rest_length(kind));
      if (!lattice.is_occupied(lattice.bond(place, kind).far))
        force += axial / length * bond;
      if (!lattice.is_occupied(lattice.bond_into(place, kind).near))
        force -= axial / length * bond;
    }
  return force;
}

} // namespace

Eigen::Matrix2d tangent_along_x(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F,
                                bool is_fast)
{
  Eigen::Matrix2d tangent = Eigen::Matrix2d::Zero();
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (const Shell *shell = material.shell(lattice, kind))
    {
      const Eigen::Vector2d R = lattice.bond_vector(kind), n = (F * R).normalized();
      const double l = lattice.rest_length(kind), stretch = (F * R).norm() / l;
      const Eigen::Matrix2d along = n * n.transpose();
      const double of_memory = is_fast ? properties(shell->memory).largest_stiffness : 0.;
      const Eigen::Matrix2d h = (stiffness(shell->law, stretch) + of_memory) * along +
                                force(shell->law, stretch) / stretch * (Eigen::Matrix2d::Identity() - along);
      tangent += cross_section(*shell, lattice, kind) * l / lattice.site_area() * (R.x() / l) * (R.x() / l) * h;
    }
  return tangent;
}

bool waves_run_along_x(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F)
{
  return support::symmetric_eigenvalues(tangent_along_x(lattice, material, F))[0] > 0.;
}

Eigen::Matrix2d end_impedance(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F)
{
  const support::SymmetricModes modes =
    support::symmetric_modes(material.density * tangent_along_x(lattice, material, F, true));
  const bool along = lattice.orientation() == Orientation::rows_along_crack;
  return (along ? std::sqrt(3.) / 2. : 1.) * lattice.spacing() *
         (modes.vectors * modes.values.cwiseSqrt().asDiagonal() * modes.vectors.transpose());
}

EndLoads::EndLoads(const RowPartition &band, const Material &material, const State &state, const Eigen::Matrix2d &F,
                   End left, End right)
  : impedance_(Eigen::Matrix2d::Zero())
{
  const TriangularLattice &lattice = band.lattice();
  for (const std::size_t place : lattice.sites(band.rows()))
  {
    const bool on_left = lattice.reference(place).x() < 0.5 * lattice.length();
    const End end = on_left ? left : right;
    if (state.held[place] != 0 || end == End::held)
      continue;
    unsigned int bonds = 0;
    for_each_bond_of_site(state, lattice, place, [&](const Bond &) { ++bonds; });
    if (bonds == material.coordination(lattice))
      continue;
    dead_.push_back({place, missing_force(lattice, material, place, F)});
    if (end == End::absorbing && outermost(lattice, place, on_left))
      absorbing_.push_back(place);
  }
  if (left != End::absorbing && right != End::absorbing)
    return;
  support::require(lattice.is_triangular(), "only ends of the triangular lattice absorb waves");
  support::require(waves_run_along_x(lattice, material, F),
                   "no waves run along x in the loaded sheet, so that an end cannot absorb them");
  impedance_ = end_impedance(lattice, material, F);
}

const std::vector<SiteForce> &EndLoads::evaluate(State &, VectorField &velocity)
{
  forces_ = dead_;
  for (const std::size_t place : absorbing_)
    forces_.push_back({place, -impedance_ * velocity.at(place)});
  return forces_;
}

} // namespace latcon::lattice
