#include "verification/claims/relaxation/relaxation_claim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "continuum/dynamic_solver.h"
#include "continuum/rectangle.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/rows.h"

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

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Branches for lattices without any: moduli over the stiffness of a bond, relaxation times in time steps.
const std::vector<double> ratios{0.5, 0.3, 0.2}, times_in_steps{30., 100., 300.};

// Time step over the shortest relaxation time.
constexpr double longest_step = 0.3;

// Of changes of stretch this large, the round-off of stretches is 100 epsilon.
constexpr double smallest_strain = 1e-2;

// The step of strain: from the undeformed sheet to one in which no bond is compressed, which is stable.
Eigen::Matrix2d strained(const bridge::Subject &subject, const lattice::TriangularLattice &sheet)
{
  const Eigen::Matrix2d F = subject.deformation;
  bool is_stretched = subject.is_stable() && support::singular_values(F)(0) >= 1. + smallest_strain;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    is_stretched = is_stretched && (F * sheet.bond_vector(kind)).norm() >= sheet.rest_length(kind);
  return is_stretched ? F : 1.2 * Eigen::Matrix2d::Identity();
}

// A relaxing sheet beside its closed form.
class HeldSheet
{
public:
  HeldSheet(const bridge::Subject &subject, const lattice::TriangularLattice &sheet, const lattice::Material &material,
            const lattice::Material &planted, const Eigen::Matrix2d &F, const lattice::TimeStepping &stepping)
    : sheet_(sheet), rows_(sheet), simulation_(rows_, planted, suddenly_strained(rows_, planted, F), stepping),
      relaxed_(bridge::to_lattice(subject.cauchy_born.first_piola_stress(bridge::to_continuum(F))))
  {
    std::array<double, lattice::n_bond_kinds> n_bonds{};
    lattice::for_each_bond(simulation_.state(), sheet, [&](const lattice::Bond &bond) { n_bonds[bond.kind] += 1.; });
    branches_ = relaxing_branches(sheet, material, n_bonds, F);
    for (const BranchTheory &branch : branches_)
    {
      stored_ += branch.stored;
      overstress_ += branch.stress;
    }
  }

  // Compares at the present time.
  void compare()
  {
    const double t = simulation_.state().time;
    Eigen::Matrix2d overstress = Eigen::Matrix2d::Zero();
    const std::vector<lattice::MechanismEnergy> measured = simulation_.mechanism_energies();
    const lattice::EnergyBalance energies = simulation_.energies();
    double stored_sum = 0., dissipated_sum = 0., stored_theory = 0., dissipated_theory = 0.;
    for (std::size_t i = 0; i < branches_.size(); ++i)
    {
      const auto &[time, at_start, stress] = branches_[i];
      overstress += std::exp(-t / time) * stress;
      const double stored = std::exp(-2. * t / time) * at_start;
      // The trapezoidal rule of the ledger on e^(-2t/tau) in steps h, with x = 2h/tau: (x/2) coth(x/2) of the integral.
      const double half = simulation_.time_step() / time;
      const double dissipated = -std::expm1(-2. * t / time) * at_start * half / std::tanh(half);
      const lattice::MechanismEnergy found = i < measured.size() ? measured[i] : lattice::MechanismEnergy{0., 0.};
      stored_error_.add(std::abs(found.stored - stored) / at_start, found.stored, stored);
      if (t > 0.)
        dissipated_error_.add_relative(found.dissipated, dissipated);
      stored_sum += found.stored;
      dissipated_sum += found.dissipated;
      stored_theory += stored;
      dissipated_theory += dissipated;
    }
    const Eigen::Matrix2d P = bridge::edge_stress(
      sheet_, simulation_.material(),
      [&](std::size_t place) {
        return simulation_.forces().on_site(simulation_.state(), simulation_.state().vx, simulation_.state().vy, place);
      });
    const Eigen::Matrix2d expected = relaxed_ + overstress;
    stress_error_.add((P - expected).norm() / overstress_.norm(), P.norm(), expected.norm());
    const double of_laws = lattice::elastic_energy(simulation_.state(), rows_, simulation_.material());
    totals_.add(std::abs(energies.elastic - of_laws - stored_sum) / stored_);
    totals_.add(std::abs(energies.viscous - dissipated_sum) / stored_);
    imbalance_.add_difference(energies.imbalance() / stored_, (stored_theory + dissipated_theory) / stored_ - 1.);
    points_.push_back(
      {t, (P - relaxed_).norm(), overstress.norm(), stored_sum, stored_theory, dissipated_sum, dissipated_theory});
  }

  void run(std::size_t n_steps)
  {
    constexpr std::size_t samples = 20;
    compare();
    for (std::size_t step = 1; step <= n_steps; ++step)
    {
      simulation_.step();
      if (step % std::max<std::size_t>(1, n_steps / samples) == 0 || step == n_steps)
        compare();
    }
  }

  void add_rows(const bridge::Subject &subject, const std::string &integrator, std::size_t n_steps,
                ClaimOutcome &outcome) const
  {
    const Rows rows(outcome.results, "relaxation",
                    subject.name + ": held sheet after a step of strain, " + integrator + ", ");
    const std::string reason = "round-off: 4 roundings in each step and 1000 for sums over bonds, times the quantity "
                               "over that to which the error is relative";
    // Each update rounds twice, multiplies by an exponential that is off by a rounding, and adds a change of stretch
    // that is round-off: 4 roundings at most. Sums over the bonds of the sheet round less than 1000 times.
    const double round_off = (4. * static_cast<double>(n_steps) + 1000.) * epsilon;
    support::Extremes dissipated; // share of the energy at the first sample
    const double t_first = points_.at(1)[0];
    for (const BranchTheory &branch : branches_)
      dissipated.add(-std::expm1(-2. * t_first / branch.relaxation_time));
    const double elastic_over_stored = simulation_.energies().elastic / stored_;
    // Overstress is a difference to the stress of the laws.
    rows.add("first Piola stress, worst of all times, error over the overstress at the start", "Pa",
             of_both(stress_error_.value(), stress_error_.reference()), stress_error_,
             {round_off * (1. + relaxed_.norm() / overstress_.norm()), reason});
    rows.add("energy stored in a branch, worst of all branches and times, error over that at the start", "J/m",
             of_lattice(stored_error_), stored_error_, {2. * round_off, reason});
    rows.add("energy dissipated by a branch, worst of all branches and times", "J/m", of_lattice(dissipated_error_),
             dissipated_error_, {2. * round_off / dissipated.smallest(), reason});
    rows.add(
      "branches against the totals of the energy ledger, worst of all times, error over their energy at the start", "1",
      {}, totals_, {round_off * (1. + elastic_over_stored), reason});
    rows.add(
      "energy imbalance, worst of all times, against that of the trapezoidal rule, over the energy of the branches at "
      "the start",
      "1", of_lattice(imbalance_), imbalance_, {round_off * (2. + elastic_over_stored), reason});
    output::Table &table =
      outcome.table("relaxation", {"shells", "integrator", "t [s]", "lattice_overstress [Pa]", "theory_overstress [Pa]",
                                   "lattice_stored [J/m]", "theory_stored [J/m]", "lattice_dissipated [J/m]",
                                   "theory_dissipated [J/m]"});
    for (const std::array<double, 7> &p : points_)
      table.add({subject.name, integrator, p[0], p[1], p[2], p[3], p[4], p[5], p[6]});
  }

private:
  const lattice::TriangularLattice &sheet_;
  lattice::RowPartition rows_;
  lattice::Simulation simulation_;
  std::vector<BranchTheory> branches_;
  Eigen::Matrix2d relaxed_, overstress_ = Eigen::Matrix2d::Zero(); // of the laws; of the branches at the start [Pa]
  double stored_ = 0.;                                             // in all branches at the start [J/m]
  support::LargestError stress_error_, stored_error_, dissipated_error_, totals_, imbalance_;
  std::vector<std::array<double, 7>> points_; // of the table
};

bool is_damped(const lattice::Material &material)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number); shell != nullptr && !(shell->viscosity > 0.))
      return false;
  return true;
}

// Adds rows that compare a held sheet of finite elements, strained suddenly from I to F, with the closed form of its
// branches (theory.md, eq. (L.31)), summed over the bonds of a site: first Piola stress, measured as the moment of the
// nodal reactions, energies of each branch, and their balance. Every rank computes all of it.
// @param sheet only its bonds matter
// @param material of the closed form, with Maxwell branches @param planted of the finite elements
// @param time_step [s] @param n_steps 2 or more
// @throws what continuum::DynamicSolver throws
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
      const double stable = is_chebyshev ? lattice::chebyshev_step(sheet, material, 1.) : limits.combined;
      double step = safety * stable;
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
    HeldSheet held(subject, sheet, material, planted, F, stepping());
    support::Extremes times;
    for (const double time : relaxation_times(material))
      times.add(time);
    const auto n_steps = static_cast<std::size_t>(std::ceil(
      support::smallest_of({static_cast<double>(options.max_steps), 3. * times.largest() / stepping().step})));
    held.run(n_steps);
    held.add_rows(subject, integrator, n_steps, outcome);
    if (is_chebyshev)
      return;
    // Over the same time in fewer steps: their updates are exact.
    constexpr std::size_t element_steps = 40;
    rows.attempt("finite elements",
                 [&]
                 {
                   add_held_elements(subject, sheet, material, planted, F,
                                     static_cast<double>(n_steps) * stepping().step / element_steps, element_steps,
                                     outcome);
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
