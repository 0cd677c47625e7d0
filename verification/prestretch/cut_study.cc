#include "verification/prestretch/cut_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "continuum/mooney_rivlin.h"

namespace verification
{
namespace
{

Eigen::Matrix2d stretched(double x, double y)
{
  return Eigen::Vector2d(x, y).asDiagonal();
}

CutMesh hole_mesh(bool quick)
{
  CutMesh mesh;
  mesh.degree = quick ? 4 : 3;
  mesh.refinements = quick ? 0 : 1;
  mesh.rim_refinements = 1;
  mesh.cycles = 1;
  mesh.fraction = 0.3;
  return mesh;
}

} // namespace

CutStudy hole_study(bool quick)
{
  if (quick)
    return {"hole", sheet_with_hole, {stretched(1.3, 1.1)}, {6., 8., 12., 16., 24.}, {24.}, hole_mesh(true), false, {}};
  return {"hole",
          sheet_with_hole,
          {stretched(1.1, 1.1), stretched(1.3, 1.1), stretched(1.5, 1.5)},
          {8., 12., 16., 24., 32., 64.},
          {8., 16., 32., 64.},
          hole_mesh(false),
          false,
          {}};
}

CutStudy nearest_hole_study(bool quick)
{
  CutStudy study = hole_study(true);
  study.other_sizes.clear();
  if (!quick)
  {
    // More radii than with both shells: the rim of nearest neighbours alone scatters more from one to the next.
    study.sizes = {8., 12., 16., 24., 32., 48., 64.};
    study.other_sizes = {8., 16., 32., 64.};
    study.mesh = hole_mesh(false);
  }
  return study;
}

CutStudy notch_study(bool quick)
{
  CutMesh mesh;
  mesh.refinements = 2;
  mesh.cycles = quick ? 3 : 4;
  mesh.fraction = 0.15;
  const std::vector<double> sizes =
    quick ? std::vector<double>{4., 6., 8., 12.} : std::vector<double>{8., 12., 16., 24., 32.};
  const std::vector<double> others = quick ? std::vector<double>{} : std::vector<double>{8., 16., 32.};
  return {"notch", sheet_with_notch, {stretched(1., 1.1)}, sizes, others, mesh, false, {}};
}

CutStudy loaded_hole_study(const Eigen::Matrix2d &F)
{
  // Coarse, since a law without an equilibrium takes many attempts to say so.
  return {"hole", sheet_with_hole, {F}, {8.}, {8.}, hole_mesh(true), true, {}};
}

std::vector<CutResult> compare_sizes(const Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F)
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
      results.push_back({size, no_lattice, {}, error.what(), std::numeric_limits<double>::quiet_NaN()});
      continue;
    }
    CutLattice &lattice = *relaxed;
    if (study.spoil)
      study.spoil(lattice);
    const EquivalentSheet domain =
      equivalent_sheet(lattice.lattice, subject.material, lattice.state, sheet.held, sheet.cutout);
    const auto add = [&](const std::string &law, const continuum::Constitution &constitution, const EquivalentSheet &at)
    {
      CutResult result{size, law, {}, {}, lattice.relaxation.residual / (subject.theory.shear_modulus * d)};
      result.errors = compare(lattice, sheet, at, constitution, study.mesh, result.failure);
      results.push_back(result);
    };
    const continuum::Constitution local(subject.cauchy_born);
    add("local", local, domain);
    if (i + 1 == study.sizes.size() && !study.is_reported)
    {
      EquivalentSheet moved = domain;
      const bool is_hole = std::holds_alternative<lattice::RoundHole>(sheet.cutout);
      moved.cut -= is_hole ? rim_recession(lattice.lattice, subject.material) : 0.5 * d;
      add("local-moved", local, moved);
    }
    if (std::find(study.other_sizes.begin(), study.other_sizes.end(), size) == study.other_sizes.end())
      continue;
    add("local-nominal", local, nominal_sheet(lattice.lattice, sheet.cutout));
    add("lattice", {subject.cauchy_born, *subject.lattice_gradient}, domain);
    add("isotropic", {subject.cauchy_born, *subject.isotropic_gradient}, domain);
    if (mooney_rivlin)
      add("mooney-rivlin", {*mooney_rivlin}, domain);
  }
  return results;
}

} // namespace verification
