#include "verification/claims/prestretch/prestretch_claim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "lattice/energy.h"
#include "lattice/forces.h"
#include "support/largest_error.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/claims/bonds.h"

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
  forces.evaluate(state, state.velocity);
  Eigen::Vector2d reaction = Eigen::Vector2d::Zero();
  for (const std::size_t place : sheet.sites())
    if (state.held[place] != 0)
    {
      const Eigen::Vector2d X = sheet.reference(place);
      const double right = distance(held.right, sheet.length() - X.x());
      const double top = distance(held.top, 0.5 * sheet.height() - X.y());
      const double others =
        support::smallest_of({distance(held.left, X.x()), distance(held.bottom, 0.5 * sheet.height() + X.y())});
      if (right < top && right < others)
        reaction.x() -= forces.on_sites().x[place];
      if (top <= right && top < others)
        reaction.y() -= forces.on_sites().y[place];
    }
  return reaction;
}

// Returns the radius, within half a spacing of `radius`, for which the missing bonds, weighted by the energy that they
// would have in tension along the rim, have the smallest sixth moment about the middle.
double roundest_radius(const bridge::Subject &subject, double radius, double length, double height)
{
  constexpr std::size_t n_radii = 21;
  const double d = subject.spacing;
  const double first = radius - 0.487 * d; // no site is at such a distance
  const lattice::TriangularLattice lattice(d, length, height, subject.orientation);
  const lattice::State whole =
    lattice::homogeneous_state(lattice, subject.material, Eigen::Matrix2d::Identity(), lattice::Edges::held);
  const Eigen::Vector2d middle(0.5 * lattice.length(), 0.);
  // Moments of the bonds that go with each radius and not with the one before.
  std::array<double, n_radii> moments{};
  for (const lattice::Bond &bond : bonds(whole, lattice))
  {
    const lattice::Shell &shell = *subject.material.shell(bond.kind);
    const Eigen::Vector2d R = lattice.bond_vector(bond.kind), X = lattice.reference(bond.near) - middle;
    const double distance = support::smallest_of({X.norm(), (X + R).norm()});
    const Eigen::Vector2d centre = X + 0.5 * R;
    const double step = (distance - first) / d * (n_radii - 1);
    if (step >= n_radii - 1 || centre.norm() < 0.1 * d)
      continue;
    const Eigen::Vector2d n = centre.normalized();
    const double across = std::pow(n.dot(R.normalized()), 2);
    const double energy =
      lattice::stiffness(shell.law, 1.) * shell.area_factor * R.norm() * std::pow(1. - across - across / 3., 2);
    const double sixfold = std::pow(std::complex<double>(n.x(), n.y()), 6).real();
    moments[step < 0. ? 0 : static_cast<std::size_t>(step) + 1] += energy * sixfold;
  }
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

Eigen::Matrix2d stretched(double x, double y)
{
  return Eigen::Vector2d(x, y).asDiagonal();
}

// The local law of the lattice after a rotation.
continuum::CauchyBorn turned(const continuum::CauchyBorn &law, const Eigen::Matrix2d &rotation)
{
  std::vector<continuum::FibreFamily> families = law.families();
  const dealii::Tensor<2, 2> R = bridge::to_continuum(rotation);
  for (continuum::FibreFamily &family : families)
    family.direction = R * family.direction;
  return continuum::CauchyBorn(std::move(families));
}

// Means of the fields and of the signed errors of two solutions beside the same lattice.
CutSolution middle(const CutSolution &a, const CutSolution &b)
{
  CutSolution mean = a;
  for (std::size_t i = 0; i < mean.u.size(); ++i)
  {
    mean.u[i] = 0.5 * (a.u[i] + b.u[i]);
    mean.P[i] = 0.5 * (a.P[i] + b.P[i]);
  }
  mean.opening = 0.5 * (a.opening + b.opening);
  for (double CutErrors::*part : {&CutErrors::stress_scale, &CutErrors::energy, &CutErrors::reaction})
    mean.errors.*part = 0.5 * (a.errors.*part + b.errors.*part);
  return mean;
}

} // namespace

CutSheet sheet_with_hole(const bridge::Subject &subject, double R, const Eigen::Matrix2d &F)
{
  const bool rows_along_x = subject.orientation == lattice::Orientation::rows_along_crack;
  const double along = 2. * subject.spacing, across = 2. * std::sqrt(3.) * subject.spacing;
  const double pitch_x = rows_along_x ? along : across, pitch_y = rows_along_x ? across : along;
  const double length = pitch_x * std::round(5. * R / pitch_x), height = pitch_y * std::round(4. * R / pitch_y);
  const double radius = roundest_radius(subject, R, length, height);
  return {{radius, 0.}, radius, length, height, lattice::Edges::held, F};
}

CutSheet sheet_with_notch(const bridge::Subject &subject, double a, const Eigen::Matrix2d &F)
{
  const lattice::TriangularLattice lattice(subject.spacing, 4. * a, 4. * a, subject.orientation);
  support::Extremes inside;
  inside.add(0.);
  for (const std::size_t place : lattice.sites())
  {
    const Eigen::Vector2d X = lattice.reference(place);
    if (std::abs(X.y()) < 0.1 * subject.spacing && X.x() < a + 0.1 * subject.spacing)
      inside.add(X.x());
  }
  return {{0., inside.largest() + 0.25 * subject.spacing}, a, 4. * a, 4. * a, {false, true, true, true}, F};
}

CutLattice relaxed_lattice(const bridge::Subject &subject, const CutSheet &sheet)
{
  const lattice::TriangularLattice lattice(subject.spacing, sheet.length, sheet.height, subject.orientation);
  const lattice::State whole = lattice::homogeneous_state(lattice, subject.material, sheet.F, sheet.held);
  CutLattice cut{sheet, lattice, whole, {}, {}, {}, 0., {}, 0., {}, 0., 0.};
  lattice::cut_out(cut.state, lattice, sheet.cutout);
  cut.residual =
    lattice::relax(cut.state, lattice, subject.material, 1e-8 * subject.theory.shear_modulus * subject.spacing);
  cut.fields = lattice::site_fields(cut.state, lattice, subject.material);

  const std::size_t inside = lattice.index(lattice.rows() / 2, lattice.columns() / 2);
  const lattice::SiteValues values = lattice::site_values(whole, lattice, subject.material, inside);
  cut.homogeneous_energy = values.strain_energy_density;
  cut.homogeneous_P = values.first_piola_stress;
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

  for (const std::size_t place : lattice.sites())
    if (cut.state.inverse_mass[place] > 0.)
    {
      unsigned int bonds = 0;
      lattice::for_each_bond_of_site(cut.state, lattice, place, [&](const lattice::Bond &) { ++bonds; });
      cut.sites.push_back({place, bonds == subject.material.coordination()});
    }
  return cut;
}

CutStudy hole_study(bool quick)
{
  CutStudy study{"hole", sheet_with_hole};
  if (quick)
  {
    study.states = {stretched(1.3, 1.1)};
    study.sizes = {6., 8., 12., 16., 24.};
    study.other_sizes = {24.};
    study.mesh.degree = 4;
    return study;
  }
  study.states = {stretched(1.1, 1.1), stretched(1.3, 1.1), stretched(1.5, 1.5)};
  study.sizes = {8., 10., 12., 14., 16., 20., 24., 28., 32., 64.};
  study.other_sizes = {8., 16., 32., 64.};
  study.n_judged = 3;
  study.mesh.refinements = 1;
  return study;
}

CutStudy nearest_hole_study(bool quick)
{
  CutStudy study = hole_study(quick);
  study.states = {stretched(1.3, 1.1)};
  if (quick)
    study.other_sizes.clear();
  return study;
}

CutStudy notch_study(bool quick)
{
  CutStudy study{"notch", sheet_with_notch, {stretched(1., 1.1)}, {4., 6., 8., 10., 12.}, {}, {3, 2, 3, 0.15}};
  if (!quick)
  {
    study.sizes = {8., 10., 12., 16., 20., 24., 32.};
    study.other_sizes = {8., 16., 32.};
    study.mesh.cycles = 6;
  }
  return study;
}

std::vector<CutResult> compare_sizes(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F)
{
  const double d = subject.spacing;
  std::vector<CutResult> results;
  for (std::size_t i = 0; i < study.sizes.size(); ++i)
  {
    const double size = study.sizes[i];
    const CutSheet sheet = study.sheet(subject, size * d, F);
    CutLattice lattice = relaxed_lattice(subject, sheet);
    study.spoil(lattice);
    const bridge::EquivalentSheet domain =
      bridge::equivalent_sheet(lattice.lattice, subject.material, lattice.state, sheet.held, sheet.cutout);
    std::optional<CutSolution> of_local, of_turned;
    const auto add =
      [&](const std::string &law, const continuum::Constitution &constitution, const bridge::EquivalentSheet &at)
    {
      CutResult result{size, law, {}, {}, lattice.residual / (subject.theory.shear_modulus * d), {}, {}};
      std::optional<CutSolution> found = compare(lattice, at, constitution, study.mesh, result.failure);
      if (found)
        result.errors = found->errors;
      if (found && of_local)
        result.from_local = distance(lattice, *found, *of_local);
      if (found && law == "network" && of_local && of_turned)
        result.from_middle = distance(lattice, *found, middle(*of_local, *of_turned));
      results.push_back(result);
      return found;
    };
    const continuum::Constitution local(subject.cauchy_born);
    of_local = add("local", local, domain);
    const bool is_largest = i + 1 == study.sizes.size();
    const bool has_others =
      std::find(study.other_sizes.begin(), study.other_sizes.end(), size) != study.other_sizes.end();
    if (is_largest)
    {
      bridge::EquivalentSheet moved = domain;
      moved.cut -= sheet.is_hole()                  ? bridge::rim_recession(lattice.lattice, subject.material)
                   : subject.material.third_nearest ? subject.lengths.lattice
                                                    : 0.5 * d;
      add("local-moved", local, moved);
      const continuum::CauchyBorn turned_law =
        turned(subject.cauchy_born, bridge::lattice_rotation(bridge::n_lattice_rotations / 2));
      of_turned = add("local-turned", {turned_law}, domain);
    }
    if (is_largest || has_others)
    {
      add("network", {subject.network}, domain);
      add("network-gradient", {subject.network, *subject.network_gradient}, domain);
    }
    if (!has_others)
      continue;
    add("lattice", {subject.cauchy_born, *subject.lattice_gradient}, domain);
    add("isotropic", {subject.cauchy_born, *subject.isotropic_gradient}, domain);
  }
  return results;
}

} // namespace latcon::claims
