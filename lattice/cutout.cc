#include "lattice/cutout.h"

#include <cmath>

namespace latcon::lattice
{
namespace
{

// Lengths are compared with some room, so that a radius or notch of whole spacings means the same on every machine.
constexpr double relative_margin = 1e-9;

double margin(const TriangularLattice &lattice)
{
  return relative_margin * lattice.spacing();
}

bool contains(const RoundHole &hole, const TriangularLattice &lattice, const Eigen::Vector2d &X)
{
  return (X - Eigen::Vector2d(0.5 * lattice.length(), 0.)).norm() < hole.radius - margin(lattice);
}

bool contains(const Notch &notch, const TriangularLattice &lattice, const Eigen::Vector2d &X)
{
  return std::abs(X.y()) <= margin(lattice) && X.x() <= notch.length + margin(lattice);
}

bool crosses(const RoundHole &, const TriangularLattice &, const Eigen::Vector2d &, const Eigen::Vector2d &)
{
  return false;
}

// Whether a bond from X to X + R passes through the slit between sites.
bool crosses(const Notch &notch, const TriangularLattice &lattice, const Eigen::Vector2d &X, const Eigen::Vector2d &R)
{
  return X.y() * (X.y() + R.y()) < 0. && X.x() - X.y() / R.y() * R.x() <= notch.length + margin(lattice);
}

} // namespace

void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout)
{
  const auto in_piece = [&](const Eigen::Vector2d &X)
  { return std::visit([&](const auto &piece) { return contains(piece, lattice, X); }, cutout); };
  const auto through_piece = [&](const Eigen::Vector2d &X, const Eigen::Vector2d &R)
  { return std::visit([&](const auto &piece) { return crosses(piece, lattice, X, R); }, cutout); };
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
                      through_piece(lattice.reference(bond.near), lattice.bond_vector(bond)))
                    state.bonds.remove(bond.near, bond.kind);
                });
}

} // namespace latcon::lattice
