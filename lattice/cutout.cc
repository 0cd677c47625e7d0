#include "lattice/cutout.h"

#include <cmath>

namespace latcon::lattice
{
namespace
{

// Lengths are compared with some room, so that a radius or notch of whole spacings means the same on every machine.
constexpr double relative_margin = 1e-9;

class Shape
{
public:
  Shape(const TriangularLattice &lattice, const RoundHole &hole)
    : centre_(0.5 * lattice.length(), 0.), radius_(hole.radius - relative_margin * lattice.spacing()), notch_(-1.),
      nearby_(0.)
  {
  }
  Shape(const TriangularLattice &lattice, const Notch &notch)
    : centre_(Eigen::Vector2d::Zero()), radius_(-1.), notch_(notch.length + relative_margin * lattice.spacing()),
      nearby_(relative_margin * lattice.spacing())
  {
  }

  bool contains(const Eigen::Vector2d &X) const
  {
    return radius_ > 0. ? (X - centre_).norm() < radius_ : std::abs(X.y()) <= nearby_ && X.x() <= notch_;
  }

  // A bond from X to X + R that passes through the slit between sites.
  bool crosses(const Eigen::Vector2d &X, const Eigen::Vector2d &R) const
  {
    if (radius_ > 0. || X.y() * (X.y() + R.y()) >= 0.)
      return false;
    return X.x() - X.y() / R.y() * R.x() <= notch_;
  }

private:
  Eigen::Vector2d centre_;
  double radius_; // of a hole; negative: a notch
  double notch_;
  double nearby_;
};

} // namespace

void cut_out(State &state, const TriangularLattice &lattice, const Cutout &cutout)
{
  const Shape shape = std::visit([&](const auto &piece) { return Shape(lattice, piece); }, cutout);
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_occupied(place) && shape.contains(lattice.reference(lattice.canonical_place(place))))
    {
      state.removed[place] = 1;
      state.held[place] = state.rollers[place] = 0;
      state.inverse_mass[place] = 0.;
    }
  for_each_bond(state, lattice,
                [&](const Bond &bond)
                {
                  if (state.removed[bond.near] != 0 || state.removed[bond.far] != 0 ||
                      shape.crosses(lattice.reference(bond.near), lattice.bond_vector(bond)))
                    state.bonds.remove(bond.near, bond.kind);
                });
}

} // namespace latcon::lattice
