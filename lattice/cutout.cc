#include "lattice/cutout.h"

#include <cmath>

namespace latcon::lattice
{

void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout)
{
  // Lengths are compared with some room, so that a radius or notch of whole spacings means the same on every machine.
  const double margin = 1e-9 * lattice.spacing();
  const auto *const hole = std::get_if<RoundHole>(&cutout);
  const double notch = hole != nullptr ? 0. : std::get<Notch>(cutout).length;
  const auto in_piece = [&](const Eigen::Vector2d &X)
  {
    return hole != nullptr ? (X - Eigen::Vector2d(0.5 * lattice.length(), 0.)).norm() < hole->radius - margin
                           : std::abs(X.y()) <= margin && X.x() <= notch + margin;
  };
  // Through the slit between sites.
  const auto through_notch = [&](const Eigen::Vector2d &X, const Eigen::Vector2d &R)
  { return hole == nullptr && X.y() * (X.y() + R.y()) < 0. && X.x() - X.y() / R.y() * R.x() <= notch + margin; };
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_occupied(place) && in_piece(lattice.reference(lattice.canonical_place(place))))
    {
      state.removed[place] = 1;
      state.held[place] = state.rollers[place] = 0;
      state.inverse_mass[place] = 0.;
    }
  for_each_bond(state, lattice,
                [&](const Bond &bond)
                {
                  if (state.removed[bond.near] != 0 || state.removed[bond.far] != 0 ||
                      through_notch(lattice.reference(bond.near), lattice.bond_vector(bond)))
                    state.bonds.remove(bond.near, bond.kind);
                });
}

} // namespace latcon::lattice
