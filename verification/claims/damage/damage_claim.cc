#include "verification/claims/damage/damage_claim.h"

#include <cmath>
#include <optional>

#include "continuum/rectangle.h"
#include "support/largest_error.h"
#include "verification/bridge/damaged_sheet.h"
#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/damage/damage_motion_rows.h"
#include "verification/claims/damage/damaged_bar.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{
namespace
{

using continuum::Constitution;
using continuum::DamageLaw;

const output::Tolerance bar_solver_tolerance{
  1e-9, "ten times the residuals of the equilibrium, 1e-10 of the forces, and of the damage, 1e-13 of its terms"};
const output::Tolerance exact{0., "exactly"};
// Initial damage of the weak spot, small enough that it is exceeded by the damage of the crack everywhere.
constexpr double weakness = 0.02;
// Ten times the change of d in the last iteration of the alternating minimisation. It is chosen, not derived: if the
// changes fall by a factor q per iteration, q/(1 - q) of the last one remains, which is less for q up to 0.9.
const output::Tolerance iteration_tolerance{
  1e-5, "ten times the change of d in the last iteration of the alternating minimisation: chosen"};

struct Problem
{
  const bridge::Subject &subject;
  DamageLaw law;     // of the theory
  DamageLaw planted; // of the solver
  double critical;   // stretch at the threshold

  const continuum::Material &material() const { return subject.cauchy_born; }
  double energy(double stretch) const { return material().energy(uniaxial(stretch)); }
  double stress(double stretch) const { return material().first_piola_stress(uniaxial(stretch))[0][0]; }
  // Stretch at a multiple of the critical strain.
  double stretch(double strains) const { return 1. + strains * (critical - 1.); }
  // Damage of the homogeneous bar beyond the threshold, eq. (C.66).
  double damage(double stretch) const { return 1. - law.threshold / energy(stretch); }
};

// A value against theory, with a relative error.
void compare(const Rows &rows, const std::string &quantity, const std::string &unit, double value, double theory,
             const output::Tolerance &tolerance)
{
  rows.add(quantity, unit, of_continuum(value, theory), support::relative_error(value, theory), tolerance);
}

// Two elements of a quarter of xi, too short for a crack: damage is homogeneous.
DamagedBar &emplace_short_bar(const Problem &problem, std::optional<DamagedBar> &bar)
{
  return bar.emplace(problem.material(), problem.planted, 0.25 * problem.law.length, 2u, problem.stretch(2.));
}

void homogeneous_bar(const Problem &problem, bool heals, const Rows &rows)
{
  std::optional<DamagedBar> bar;
  const auto load = [&](double stretch)
  {
    if (!bar || heals)
      emplace_short_bar(problem, bar);
    bar->stretch(stretch);
  };
  const auto largest = [&] { return bar->solver().field().largest(); };
  // Relative distance to the threshold at which it is checked from both sides. Rounding of the damage is 1e-13.
  constexpr double below = 1e-6;
  const double first = problem.stretch(1. - below);
  load(first);
  rows.add("damage below the threshold", "1", of_continuum(largest(), 0.), std::abs(largest()), exact);
  // The stress at the threshold is the peak; the bar is a millionth of the strain below it.
  const double modulus = problem.material().tangent(uniaxial(first))[0][0][0][0];
  const double peak = problem.stress(problem.critical);
  compare(rows, "peak stress", "Pa", bar->stress(), peak,
          {2. * below * modulus * (problem.critical - 1.) / peak + *bar_solver_tolerance,
           "twice what a millionth of the strain changes"});

  const double high = problem.stretch(1.5), higher = problem.stretch(1.6);
  load(high);
  const double reached = problem.damage(high);
  compare(rows, "damage of a homogeneous bar at 1.5 of the critical strain", "1", largest(), reached,
          bar_solver_tolerance);
  compare(rows, "stress of this bar", "Pa", bar->stress(), problem.law.degradation(reached) * problem.stress(high),
          bar_solver_tolerance);
  // Irreversible: damage stays while the load falls to half of the critical strain and returns.
  for (const double strains : {0.5, 1.4})
  {
    const double stretch = problem.stretch(strains);
    load(stretch);
    compare(rows, "stress after unloading to " + std::string(strains < 1. ? "0.5" : "1.4") + " of the critical strain",
            "Pa", bar->stress(), problem.law.degradation(reached) * problem.stress(stretch), bar_solver_tolerance);
  }
  load(higher);
  compare(rows, "damage after loading again, to 1.6", "1", largest(), problem.damage(higher), bar_solver_tolerance);
}

// Order in the load step of the remainder of the ledger, eq. (C.65), while the bar softens. Over both stages their
// leading terms, of opposite signs, may cancel.
void ledger(const Problem &problem, const Rows &rows)
{
  constexpr unsigned int coarse = 8;
  double remainder[2] = {};
  for (const unsigned int i : {0u, 1u})
  {
    std::optional<DamagedBar> short_bar;
    DamagedBar &bar = emplace_short_bar(problem, short_bar);
    const unsigned int half = coarse << i; // load steps of the elastic stage; its end is the threshold
    const continuum::DamageLedger &ledger = bar.solver().ledger();
    double elastic = 0.;
    for (unsigned int n = 1; n <= 2 * half; ++n)
    {
      bar.stretch(problem.stretch(static_cast<double>(n) / half));
      if (n == half)
        elastic = ledger.imbalance;
    }
    remainder[i] = (ledger.imbalance - elastic) / ledger.work;
    if (i == 1)
    {
      const double d = problem.damage(problem.stretch(2.));
      compare(rows, "energy dissipated in a homogeneous bar", "J/m", ledger.fracture,
              2. * (1. - problem.law.residual_stiffness) * problem.law.threshold * d * bar.length() * bar.height(),
              bar_solver_tolerance);
    }
  }
  const double order = std::log2(std::abs(remainder[0] / remainder[1]));
  rows.add("remainder of the ledger: order in the load step", "1", of_continuum(order, 2.), std::abs(order - 2.),
           {0.2, "chosen: with eight steps the term of fourth order is below a sixth of that of second order"});
  rows.add("remainder of the ledger over the work, 16 load steps", "1", of_continuum(remainder[1]));
}

// Energy of a bar over that of a crack, and the bound of its error.
struct BrokenEnergy
{
  double ratio, tolerance;
};

// Energy of the crack, profile and symmetry of a bar of 8 xi that breaks, eqs. (C.67), (C.68).
BrokenEnergy broken_bar_rows(const Problem &problem, const Constitution &laws, unsigned int per_length,
                             const std::string &name, const Rows &rows, ClaimOutcome &outcome)
{
  const double xi = problem.law.length, h = xi / per_length;
  const std::string at = name + ", h = xi/" + std::to_string(per_length);
  // Breaks in its middle, beyond the threshold. The last load step opens the crack further.
  // The same stretch of the open column on all meshes: less of it leaves d below 1, and with more of it the residual
  // stiffness drives damage beside the crack. A gradient energy adds to that driving force, so that less is enough.
  const double last = laws.has_gradient() ? 6. : 120. / per_length;
  DamagedBar bar(laws, problem.planted, h, 8 * per_length + 1, problem.stretch(last));
  bar.weaken_middle(weakness);
  for (const double strains : {1.05, 1.5, 6., last})
    bar.stretch(problem.stretch(strains));
  // All of the elongation is in the column that is open. By (C.63) its sides miss d = 1 by up to
  // (W_c/W)(2 + 4 xi/h), since half of the column belongs to a node and Grad d is up to 1/xi beside it. To first order
  // S is G_c (d^{3/2} + 3/8 d h/xi), which falls by less than this; twice that.
  const double open = problem.stretch(last * bar.length() / h);
  const double missing = problem.law.threshold / problem.energy(open) * (2. + 4. * per_length);
  const double tolerance = 2. * missing * (1.5 + 0.375 / per_length) + 1e-6;
  const double ratio = bar.solver().field().fracture_energy() / (problem.law.fracture_energy() * bar.height());
  const double slope = h / xi;
  // The stress left by the residual stiffness drives damage beside the crack. To first order, with 1 - phi = s at the
  // next node, g rising linearly to s^2 towards it, and the Laplacian of (C.63) on a free half line, it adds at most
  const double s = slope * (1. - 0.25 * slope), k = problem.law.residual_stiffness;
  const double modulus = problem.material().tangent(uniaxial(1.))[0][0][0][0];
  const double driven = std::pow(k * problem.stress(open), 2) / (2. * modulus * problem.law.threshold) *
                        (1. + std::log(s * s / k)) / std::pow(s, 3) * slope * slope / 2.;
  compare(rows, "energy of a crack over G_c, " + at, "1", ratio, 1. + 0.375 * slope + slope * slope / 32.,
          output::limited(tolerance, 1e-6, 5e-3,
                          "twice what is missing of d = 1 beside the open column, (W_c/W) (2 + 4 xi/h)"));

  const std::vector<double> damage = bar.profile();
  support::LargestError off, asymmetry;
  output::Table &table = outcome.table("damaged_bar", {"shells", "law", "h/xi", "X/xi", "damage", "theory"});
  for (std::size_t i = 0; i < damage.size(); ++i)
  {
    const double X = (static_cast<double>(i) - 0.5 * static_cast<double>(damage.size() - 1)) * h;
    const double depth = 1. - (std::abs(X) - 0.5 * h) / (2. * xi);
    const double theory = depth < 0. ? 0. : depth * depth;
    off.add_difference(damage[i], theory);
    asymmetry.add_difference(damage[i], damage[damage.size() - 1 - i]);
    table.add({problem.subject.name, name, slope, X / xi, damage[i], theory});
  }
  // A change of d at the crack changes the others by less.
  rows.add(
    "damage at the nodes, largest error, " + at, "1", of_continuum(off.error()), off,
    output::limited(2. * missing + driven + *iteration_tolerance, 1e-5, 5e-3,
                    "what is missing of d = 1 beside the open column, twice; what the residual stiffness drives; "
                    "last change of the iteration"));
  rows.add("mirror symmetry of the damage, " + at, "1", of_continuum(asymmetry.error()), asymmetry,
           iteration_tolerance);
  return {ratio, tolerance};
}

void broken_bars(const Problem &problem, const DamageOptions &options, const Rows &rows, ClaimOutcome &outcome)
{
  std::vector<BrokenEnergy> energies;
  for (unsigned int n = 2; n <= options.finest; n *= 2)
    energies.push_back(broken_bar_rows(problem, problem.material(), n, "local", rows, outcome));
  // Second-order remainder of (C.68): (h/xi)^2 / 16 with h of the finer mesh. The errors of both meshes may add up.
  const BrokenEnergy &fine = energies.back(), &coarse = energies[energies.size() - 2];
  const double remainder = std::pow(1. / options.finest, 2) / 16.;
  compare(rows, "energy of a crack over G_c, extrapolated in h", "1", 2. * fine.ratio - coarse.ratio, 1. - remainder,
          output::limited((2. * fine.tolerance + coarse.tolerance) / (1. - remainder), 1e-6, 5e-3,
                          "twice the tolerance of the finer mesh and that of the coarser one"));
  // Gradient energies that depend on F may lose convexity where a crack opens (docs/limits.md).
  const Constitution gradient(problem.material(), *problem.subject.isotropic_gradient);
  broken_bar_rows(problem, gradient, 4, "gradient", rows, outcome);
}

// A sheet with uniform damage has g times the energy, that of the gradient included.
void degraded_energy(const Problem &problem, bool leaves_gradient, const Rows &rows)
{
  dealii::parallel::distributed::Triangulation<2> mesh(MPI_COMM_WORLD);
  const double size = 4. * problem.subject.spacing;
  continuum::make_rectangle(mesh, {size, size, 2, 2});
  continuum::DamageField field(mesh, problem.planted);
  constexpr double d = 0.5;
  field.set([](const dealii::Point<2> &) { return d; });
  const Constitution whole(problem.material(), *problem.subject.lattice_gradient);
  Constitution damaged = whole, local(problem.material()), damaged_local = local;
  damaged.factor = &field;
  damaged_local.factor = &field;
  const auto energy = [&](const Constitution &laws)
  {
    const continuum::Sheet sheet(mesh, laws, 3);
    continuum::Sheet::Vector u = sheet.make_owned();
    // Bent, with strains up to 0.3.
    sheet.for_each_owned_dof([&](const auto dof, unsigned int i, const dealii::Point<2> &X)
                             { u(dof) = 0.1 * (X[0] + (i == 0 ? 1. : 2.) * X[0] * X[1] / size); });
    u.compress(dealii::VectorOperation::insert);
    continuum::Sheet::Vector ghosted = sheet.make_ghosted();
    ghosted = u;
    return sheet.energy(ghosted);
  };
  const double own = energy(whole) - energy(local);
  const double remaining = leaves_gradient ? own : energy(damaged) - energy(damaged_local);
  compare(rows, "gradient energy with damage 0.5 over that without", "1", remaining / own, problem.law.degradation(d),
          output::limited(1e-12 * energy(whole) / std::abs(own), 1e-12, 1e-6,
                          "round-off of the difference from which it follows"));
}

} // namespace

ClaimOutcome damage_claim(const bridge::Subject &subject, const DamageLaw &law, const DamageOptions &options)
{
  ClaimOutcome outcome;
  const Rows rows(outcome.results, "damage", subject.name + ": ");
  DamageLaw planted = law;
  planted.threshold *= options.planted_toughness;
  rows.attempt("bars in tension",
               [&]
               {
                 const Problem problem{subject, law, planted, stretch_of_energy(subject.cauchy_born, law.threshold)};
                 rows.attempt("homogeneous bar", [&] { homogeneous_bar(problem, options.planted_healing, rows); });
                 rows.attempt("ledger of energies", [&] { ledger(problem, rows); });
                 rows.attempt("degraded gradient energy",
                              [&] { degraded_energy(problem, options.planted_undegraded_gradient, rows); });
                 rows.attempt("broken bars", [&] { broken_bars(problem, options, rows, outcome); });
               });
  if (options.has_motion)
    add_damage_motion_rows(subject, law, options, outcome);
  return outcome;
}

ClaimOutcome check_damage(const ClaimInput &input)
{
  DamageOptions options;
  options.finest = input.quick ? 4 : 8;
  return damage_claim(input.subject, bridge::damage_law(input.entries, input.subject), options);
}

} // namespace latcon::claims
