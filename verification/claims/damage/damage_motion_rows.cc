#include "verification/claims/damage/damage_motion_rows.h"

#include <cmath>
#include <limits>

#include "continuum/damage/damage_motion.h"
#include "support/largest_error.h"
#include "verification/claims/damage/damaged_bar.h"
#include "verification/claims/damage/smooth_motion_rows.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{
namespace
{

using continuum::DamageLaw;
using continuum::DamageMotion;
using continuum::DamageMotionSetup;
using dealii::Point;
using dealii::Tensor;

constexpr double density = 1e3;       // sets the unit of time alone
constexpr double strip_strain = 1e-2; // of the strip, small enough that its law is linear outside of the crack
constexpr double height = 12.;        // of the strip, over xi
constexpr double length = 40.;        // of the strip, over xi

Tensor<2, 2> stretched(double y)
{
  Tensor<2, 2> F;
  F[0][0] = 1.;
  F[1][1] = 1. + y;
  return F;
}

struct Strip
{
  const bridge::Subject &subject;
  DamageLaw law;
  double toughness; // planted factor of the threshold

  double xi() const { return law.length; }
  double energy(double y) const { return subject.cauchy_born.energy(stretched(y)); }
  // Speed of longitudinal waves across the strip [m/s].
  double speed() const { return std::sqrt(subject.cauchy_born.tangent(stretched(0.))[1][1][1][1] / density); }
  // Law with which the energy released by a unit of crack is `drive` times G_c.
  DamageLaw law_for(double drive) const
  {
    DamageLaw own = law;
    own.threshold = 3. / 16. * energy(strip_strain) * height / (drive * (1. - law.residual_stiffness));
    return own;
  }
};

struct Crack
{
  double advance = 0.;   // of the tip [m]
  double fracture = 0.;  // S [J/m]
  double imbalance = 0.; // [J/m]
  double asymmetry = 0.; // of the damage at the end
};

double tip(const DamageMotion &motion)
{
  constexpr double level = 0.9;
  const continuum::NodeGrid &grid = motion.grid();
  const double *d = motion.damage().nodal().data() + grid.cells_y / 2 * grid.columns();
  double X = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i + 1 < grid.columns(); ++i)
    if (d[i] >= level && d[i + 1] < level)
      X = (static_cast<double>(i) + (d[i] - level) / (d[i] - d[i + 1])) * grid.size_x;
  return X;
}

double asymmetry(const DamageMotion &motion)
{
  const continuum::NodeGrid &grid = motion.grid();
  const std::vector<double> &d = motion.damage().nodal();
  support::LargestError error;
  for (std::size_t j = 0; j < grid.rows(); ++j)
    for (std::size_t i = 0; i < grid.columns(); ++i)
      error.add_difference(d[j * grid.columns() + i], d[(grid.rows() - 1 - j) * grid.columns() + i]);
  return error.error();
}

DamageMotion strip(const Strip &problem, double drive, unsigned int per_length, double courant)
{
  const double xi = problem.xi(), h = xi / per_length, top = 0.5 * height * xi;
  DamageMotionSetup setup{
    {length * xi, 2. * top, static_cast<unsigned int>(length) * per_length,
     static_cast<unsigned int>(height) * per_length + 1}, // odd: the crack opens the row of cells in the middle
    stretched(strip_strain),
    problem.subject.cauchy_born.families(),
    {},
    density,
    problem.law_for(drive),
    {},
    {},
    courant * h / problem.speed()};
  setup.damage.threshold *= problem.toughness;
  for (const continuum::FibreFamily &family : setup.families)
    setup.dashpots.push_back({family.direction, family.weight,
                              continuum::derivatives(family.potential, 1.).second * xi / (3. * problem.speed())});
  setup.is_held = [top, h](const Point<2> &X, unsigned int) { return std::abs(X[1]) > top - 1e-3 * h; };
  setup.is_intact = [top, xi](const Point<2> &X) { return std::abs(X[1]) > top - 2. * xi; };
  return DamageMotion(setup);
}

// Growth of a crack from t_1 to t_2, in units of the time of a wave across the strip.
Crack growth(const Strip &problem, double drive, unsigned int per_length, double courant, double t_1, double t_2)
{
  DamageMotion motion = strip(problem, drive, per_length, courant);
  const double xi = problem.xi(), seed = 0.5 * height * xi;
  motion.set_damage(
    [&](const Point<2> &X)
    {
      const double below = std::abs(X[1]) - 0.5 * motion.grid().size_y;
      const double x = X[0] > seed ? X[0] - seed : 0., y = below > 0. ? below : 0.;
      const double left = 1. - std::hypot(x, y) / (2. * xi);
      return left > 0. ? left * left : 0.; // eq. (C.67)
    });
  const double unit = height * xi / problem.speed();
  Crack before, now;
  for (const double end : {t_1, t_2})
  {
    while (motion.time() < end * unit)
      motion.advance();
    before = now;
    now = {tip(motion), motion.ledger().fracture, motion.ledger().imbalance, asymmetry(motion)};
  }
  return {now.advance - before.advance, now.fracture - before.fracture, now.imbalance - before.imbalance,
          now.asymmetry};
}

// Fundamental mode of a bar in uniaxial strain with uniform damage, without viscosity.
void waves(const Strip &problem, const Rows &rows)
{
  constexpr unsigned int n = 16;
  constexpr double pi = 3.14159265358979323846, amplitude = 1e-7;
  const double omega = 2. * n * std::sin(0.5 * pi / n) *
                       std::sqrt(problem.subject.cauchy_born.tangent(stretched(0.))[0][0][0][0] / density);
  DamageMotionSetup setup{
    {1., 1. / n, n, 1}, stretched(0.), problem.subject.cauchy_born.families(), {}, density, problem.law_for(1.), {}, {},
    0.1 / omega};
  setup.is_held = [](const Point<2> &X, unsigned int i) { return i == 1 || X[0] < 1e-9 || X[0] > 1. - 1e-9; };
  DamageMotion motion(setup);
  motion.set_motion(
    [](const Point<2> &X) {
      return Tensor<1, 2>({amplitude * std::sin(pi * X[0]), 0.});
    },
    [](const Point<2> &) { return Tensor<1, 2>(); });
  motion.set_damage([](const Point<2> &) { return 0.5; });
  for (unsigned int step = 0; step < 15; ++step)
    motion.advance();
  // Velocity Verlet is exact for a frequency that is known.
  const double theory = std::cos(15. * 2. * std::asin(0.05));
  const double value = motion.displacement()[0][n / 2] / amplitude;
  rows.add("wave in a bar with damage 0.5, displacement after 1.5 radians", "1", of_continuum(value, theory),
           std::abs(value - theory), {1e-5, "non-linear terms: the strain 3e-7 times up to 30"});
}

struct Toughness
{
  double ratio, tolerance;
};

// Energy of a steady crack, its symmetry and its ledger.
Toughness steady_crack(const Strip &problem, unsigned int n, const Rows &rows)
{
  constexpr double drive = 1.3, courant = 0.3;
  const std::string at = ", h = xi/" + std::to_string(n);
  const Crack crack = growth(problem, drive, n, courant, 3., 6.);
  const double slope = 1. / n;
  const DamageLaw law = problem.law_for(drive);
  // Ends of the path that are uncertain by a tenth of it say nothing: a crack that hardly runs does not agree.
  const double advance = crack.advance > 3. * problem.xi() ? crack.advance : std::numeric_limits<double>::quiet_NaN();
  const double ratio = crack.fracture / (advance * law.fracture_energy());
  const double theory = 1. + 0.375 * slope + slope * slope / 32.;
  // The open row of cells has all of the elongation, so that d misses 1 as in the bars of this claim. The tip is
  // known to 0.3 of a cell at both times: its position between nodes is interpolated.
  const double open = strip_strain * height * n;
  const double missing = law.threshold / problem.energy(open) * (2. + 4. * n);
  const double tolerance = 2. * missing * (1.5 + 0.375 * slope) + 0.6 * slope * problem.xi() / advance * theory;
  rows.add("energy of a steady crack over G_c" + at, "1", of_continuum(ratio, theory), std::abs(ratio - theory),
           output::limited(tolerance, 0., 0.2 * theory,
                           "twice that of the broken bars, and 0.3 of a cell at both ends of the path: the tip is "
                           "interpolated between nodes"));
  rows.add("mirror symmetry of the damage" + at, "1", of_continuum(crack.asymmetry), crack.asymmetry,
           {100. * continuum::GridDamage::tolerance,
            "chosen: a hundred times the change at which the iteration for the damage ends, whose sweeps are not "
            "symmetric"});
  if (n == 2)
  {
    const Crack half = growth(problem, drive, n, 0.5 * courant, 3., 6.);
    const double remainder[] = {crack.imbalance / crack.fracture, half.imbalance / half.fracture};
    const double order = std::log2(std::abs(remainder[0] / remainder[1]));
    // Damage follows the displacement at the ends of steps: first order.
    rows.add("remainder of the ledger: order in the time step", "1", of_continuum(order, 1.), std::abs(order - 1.),
             {0.4, "chosen"});
    rows.add("remainder of the ledger over the energy of the crack, step 0.15 h/c", "1", of_continuum(remainder[1]));
    rows.add("advance of the crack with half the time step over that with the whole", "1",
             of_continuum(half.advance / crack.advance));
  }
  return {ratio, tolerance};
}

} // namespace

void add_damage_motion_rows(const bridge::Subject &subject, const DamageLaw &law, const DamageOptions &options,
                            ClaimOutcome &outcome)
{
  const Rows rows(outcome.results, "damage", subject.name + ": in motion, ");
  const Strip problem{subject, law, options.planted_toughness};
  rows.attempt("waves", [&] { waves(problem, rows); });
  rows.attempt("smooth deformations", [&] { add_smooth_motion_rows(subject, rows); });
  rows.attempt(
    "strip without a seed",
    [&]
    {
      DamageMotion motion = strip(problem, 1.3, 2, 0.3);
      for (unsigned int step = 0; step < 20; ++step)
        motion.advance();
      support::LargestError damage;
      for (const double d : motion.damage().nodal())
        damage.add(d);
      rows.add("damage of a strip without a seed", "1", of_continuum(damage.error(), 0.), damage, {0., "exactly"});
    });
  rows.attempt("crack below its toughness",
               [&]
               {
                 const double advance = growth(problem, 0.9, 2, 0.3, 4., 6.).advance / (height * law.length);
                 rows.add("advance of a crack driven by 0.9 G_c, over the height", "1", of_continuum(advance, 0.),
                          std::abs(advance), {1e-3, "chosen: the front stands still"});
               });
  rows.attempt("steady crack",
               [&]
               {
                 (void)steady_crack(problem, 2, rows);
                 if (options.finest > 4)
                 {
                   const Toughness coarse = steady_crack(problem, 4, rows), fine = steady_crack(problem, 8, rows);
                   const double ratio = 2. * fine.ratio - coarse.ratio;
                   rows.add("energy of a steady crack over G_c, extrapolated in h", "1", of_continuum(ratio, 1.),
                            std::abs(ratio - 1.),
                            output::limited(2. * fine.tolerance + coarse.tolerance, 0., 0.2,
                                            "twice the tolerance of the finer mesh and that of the coarser one"));
                 }
               });
}

} // namespace latcon::claims
