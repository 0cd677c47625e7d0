#include "verification/claims/prestretch/cut_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "continuum/mooney_rivlin.h"
#include "support/largest_error.h"
#include "verification/bridge/anisotropy.h"

namespace latcon::claims
{
namespace
{

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

CutStudy loaded_hole_study(const Eigen::Matrix2d &F)
{
  // Coarse, since a law without an equilibrium takes many attempts.
  CutStudy study = hole_study(true);
  study.states = {F};
  study.sizes = study.other_sizes = {8.};
  study.is_reported = true;
  return study;
}

std::vector<CutResult> compare_sizes(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F)
{
  const double d = subject.spacing;
  std::optional<continuum::MooneyRivlin> mooney_rivlin;
  if (subject.mooney_rivlin)
    mooney_rivlin.emplace(subject.mooney_rivlin->law);
  std::vector<CutResult> results;
  for (std::size_t i = 0; i < study.sizes.size(); ++i)
  {
    const double size = study.sizes[i];
    const CutSheet sheet = study.sheet(subject, size * d, F);
    std::optional<CutLattice> relaxed;
    try
    {
      relaxed.emplace(relaxed_lattice(subject, sheet));
    }
    catch (const std::runtime_error &error)
    {
      if (!study.is_reported)
        throw;
      results.push_back({size, no_lattice, {}, error.what(), std::numeric_limits<double>::quiet_NaN(), {}, {}});
      continue;
    }
    CutLattice &lattice = *relaxed;
    study.spoil(lattice);
    const bridge::EquivalentSheet domain =
      bridge::equivalent_sheet(lattice.lattice, subject.material, lattice.state, sheet.held, sheet.cutout);
    std::optional<CutSolution> of_local, of_turned;
    const auto add =
      [&](const std::string &law, const continuum::Constitution &constitution, const bridge::EquivalentSheet &at)
    {
      CutResult result{size, law, {}, {}, lattice.relaxation.residual / (subject.theory.shear_modulus * d), {}, {}};
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
    if (is_largest && !study.is_reported)
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
    add("local-nominal", local, bridge::nominal_sheet(lattice.lattice, sheet.cutout));
    add("lattice", {subject.cauchy_born, *subject.lattice_gradient}, domain);
    add("isotropic", {subject.cauchy_born, *subject.isotropic_gradient}, domain);
    if (mooney_rivlin)
      add("mooney-rivlin", {*mooney_rivlin}, domain);
  }
  return results;
}

} // namespace latcon::claims
