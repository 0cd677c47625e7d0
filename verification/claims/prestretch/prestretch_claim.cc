#include "verification/claims/prestretch/prestretch_claim.h"

#include <array>
#include <cmath>

#include <deal.II/base/function.h>

#include "continuum/meshes.h"
#include "continuum/static_solver.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

output::Tolerance solver_tolerance(const Eigen::Matrix2d &F)
{
  const double strain = (F - Eigen::Matrix2d::Identity()).norm();
  return {
    1e-10 / support::smallest_of({1., strain}),
    "both solvers stop at 1e-12 of the forces of bonds, whose errors are multiplied by no more than the number of "
    "sites across the sheet, over the strain where it is below 1"};
}

struct LatticeSide
{
  lattice::State state;
  std::vector<lattice::SiteValues> fields;
  std::vector<std::size_t> interior; // sites with all their bonds
  double energy_density;
  Eigen::Matrix2d edge_stress; // first Piola, of the forces on held sites [Pa]
};

LatticeSide relaxed_lattice(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                            const Eigen::Matrix2d &F, double noise)
{
  LatticeSide side;
  side.state = lattice::homogeneous_state(sheet, subject.material, F, lattice::Edges::held);
  lattice::add_noise(side.state, sheet, noise * sheet.spacing(), 1);
  // Bond forces are of the order mu d; the sum of up to eighteen has an error of about 1e-15 of that.
  lattice::relax(side.state, sheet, subject.material, 1e-12 * subject.theory.shear_modulus * sheet.spacing());

  side.fields = lattice::site_fields(side.state, sheet, subject.material);
  side.energy_density = 0.;
  for (const std::size_t place : sheet.sites())
    if (side.state.held[place] == 0)
    {
      side.interior.push_back(place);
      side.energy_density += side.fields[place].strain_energy_density;
    }
  side.energy_density /= static_cast<double>(side.interior.size());

  lattice::Forces forces(sheet, subject.material);
  forces.evaluate(side.state, side.state.velocity);
  side.edge_stress =
    bridge::edge_stress(sheet, subject.material, [&](std::size_t place) { return forces.on_sites().at(place); });
  return side;
}

struct Compared
{
  std::string quantity, unit;
  Sides sides;
  double error;
  double scale = 1.; // of the error: the stress for all of its components, some of which may be zero
};

std::vector<Compared> compare(const lattice::TriangularLattice &sheet, const Eigen::Matrix2d &deformation,
                              const LatticeSide &side, const continuum::Material &law, const PrestretchOptions &options)
{
  dealii::parallel::distributed::Triangulation<2> mesh(MPI_COMM_WORLD);
  continuum::make_rectangle(mesh, {sheet.length(), sheet.height(), options.cells_x, options.cells_y});
  continuum::StaticSettings settings;
  settings.degree = options.degree;
  settings.relative_tolerance = 1e-12;
  continuum::StaticSolver solver(mesh, law, continuum::BoundaryConditions(bridge::affine_boundary(deformation)),
                                 settings);
  solver.solve();

  std::vector<dealii::Point<2>> points;
  for (const std::size_t place : side.interior)
    points.emplace_back(sheet.reference(place).x(), sheet.reference(place).y());
  const std::vector<continuum::PointState> continuum_states = solver.sheet().evaluate(solver.displacement(), points);

  support::LargestError displacement_error, gradient_error, stress_error;
  support::Extremes stress_scale;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const std::size_t place = side.interior[i];
    const continuum::PointState &state = continuum_states[i];
    const Eigen::Vector2d X = sheet.reference(place);
    const Eigen::Vector2d u(side.state.position.x[place] - X.x(), side.state.position.y[place] - X.y());
    displacement_error.add((u - Eigen::Vector2d(state.displacement[0], state.displacement[1])).norm());
    const Eigen::Matrix2d F = bridge::to_lattice(state.F), P = bridge::to_lattice(state.P);
    gradient_error.add((side.fields[place].deformation_gradient - F).norm() / F.norm());
    stress_error.add((side.fields[place].first_piola_stress - P).norm());
    stress_scale.add(P.norm());
  }

  const double energy_density = solver.total_energy() / (sheet.length() * sheet.height());
  const auto reactions = solver.reactions();
  const double right = reactions.at(continuum::edge::right)[0] / sheet.height();
  const double top = reactions.at(continuum::edge::top)[1] / sheet.length();
  const double stress = stress_scale.largest();
  const auto both = [](const std::string &quantity, const std::string &unit, double a, double b, double scale) {
    return Compared{quantity, unit, of_both(a, b), std::abs(a - b) / scale, scale};
  };
  return {both("mean energy density", "J/m^3", side.energy_density, energy_density, std::abs(energy_density)),
          both("traction on the right edge", "Pa", side.edge_stress(0, 0), right, stress),
          both("traction on the top edge", "Pa", side.edge_stress(1, 1), top, stress),
          {"displacement, largest difference / length", "1", {}, displacement_error.error() / sheet.length()},
          {"deformation gradient, largest relative difference", "1", {}, gradient_error.error()},
          {"first Piola stress, largest difference / largest", "1", {}, stress_error.error() / stress}};
}

// The network is the mean over rotations of the lattice (theory-comparison.md, eq. (H.14)), which the simulator
// evaluates; its fields are as homogeneous as the lattice's. The lattice itself differs by its dependence on direction,
// which is reported.
void network_rows(const bridge::Subject &subject, const lattice::TriangularLattice &sheet, const Eigen::Matrix2d &F,
                  const LatticeSide &side, const PrestretchOptions &options, const Rows &rows)
{
  const output::Tolerance tolerance = solver_tolerance(F);
  const bridge::NetworkComparison loaded(subject, subject.sheet(12.), F);
  const std::vector<Compared> found = compare(sheet, F, side, subject.network, options);
  // In the order of compare(); those without a mean are fields.
  const std::array<std::optional<double>, 6> means{
    loaded.energy.mean(0), loaded.stress.mean(0), loaded.stress.mean(3), {}, {}, {}};
  constexpr std::size_t stress = 5;
  const bool is_judged = subject.judges(bridge::Law::mooney_rivlin_network);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const auto &[quantity, unit, sides, error, scale] = found[i];
    if (means[i])
      rows.add(
        quantity + ", network against the lattice's mean over rotations", unit,
        {sides.lattice, sides.continuum, means[i]}, std::abs(sides.continuum.value() - *means[i]) / scale,
        {*tolerance + bridge::NetworkComparison::equal_formulas, "two formulas of the same sum; " + tolerance.reason},
        is_judged);
    const bool is_field = !means[i] && i != stress;
    rows.add(quantity + ", network", unit, sides, error, is_field ? tolerance : output::Tolerance(), is_judged);
  }
}

} // namespace

output::Results prestretch_claim(const bridge::Subject &subject, const PrestretchOptions &options)
{
  output::Results results;
  results.add(stability_row(subject, "prestretch"));
  if (!subject.is_stable())
    return results; // nothing homogeneous to compare
  const bool is_strained = (subject.deformation - Eigen::Matrix2d::Identity()).norm() >= smallest_strain;
  const Eigen::Matrix2d F = is_strained ? subject.deformation : 1.2 * Eigen::Matrix2d::Identity();
  const Rows rows(results, "prestretch", subject.name + (is_strained ? "" : ", " + state_name(F)) + ": ");
  std::optional<lattice::TriangularLattice> sheet;
  LatticeSide side;
  if (!rows.attempt("relaxed lattice",
                    [&]
                    {
                      sheet.emplace(subject.spacing, options.length * subject.spacing, options.height * subject.spacing,
                                    subject.orientation);
                      side = relaxed_lattice(subject, *sheet, F, options.noise);
                    }))
    return results;

  const auto add = [&](const continuum::Material &law, const std::string &name, const output::Tolerance &tolerance)
  {
    for (const auto &[quantity, unit, sides, error, scale] : compare(*sheet, F, side, law, options))
      rows.add(quantity + ", " + name, unit, sides, error, tolerance);
  };
  rows.attempt("equilibrium, Cauchy-Born", [&] { add(subject.cauchy_born, "Cauchy-Born", solver_tolerance(F)); });
  rows.attempt("equilibrium, network", [&] { network_rows(subject, *sheet, F, side, options, rows); });
  if (!subject.mooney_rivlin)
    return results;
  // For information: the law is not the lattice's, and need not have an equilibrium.
  const std::string fitted = "plane-stress Mooney-Rivlin";
  rows.attempt("equilibrium, " + fitted,
               [&]
               {
                 const std::string failure =
                   no_equilibrium([&] { add(continuum::MooneyRivlin(subject.mooney_rivlin->law), fitted, {}); });
                 if (!failure.empty())
                   rows.add("no equilibrium: " + failure + ", " + fitted, "1", {});
               });
  return results;
}

ClaimOutcome check_prestretch(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  const bool quick = input.quick;
  PrestretchOptions options;
  if (!quick)
  {
    options.length = 120.;
    options.height = 80.;
    options.cells_x = 24;
    options.cells_y = 16;
  }
  ClaimOutcome outcome{prestretch_claim(subject, options), {}};
  if (subject.material.coordination() == 6)
  {
    outcome.add(cut_claim(subject, nearest_hole_study(quick)));
    if (!quick)
      outcome.add(cut_claim(subject, notch_study(false)));
    return outcome;
  }
  outcome.add(cut_claim(subject, hole_study(quick)));
  outcome.add(cut_claim(subject, notch_study(quick)));
  return outcome;
}

} // namespace latcon::claims
