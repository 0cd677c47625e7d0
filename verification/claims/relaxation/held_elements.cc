#include "verification/claims/relaxation/relaxation_claim.h"

#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "continuum/dynamic_solver.h"
#include "continuum/rectangle.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/rows.h"
#include "verification/claims/continuum_waves.h"

namespace latcon::claims
{
namespace
{

// Mean of P over a sheet in equilibrium: sum of reactions times positions, over the area.
Eigen::Matrix2d mean_stress(const continuum::DynamicSolver &solver, double area)
{
  const continuum::Sheet::Vector reactions = solver.reactions();
  std::vector<bool> is_counted(reactions.size(), false);
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  solver.sheet().for_each_owned_dof(
    [&](const auto dof, const unsigned int i, const dealii::Point<2> &X)
    {
      if (!is_counted[dof])
        moment.row(i) += reactions(dof) * Eigen::RowVector2d(X[0], X[1]);
      is_counted[dof] = true;
    });
  return moment / area;
}

} // namespace

std::vector<BranchTheory> relaxing_branches(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                            const std::array<double, lattice::n_bond_kinds> &n_bonds,
                                            const Eigen::Matrix2d &F)
{
  std::vector<BranchTheory> branches;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
  {
    const lattice::Shell *shell = material.in_shell(number);
    const std::size_t first_kind = number * lattice::n_kinds_per_shell;
    const auto *memory = shell != nullptr ? std::get_if<lattice::MaxwellMemory>(&shell->memory) : nullptr;
    if (memory == nullptr)
      continue;
    for (const lattice::MaxwellMemory::Branch &branch : memory->branches())
    {
      BranchTheory sum{branch.relaxation_time, 0., Eigen::Matrix2d::Zero()};
      for (std::size_t kind = first_kind; kind < first_kind + lattice::n_kinds_per_shell; ++kind)
      {
        const Eigen::Vector2d R = sheet.bond_vector(kind), r = F * R;
        const double change = r.norm() / R.norm() - 1., section = lattice::cross_section(*shell, sheet);
        sum.stored += n_bonds[kind] * section * R.norm() * 0.5 * branch.modulus * change * change;
        sum.stress += section / sheet.site_area() * branch.modulus * change * r.normalized() * R.transpose();
      }
      branches.push_back(sum);
    }
  }
  return branches;
}

void add_held_elements(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                       const lattice::Material &material, const lattice::Material &planted, const Eigen::Matrix2d &F,
                       double time_step, std::size_t n_steps, ClaimOutcome &outcome)
{
  const double extent = 4. * subject.spacing, area = extent * extent;
  constexpr unsigned int cells = 2;
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, {extent, extent, cells, cells, false, false});
  const continuum::BoundaryConditions conditions(bridge::affine_boundary(F));
  continuum::DynamicSettings settings{time_step};
  settings.degree = 2;
  const auto viscosity = bridge::homogenised_viscosity(sheet, planted);
  const auto memory = bridge::homogenised_memory(sheet, planted);
  continuum::DynamicSolver solver(mesh, {subject.cauchy_born}, conditions, {subject.material.density}, settings,
                                  viscosity.get(), {}, memory.get());
  const continuum::Sheet::Vector at_rest = solver.sheet().make_owned();
  solver.start(interpolated(solver.sheet(), bridge::AffineDisplacement(F)), at_rest, 0.,
               std::vector<continuum::Sheet::Vector>(memory ? memory->n_numbers() : 0, at_rest));

  std::array<double, lattice::n_bond_kinds> n_bonds;
  n_bonds.fill(area / sheet.site_area()); // one of each kind per site
  const std::vector<BranchTheory> branches = relaxing_branches(sheet, material, n_bonds, F);
  const Eigen::Matrix2d relaxed = bridge::to_lattice(subject.cauchy_born.first_piola_stress(bridge::to_continuum(F)));
  double stored_at_start = 0.;
  Eigen::Matrix2d overstress_at_start = Eigen::Matrix2d::Zero();
  for (const BranchTheory &branch : branches)
  {
    stored_at_start += branch.stored;
    overstress_at_start += branch.stress;
  }
  support::LargestError stress_error, stored_error, dissipated_error, totals, imbalance;
  continuum::Sheet::Vector displacement = solver.sheet().make_ghosted();
  displacement = solver.displacement();
  const double of_law = solver.sheet().energy(displacement);
  const auto compare = [&](double t)
  {
    Eigen::Matrix2d expected = relaxed;
    double stored_sum = 0., dissipated_sum = 0.;
    const std::vector<continuum::BranchEnergy> &measured = solver.branch_energies();
    for (std::size_t i = 0; i < branches.size(); ++i)
    {
      const auto &[time, at_start, stress] = branches[i];
      const double stored = std::exp(-2. * t / time) * at_start, dissipated = -std::expm1(-2. * t / time) * at_start;
      const continuum::BranchEnergy found = i < measured.size() ? measured[i] : continuum::BranchEnergy{0., 0.};
      expected += std::exp(-t / time) * stress;
      stored_error.add(std::abs(found.stored - stored) / at_start, found.stored, stored);
      dissipated_error.add(std::abs(found.dissipated - dissipated) / at_start, found.dissipated, dissipated);
      stored_sum += found.stored;
      dissipated_sum += found.dissipated;
    }
    const Eigen::Matrix2d P = mean_stress(solver, area);
    stress_error.add((P - expected).norm() / overstress_at_start.norm(), P.norm(), expected.norm());
    totals.add(std::abs(solver.ledger().stored - of_law - stored_sum) / stored_at_start);
    totals.add(std::abs(solver.ledger().dissipated - dissipated_sum) / stored_at_start);
    imbalance.add(std::abs(solver.ledger().imbalance) / stored_at_start);
  };
  const std::size_t stride = n_steps > 20 ? n_steps / 20 : 1;
  compare(0.);
  for (std::size_t step = 1; step <= n_steps; ++step)
  {
    solver.step();
    if (step % stride == 0 || step == n_steps)
      compare(solver.time());
  }

  const Rows rows(outcome.results, "relaxation",
                  subject.name + ": held sheet after a step of strain, finite elements, ");
  const std::string reason = "round-off: 4 roundings in each step and 1000 for sums over quadrature points, times the "
                             "quantity over that to which the error is relative";
  // An update rounds four times, and adds a change of stretch that is round-off: of the displacement at free nodes,
  // which Newton's method leaves undetermined to its tolerance. Sums over 36 quadrature points with gradients of shape
  // functions round less than 1000 times.
  const double round_off = (4. * static_cast<double>(n_steps) + 1000.) * std::numeric_limits<double>::epsilon();
  const double elastic_over_stored = of_law / stored_at_start,
               relaxed_over_stress = relaxed.norm() / overstress_at_start.norm();
  rows.add("first Piola stress, worst of all times, error over the overstress at the start", "Pa",
           of_continuum(stress_error), stress_error, {10. * round_off * (1. + relaxed_over_stress), reason});
  rows.add("energy stored in a branch, worst of all branches and times, error over that at the start", "J/m",
           of_continuum(stored_error), stored_error, {2. * round_off, reason});
  rows.add("energy dissipated by a branch, worst of all branches and times, error over that stored at the start", "J/m",
           of_continuum(dissipated_error), dissipated_error, {2. * round_off, reason});
  const output::Tolerance of_energies{round_off * (1. + elastic_over_stored), reason};
  rows.add("branches against the totals of the energy ledger, worst of all times, error over their energy at the start",
           "1", {}, totals, of_energies);
  rows.add("energy imbalance, worst of all times, over the energy of the branches at the start", "1", {}, imbalance,
           of_energies);
}

} // namespace latcon::claims
