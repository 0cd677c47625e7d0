#include "verification/claims/prestretch/cut_study.h"

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "lattice/energy.h"
#include "lattice/forces.h"
#include "support/largest_error.h"
#include "verification/bridge/equivalent_sheet.h"

namespace latcon::claims
{
namespace
{

// Force on the held sites of the right edge along x, and of the top edge along y. A site in a corner belongs to the
// nearer one of the held edges that meet there.
Eigen::Vector2d reactions(const lattice::TriangularLattice &sheet, const lattice::State &state,
                          const lattice::Material &material, const lattice::Edges &held)
{
  const auto distance = [](bool is_held, double value) { return is_held ? value : std::numeric_limits<double>::max(); };
  lattice::Forces forces(sheet, material);
  forces.evaluate(state, state.vx, state.vy);
  Eigen::Vector2d reaction = Eigen::Vector2d::Zero();
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    if (sheet.is_site(place) && state.held[place] != 0)
    {
      const Eigen::Vector2d X = sheet.reference(place);
      const double right = distance(held.right, sheet.length() - X.x());
      const double top = distance(held.top, 0.5 * sheet.height() - X.y());
      const double others =
        support::smallest_of({distance(held.left, X.x()), distance(held.bottom, 0.5 * sheet.height() + X.y())});
      if (right < top && right < others)
        reaction.x() -= forces.fx()[place];
      if (top <= right && top < others)
        reaction.y() -= forces.fy()[place];
    }
  return reaction;
}

// Returns the radius, within half a spacing of R, for which the missing bonds, weighted by the energy that they would
// have in tension along the rim, have the smallest sixth moment about the middle.
double roundest_radius(const bridge::Subject &subject, double R, double length, double height)
{
  constexpr std::size_t n_radii = 21;
  const double d = subject.spacing;
  const double first = R - 0.487 * d; // no site is at such a distance
  const lattice::TriangularLattice lattice(d, length, height, subject.orientation);
  const lattice::State whole =
    lattice::homogeneous_state(lattice, subject.material, Eigen::Matrix2d::Identity(), lattice::Edges::held);
  const Eigen::Vector2d middle(0.5 * lattice.length(), 0.);
  // Moments of the bonds that go with each radius and not with the one before.
  std::array<double, n_radii> moments{};
  lattice::for_each_bond(whole, lattice,
                         [&](const lattice::Bond &bond)
                         {
                           const lattice::Shell &shell = *subject.material.shell(bond.kind);
                           const Eigen::Vector2d R = lattice.bond_vector(bond.kind),
                                                 X = lattice.reference(bond.near) - middle;
                           const double distance = support::smallest_of({X.norm(), (X + R).norm()});
                           const Eigen::Vector2d centre = X + 0.5 * R;
                           const double step = (distance - first) / d * (n_radii - 1);
                           if (step >= n_radii - 1 || centre.norm() < 0.1 * d)
                             return;
                           const Eigen::Vector2d n = centre.normalized();
                           const double across = std::pow(n.dot(R.normalized()), 2);
                           const double energy = lattice::stiffness(shell.law, 1.) * shell.area_factor * R.norm() *
                                                 std::pow(1. - across - across / 3., 2);
                           const double sixfold = std::pow(std::complex<double>(n.x(), n.y()), 6).real();
                           moments[step < 0. ? 0 : static_cast<std::size_t>(step) + 1] += energy * sixfold;
                         });
  std::size_t best = 0;
  double sum = 0., smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n_radii; ++i)
  {
    sum += moments[i];
    if (std::abs(sum) < smallest)
    {
      smallest = std::abs(sum);
      best = i;
    }
  }
  return first + d * static_cast<double>(best) / (n_radii - 1);
}

} // namespace

CutSheet sheet_with_hole(const bridge::Subject &subject, double R, const Eigen::Matrix2d &F)
{
  const bool rows_along_x = subject.orientation == lattice::Orientation::rows_along_crack;
  const double along = 2. * subject.spacing, across = 2. * std::sqrt(3.) * subject.spacing;
  const double pitch_x = rows_along_x ? along : across, pitch_y = rows_along_x ? across : along;
  const double length = pitch_x * std::round(5. * R / pitch_x), height = pitch_y * std::round(4. * R / pitch_y);
  const double radius = roundest_radius(subject, R, length, height);
  return {lattice::RoundHole{radius}, radius, length, height, lattice::Edges::held, F};
}

CutSheet sheet_with_notch(const bridge::Subject &subject, double a, const Eigen::Matrix2d &F)
{
  const lattice::TriangularLattice lattice(subject.spacing, 4. * a, 4. * a, subject.orientation);
  support::Extremes inside;
  inside.add(0.);
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
  {
    const Eigen::Vector2d X = lattice.reference(place);
    if (lattice.is_site(place) && std::abs(X.y()) < 0.1 * subject.spacing && X.x() < a + 0.1 * subject.spacing)
      inside.add(X.x());
  }
  return {lattice::Notch{inside.largest() + 0.25 * subject.spacing}, a, 4. * a, 4. * a, {false, true, true, true}, F};
}

CutLattice relaxed_lattice(const bridge::Subject &subject, const CutSheet &sheet)
{
  const lattice::TriangularLattice lattice(subject.spacing, sheet.length, sheet.height, subject.orientation);
  const lattice::State whole = lattice::homogeneous_state(lattice, subject.material, sheet.F, sheet.held);
  CutLattice cut{sheet, lattice, whole, {}, {}, {}, 0., {}, 0., {}, 0., 0.};
  lattice::cut_out(cut.state, lattice, sheet.cutout);
  cut.relaxation =
    lattice::relax(cut.state, lattice, subject.material, 1e-8 * subject.theory.shear_modulus * subject.spacing);
  cut.fields = lattice::site_fields(cut.state, lattice, subject.material);

  const std::size_t inside = lattice.index(lattice.rows() / 2, lattice.columns() / 2);
  const lattice::SiteFields fields = lattice::site_fields(whole, lattice, subject.material);
  cut.homogeneous_energy = fields.strain_energy_density[inside];
  cut.homogeneous_P = fields.first_piola_stress[inside];
  cut.energy_change = lattice::elastic_energy(cut.state, lattice, subject.material) -
                      lattice::elastic_energy(whole, lattice, subject.material);
  cut.reaction_change = reactions(lattice, cut.state, subject.material, sheet.held) -
                        reactions(lattice, whole, subject.material, sheet.held);

  double energy = 0., force = 0., energy_missing = 0., force_missing = 0.;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = subject.material.shell(kind))
    {
      const Eigen::Vector2d R = lattice.bond_vector(kind), r = sheet.F * R;
      const double l = R.norm(), section = lattice::cross_section(*shell, lattice);
      const double of_energy = section * l * lattice::energy(shell->law, r.norm() / l);
      const double of_force = section * lattice::force(shell->law, r.norm() / l) * r.y() / r.norm() * R.y();
      energy += of_energy;
      force += of_force;
      // Half the length of the bonds that cross a free edge is missing.
      energy_missing += of_energy * 0.5 * std::abs(R.x());
      force_missing += of_force * 0.5 * std::abs(R.x());
    }
  const double overhang = bridge::cell_overhang(lattice, {1., 0.});
  cut.left_of_energy = energy_missing / energy - overhang;
  cut.left_of_force = force_missing / force - overhang;

  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_site(place) && cut.state.inverse_mass[place] > 0.)
    {
      unsigned int bonds = 0;
      lattice::for_each_bond_of_site(cut.state, lattice, place, [&](const lattice::Bond &) { ++bonds; });
      cut.sites.push_back({place, bonds == subject.material.coordination()});
    }
  return cut;
}

} // namespace latcon::claims
