#include "verification/claims/relaxation/relaxation_claim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <variant>

#include "continuum/dynamic_solver.h"
#include "continuum/meshes.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/bonds.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

// One branch of one shell in a sheet strained suddenly (theory.md, eq. (L.31)).
struct BranchTheory
{
  double relaxation_time; // [s]
  double stored;          // at the start, in all bonds [J/m]
  Eigen::Matrix2d stress; // first Piola, at the start [Pa]
};

// Returns the branches of a sheet strained from I to F, those of nearest-neighbour bonds first: q_i = E_i (lam - 1),
// energies and stresses by sums over bonds. @param n_bonds of each kind, fractions included
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

// Branches for lattices without any: moduli over the stiffness of a bond, relaxation times in time steps.
const std::vector<double> ratios{0.5, 0.3, 0.2}, times_in_steps{30., 100., 300.};

// Time step over the shortest relaxation time.
constexpr double longest_step = 0.3;

// The step of strain: from the undeformed sheet to one in which no bond is compressed, which is stable.
Eigen::Matrix2d strained(const bridge::Subject &subject, const lattice::TriangularLattice &sheet)
{
  const Eigen::Matrix2d F = subject.deformation;
  bool is_stretched = subject.is_stable() && support::singular_values(F)(0) >= 1. + smallest_strain;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    is_stretched = is_stretched && (F * sheet.bond_vector(kind)).norm() >= sheet.rest_length(kind);
  return is_stretched ? F : 1.2 * Eigen::Matrix2d::Identity();
}

// The closed form of the branches of a sheet strained suddenly from I to F, and the largest errors of one side in it.
class RelaxationComparison
{
public:
  // @param sheet only its bonds matter @param n_bonds of each kind, fractions included
  RelaxationComparison(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                       const lattice::Material &material, const std::array<double, lattice::n_bond_kinds> &n_bonds,
                       const Eigen::Matrix2d &F)
    : branches_(relaxing_branches(sheet, material, n_bonds, F)),
      relaxed_(bridge::to_lattice(subject.cauchy_born.first_piola_stress(bridge::to_continuum(F))))
  {
    for (const BranchTheory &branch : branches_)
    {
      stored_ += branch.stored;
      overstress_ += branch.stress;
    }
  }

  // Energies of the ledger [J/m].
  struct Ledger
  {
    double stored, of_laws, dissipated, imbalance;
  };

  // Compares at the time t. @param P first Piola stress @param measured energies of each branch
  // @param trapezoidal_step of a ledger that integrates by the trapezoidal rule; 0: exactly
  template <class Energies>
  void compare(double t, const Eigen::Matrix2d &P, const Energies &measured, const Ledger &ledger,
               double trapezoidal_step)
  {
    const bool is_exact = trapezoidal_step == 0.;
    Eigen::Matrix2d overstress = Eigen::Matrix2d::Zero();
    double stored_sum = 0., dissipated_sum = 0., stored_theory = 0., dissipated_theory = 0.;
    for (std::size_t i = 0; i < branches_.size(); ++i)
    {
      const auto &[time, at_start, stress] = branches_[i];
      overstress += std::exp(-t / time) * stress;
      const double stored = std::exp(-2. * t / time) * at_start, integral = -std::expm1(-2. * t / time) * at_start;
      // The trapezoidal rule on e^(-2t/tau) in steps h, with x = 2h/tau: (x/2) coth(x/2) of the integral.
      const double half = trapezoidal_step / time, dissipated = is_exact ? integral : integral * half / std::tanh(half);
      const auto found = i < measured.size() ? measured[i] : typename Energies::value_type{0., 0.};
      stored_error_.add(std::abs(found.stored - stored) / at_start, found.stored, stored);
      if (is_exact)
        dissipated_error_.add(std::abs(found.dissipated - dissipated) / at_start, found.dissipated, dissipated);
      else if (t > 0.)
        dissipated_error_.add_relative(found.dissipated, dissipated);
      stored_sum += found.stored;
      dissipated_sum += found.dissipated;
      stored_theory += stored;
      dissipated_theory += dissipated;
    }
    const Eigen::Matrix2d expected = relaxed_ + overstress;
    stress_error_.add((P - expected).norm() / overstress_.norm(), P.norm(), expected.norm());
    totals_.add(std::abs(ledger.stored - ledger.of_laws - stored_sum) / stored_);
    totals_.add(std::abs(ledger.dissipated - dissipated_sum) / stored_);
    imbalance_.add_difference(ledger.imbalance / stored_,
                              is_exact ? 0. : (stored_theory + dissipated_theory) / stored_ - 1.);
    points_.push_back(
      {t, (P - relaxed_).norm(), overstress.norm(), stored_sum, stored_theory, dissipated_sum, dissipated_theory});
  }

  // Compares before the first step, after the last, and at some twenty times in between.
  static void follow(std::size_t n_steps, const std::function<void()> &step, const std::function<void()> &compare)
  {
    const std::size_t stride = std::max<std::size_t>(1, n_steps / 20);
    compare();
    for (std::size_t i = 1; i <= n_steps; ++i)
    {
      step();
      if (i % stride == 0 || i == n_steps)
        compare();
    }
  }

  // @param elastic energy of the sheet, of which the totals of the ledger subtract that of the laws [J/m]
  void add_rows(const Rows &rows, bool on_lattice, std::size_t n_steps, double elastic) const
  {
    const auto sides = [&](const support::LargestError &error)
    { return on_lattice ? of_lattice(error) : of_continuum(error); };
    const std::string reason = std::string("round-off: 4 roundings in each step and 1000 for sums over ") +
                               (on_lattice ? "bonds" : "quadrature points") +
                               ", times the quantity over that to which the error is relative";
    // Each update rounds twice, multiplies by an exponential that is off by a rounding, and adds a change of stretch
    // that is round-off: 4 roundings at most. In finite elements it is that of the displacement at free nodes, which
    // Newton's method leaves undetermined to its tolerance. Sums over the bonds of the sheet, or over 36 quadrature
    // points with gradients of shape functions, round less than 1000 times.
    const double round_off = (4. * static_cast<double>(n_steps) + 1000.) * std::numeric_limits<double>::epsilon();
    const auto limited = [&](double estimate) { return output::limited(estimate, 0., 1e-3, reason); };
    support::Extremes dissipated; // share of the energy at the first sample
    for (const BranchTheory &branch : branches_)
      dissipated.add(-std::expm1(-2. * points_.at(1)[0] / branch.relaxation_time));
    const double elastic_over_stored = elastic / stored_;
    // Overstress is a difference to the stress of the laws.
    rows.add("first Piola stress, worst of all times, error over the overstress at the start", "Pa",
             on_lattice ? of_both(stress_error_.value(), stress_error_.reference()) : of_continuum(stress_error_),
             stress_error_, limited((on_lattice ? 1. : 10.) * round_off * (1. + relaxed_.norm() / overstress_.norm())));
    rows.add("energy stored in a branch, worst of all branches and times, error over that at the start", "J/m",
             sides(stored_error_), stored_error_, limited(2. * round_off));
    rows.add(std::string("energy dissipated by a branch, worst of all branches and times") +
               (on_lattice ? "" : ", error over that stored at the start"),
             "J/m", sides(dissipated_error_), dissipated_error_,
             limited(2. * round_off / (on_lattice ? dissipated.smallest() : 1.)));
    rows.add(
      "branches against the totals of the energy ledger, worst of all times, error over their energy at the start", "1",
      {}, totals_, limited(round_off * (1. + elastic_over_stored)));
    rows.add(std::string("energy imbalance, worst of all times, ") +
               (on_lattice ? "against that of the trapezoidal rule, " : "") +
               "over the energy of the branches at the start",
             "1", on_lattice ? of_lattice(imbalance_) : Sides(), imbalance_,
             limited(round_off * ((on_lattice ? 2. : 1.) + elastic_over_stored)));
  }

  void add_to(output::Table &table, const std::string &shells, const std::string &integrator) const
  {
    for (const std::array<double, 7> &p : points_)
      table.add({shells, integrator, p[0], p[1], p[2], p[3], p[4], p[5], p[6]});
  }

private:
  std::vector<BranchTheory> branches_;
  Eigen::Matrix2d relaxed_, overstress_ = Eigen::Matrix2d::Zero(); // of the laws; of the branches at the start [Pa]
  double stored_ = 0.;                                             // in all branches at the start [J/m]
  support::LargestError stress_error_, stored_error_, dissipated_error_, totals_, imbalance_;
  std::vector<std::array<double, 7>> points_; // of the table
};

// Compares a held sheet of the lattice.
// @param material of the closed form @param planted of the lattice
void add_held_lattice(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                      const lattice::Material &material, const lattice::Material &planted, const Eigen::Matrix2d &F,
                      const lattice::TimeStepping &stepping, std::size_t n_steps, const std::string &integrator,
                      const Rows &rows, ClaimOutcome &outcome)
{
  const lattice::RowPartition all(sheet);
  lattice::Simulation simulation(all, planted, suddenly_strained(all, planted, F), stepping);
  const lattice::State &state = simulation.state();
  std::array<double, lattice::n_bond_kinds> n_bonds{};
  for (const lattice::Bond &bond : bonds(state, sheet))
    n_bonds[bond.kind] += 1.;
  RelaxationComparison comparison(subject, sheet, material, n_bonds, F);
  const auto compare = [&]
  {
    lattice::Forces forces(all, simulation.material());
    forces.evaluate(state, state.velocity);
    const auto force = [&](std::size_t place) { return forces.on_sites().at(place); };
    const lattice::EnergyBalance energies = simulation.energies();
    comparison.compare(state.time, bridge::edge_stress(sheet, simulation.material(), force),
                       simulation.mechanism_energies(),
                       {energies.elastic, lattice::elastic_energy(state, all, simulation.material()), energies.viscous,
                        energies.imbalance()},
                       simulation.time_step());
  };
  RelaxationComparison::follow(
    n_steps, [&] { simulation.step(); }, compare);
  comparison.add_rows(rows, true, n_steps, simulation.energies().elastic);
  comparison.add_to(
    outcome.table("relaxation", {"shells", "integrator", "t [s]", "lattice_overstress [Pa]", "theory_overstress [Pa]",
                                 "lattice_stored [J/m]", "theory_stored [J/m]", "lattice_dissipated [J/m]",
                                 "theory_dissipated [J/m]"}),
    subject.name, integrator);
}

bool is_damped(const lattice::Material &material)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number); shell != nullptr && !(shell->viscosity > 0.))
      return false;
  return true;
}

// Compares a held sheet of finite elements with the closed form summed over the bonds of a site; stress is the moment
// of the nodal reactions. Every rank computes all of it.
// @param sheet only its bonds matter @param material of the closed form @param planted of the finite elements
// @param time_step [s] @param n_steps 2 or more
// @throws what continuum::DynamicSolver throws
void add_held_elements(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                       const lattice::Material &material, const lattice::Material &planted, const Eigen::Matrix2d &F,
                       double time_step, std::size_t n_steps, const Rows &rows)
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
                                  viscosity.get(), memory.get());
  const continuum::Sheet::Vector at_rest = solver.sheet().make_owned();
  solver.start(interpolated(solver.sheet(), bridge::AffineDisplacement(F)), at_rest,
               std::vector<continuum::Sheet::Vector>(memory ? memory->n_numbers() : 0, at_rest));

  std::array<double, lattice::n_bond_kinds> n_bonds;
  n_bonds.fill(area / sheet.site_area()); // one of each kind per site
  RelaxationComparison comparison(subject, sheet, material, n_bonds, F);
  const double of_laws = solver.sheet().energy(solver.sheet().with_ghosts(solver.displacement()));
  const auto compare = [&]
  {
    const continuum::EnergyLedger &ledger = solver.ledger();
    comparison.compare(solver.time(), mean_stress(solver, area), solver.branch_energies(),
                       {ledger.stored, of_laws, ledger.dissipated, ledger.imbalance}, 0.);
  };
  RelaxationComparison::follow(
    n_steps, [&] { solver.step(); }, compare);
  comparison.add_rows(rows, false, n_steps, of_laws);
}

} // namespace

ClaimOutcome relaxation_claim(const bridge::Subject &subject, const RelaxationOptions &options)
{
  ClaimOutcome outcome;
  const lattice::TriangularLattice sheet = subject.sheet(12.);
  const Rows rows(outcome.results, "relaxation", subject.name + ": held sheet after a step of strain, ");
  const Eigen::Matrix2d F = strained(subject, sheet);
  const auto relax = [&](const std::string &integrator, bool is_chebyshev)
  {
    lattice::Material material = subject.material;
    const auto stepping = [&]() -> lattice::TimeStepping
    {
      constexpr double safety = 0.9;
      const lattice::TimeStepLimits limits = lattice::time_step_limits(sheet, material, 1.);
      double step = safety * (is_chebyshev ? lattice::chebyshev_step(sheet, material, 1.) : limits.combined);
      for (const double time : relaxation_times(material))
        step = support::smallest_of({step, longest_step * time});
      if (!is_chebyshev)
        return step;
      return lattice::chebyshev_time_stepping(step, limits, 0);
    };
    if (!has_branches(material))
    {
      // The step depends on moduli alone.
      material = with_branches(material, ratios, std::vector<double>(ratios.size(), 1.));
      std::vector<double> times;
      for (const double steps : times_in_steps)
        times.push_back(steps * stepping().step);
      material = with_branches(material, ratios, times);
    }
    const lattice::Material planted = options.planted(material);
    support::Extremes times;
    for (const double time : relaxation_times(material))
      times.add(time);
    const auto n_steps = static_cast<std::size_t>(std::ceil(
      support::smallest_of({static_cast<double>(options.max_steps), 3. * times.largest() / stepping().step})));
    add_held_lattice(subject, sheet, material, planted, F, stepping(), n_steps, integrator,
                     rows.about(integrator + ", "), outcome);
    if (is_chebyshev)
      return;
    // Over the same time in fewer steps: their updates are exact.
    constexpr std::size_t element_steps = 40;
    rows.attempt("finite elements",
                 [&]
                 {
                   add_held_elements(subject, sheet, material, planted, F,
                                     static_cast<double>(n_steps) * stepping().step / element_steps, element_steps,
                                     rows.about("finite elements, "));
                 });
  };
  const std::string verlet = "velocity Verlet", chebyshev = "Runge-Kutta-Chebyshev";
  rows.attempt(verlet, [&] { relax(verlet, false); });
  if (is_damped(subject.material))
    rows.attempt(chebyshev, [&] { relax(chebyshev, true); });
  return outcome;
}

ClaimOutcome check_relaxation(const ClaimInput &input)
{
  RelaxationOptions options;
  if (!input.quick)
    options.max_steps = 100000;
  return relaxation_claim(input.subject, options);
}

} // namespace latcon::claims
