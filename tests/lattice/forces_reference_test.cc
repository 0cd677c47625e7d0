// Forces of all kinds of sheets against a plain implementation, with all instruction sets.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include <omp.h>

#include <gtest/gtest.h>

#include "lattice/forces.h"
#include "tests/lattice/nonlocal_sheets.h"
#include "tests/lattice/reference_forces.h"
#include "tests/lattice/running_crack.h"

namespace forces_reference_test
{

using namespace latcon;

using namespace lattice;
using running_crack::same_bits;

double viscous_power(const Forces &forces, const TriangularLattice &sheet)
{
  double sum = 0.;
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    sum += forces.row_sums(row).viscous_power;
  return sum;
}

// Variants of a sheet: material, orientation, periodic direction, and number of sites in a row.
struct Subject
{
  Material material;
  Orientation orientation;
  Periodic periodic;
  double columns;
};

Material linear()
{
  Material material = sheets::rubber();
  material.nearest.law = LinearBond{2e5};
  material.next_nearest->law = LinearBond{3e5};
  return material;
}

// One shell with a law from outside, the other with one of latcon's.
Material mixed()
{
  Material material = sheets::rubber();
  material.nearest.law = sheets::from_outside(LinearBond{2e5});
  return material;
}

// Bonds of one stiffness and one shell with a law from outside.
Material differently_strong()
{
  Material material = sheets::without_next_nearest(sheets::rubber_from_outside());
  material.disorder.strength = {Distribution::Kind::uniform, 0.2};
  return material;
}

std::vector<Subject> subjects()
{
  std::vector<Subject> all;
  // Few and many columns, of all remainders that a vector of up to eight sites leaves.
  for (const double columns : {3., 10., 11., 12., 13., 14., 15., 16., 17., 40.})
    for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
      for (const Material &material :
           {sheets::rubber(), sheets::nearest_only(), linear(), sheets::rubber_from_outside(), mixed(),
            sheets::rubber_with_branches(), sheets::disordered_rubber(), differently_strong(),
            sheets::without_next_nearest(sheets::rubber_of_three_shells()),
            sheets::disordered_rubber_of_three_shells()})
        for (const Periodic periodic : {Periodic{}, Periodic{true, false}, Periodic{false, true}, Periodic{true, true}})
          all.push_back({material, orientation, periodic, columns});
  return all;
}

TriangularLattice sheet_of(const Subject &subject, double rows = 11.)
{
  const double along = subject.columns * sheets::spacing, across = rows * sheets::spacing;
  const bool along_x = subject.orientation == Orientation::rows_along_crack;
  return {sheets::spacing, along_x ? along : across, along_x ? across : along, subject.orientation, subject.periodic};
}

constexpr double first_limit = 2.6, toughened_limit = 4.; // breaking stretches in a random state

// Sites all over the place at random velocities, bonds that are broken, overstretched or toughened, sites removed with
// a neighbour on the very spot.
State random_state(const TriangularLattice &sheet, const Material &material, unsigned int seed)
{
  std::mt19937 random(seed);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0., 1.)(random); };
  State state = homogeneous_state(sheet, material, sheets::stretched(1.6, 1.9), Edges::free);
  relax_memory(state, sheet, material);
  for (BondHistory::Kind &history : state.history.kinds)
    for (Field &variable : history.variables)
      for (double &overstress : variable)
        overstress = 1e5 * (uniform() - 0.5);
  state.breaking_stretch = first_limit;
  state.toughened_stretch = toughened_limit;
  state.strength = bond_factors(sheet, material, BondProperty::strength);
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    if (!sheet.is_site(place))
      continue;
    state.position.x[place] += 0.5 * sheets::spacing * (uniform() - 0.5);
    state.position.y[place] += 0.5 * sheets::spacing * (uniform() - 0.5);
    state.velocity.x[place] = 40. * (uniform() - 0.5);
    state.velocity.y[place] = 40. * (uniform() - 0.5);
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    {
      const double lot = uniform();
      if (!state.bonds.present(place, kind))
        continue;
      if (lot < 0.1)
        state.bonds.remove(place, kind);
      else if (lot < 0.2)
        state.bonds.toughen(place, kind);
    }
  }
  const std::size_t removed = sheet.index(sheet.rows() / 2, 1), neighbour = removed + 1;
  for_each_bond_of_site(state, sheet, removed, [&](const Bond &bond) { state.bonds.remove(bond.near, bond.kind); });
  state.position.x[removed] = state.position.x[neighbour];
  state.position.y[removed] = state.position.y[neighbour];
  update_images(state, sheet);
  return state;
}

const std::vector<double> retraction{1.3, 1.35, 1.4, 1.3, 1.35, 1.4, 1.3, 1.35, 1.4};

// theory.md, eqs. (L.3) and (L.4), and with the memory of bonds (L.27).
TEST(Forces, AreThoseOfTheReference)
{
  bool some_retract_alone = false;
  for (const Subject &subject : subjects())
  {
    const TriangularLattice sheet = sheet_of(subject);
    SCOPED_TRACE(testing::Message() << sheet.rows() << " rows of " << sheet.columns() << ", periodic "
                                    << subject.periodic.x << subject.periodic.y << ", "
                                    << subject.material.coordination() << " neighbours");
    const State state = random_state(sheet, subject.material, 1);
    Forces forces(sheet, subject.material);
    for (const bool watch : {false, true})
    {
      if (watch)
        forces.set_retraction_threshold(retraction);
      forces.evaluate(state, state.velocity);
      const ReferenceForces expected = watch ? reference_forces(state, sheet, subject.material, retraction)
                                             : reference_forces(state, sheet, subject.material);
      for (std::size_t place = 0; place < sheet.n_places(); ++place)
      {
        // A bond takes some 20 roundings, a sum of up to eighteen takes 18, and the reference as many.
        const double tolerance = 80. * std::numeric_limits<double>::epsilon() * expected.magnitude[place];
        ASSERT_NEAR(forces.on_sites().x[place], expected.fx[place], tolerance) << place;
        ASSERT_NEAR(forces.on_sites().y[place], expected.fy[place], tolerance);
      }
      // All terms are positive, so the sum is as good as its terms and its number of additions: a few thousand.
      ASSERT_NEAR(viscous_power(forces, sheet), expected.viscous_power, 1e-12 * expected.viscous_power);
      for (std::size_t row = 0; row < sheet.rows(); ++row)
        ASSERT_EQ(forces.row_sums(row).has_events, expected.row_has_events[row]) << row;
      if (watch)
        some_retract_alone |=
          expected.row_has_events != reference_forces(state, sheet, subject.material).row_has_events;
    }
  }
  EXPECT_TRUE(some_retract_alone);
}

// Stretch of the shortest bond of each row after a time at its rate now, linear bonds left out.
std::vector<double> shortest_bonds(const State &state, const TriangularLattice &sheet, const Material &material,
                                   double ahead)
{
  std::vector<double> shortest(sheet.rows(), 1e9);
  for_each_bond(state, sheet,
                [&](const Bond &bond)
                {
                  if (std::holds_alternative<LinearBond>(material.shell(sheet, bond.kind)->law))
                    return;
                  const double l = sheet.rest_length(bond.kind) / sheet.length_ratio(bond.near, bond.kind);
                  const Eigen::Vector2d x = state.position.at(bond.far) - state.position.at(bond.near),
                                        v(state.velocity.x[bond.far] - state.velocity.x[bond.near],
                                          state.velocity.y[bond.far] - state.velocity.y[bond.near]);
                  double &of_row = shortest[sheet.row_of(bond.near)];
                  of_row = std::min(of_row, (x.norm() + ahead * std::min(0., v.dot(x.normalized()))) / l);
                });
  return shortest;
}

// Rows with a bond that is, or at its rate now will be, shorter than a limit, and no others, of lattices and stencils.
TEST(Forces, FindRowsWithShortBonds)
{
  std::size_t n_short = 0, n_others = 0;
  const auto check = [&](const TriangularLattice &sheet, const Material &material)
  {
    const State state = random_state(sheet, material, 3);
    Forces forces(sheet, material);
    forces.evaluate(state, state.velocity);
    for (std::size_t row = 0; row < sheet.rows(); ++row)
      EXPECT_FALSE(forces.row_sums(row).has_short_bonds); // none are watched
    const auto expect = [&](const std::vector<double> &shortest, double limit, const auto &has_short)
    {
      for (std::size_t row = 0; row < sheet.rows(); ++row)
      {
        if (std::abs(shortest[row] / limit - 1.) > 1e-12) // a row at the limit may be either
        {
          EXPECT_EQ(has_short(row), shortest[row] < limit) << row << ' ' << limit;
        }
        ++(shortest[row] < limit ? n_short : n_others);
      }
    };
    for (const double limit : {0.9, 1., 1.1, 1.2})
    {
      forces.set_shortness_threshold(limit);
      forces.evaluate(state, state.velocity);
      expect(shortest_bonds(state, sheet, material, 0.), limit,
             [&](std::size_t row) { return forces.row_sums(row).has_short_bonds; });
    }
    if (std::holds_alternative<LinearBond>(material.nearest.law))
      return;
    forces.set_shortness_threshold(1e3);
    forces.evaluate(state, state.velocity);
    for (const double ahead : {0., 1e-6, 1e-4})
      for (const double limit : {0.5, 0.9, 1.1})
        expect(shortest_bonds(state, sheet, material, ahead), limit,
               [&](std::size_t row)
               { return forces.row_has_short_bonds_ahead(state, state.velocity, row, ahead, limit); });
  };
  for (const Subject &subject : subjects())
    check(sheet_of(subject), subject.material);
  check(nonlocal_sheets::sheet(Grid::Kind::square, 2., 12., 10.), sheets::rubber());
  check(nonlocal_sheets::sheet(Grid::Kind::square, 2., 12., 10., 30., Orientation::rows_along_crack, 0.5),
        sheets::rubber());
  EXPECT_GT(n_short, 100u);
  EXPECT_GT(n_others, 100u);
}

TEST(Forces, BitsDoNotDependOnTheInstructionSet)
{
  const std::vector<std::string> sets = kernels::instruction_sets();
  EXPECT_EQ(kernels::loops().instruction_set, sets.front());
  // Without vectors; Highway has one for compilers that it trusts with its emulated ones.
  EXPECT_TRUE(sets.back() == "SCALAR" || sets.back() == "EMU128") << sets.back();
  EXPECT_THROW(kernels::use_instruction_set("none"), std::invalid_argument);
  for (const Subject &subject : subjects())
  {
    const TriangularLattice sheet = sheet_of(subject);
    const State state = random_state(sheet, subject.material, 5);
    Forces best(sheet, subject.material), other(sheet, subject.material);
    for (Forces *forces : {&best, &other})
      forces->set_retraction_threshold(retraction);
    kernels::use_instruction_set(sets.front());
    best.evaluate(state, state.velocity);
    for (const std::string &set : sets)
    {
      kernels::use_instruction_set(set);
      ASSERT_EQ(kernels::loops().instruction_set, set);
      other.evaluate(state, state.velocity);
      ASSERT_TRUE(same_bits(other.on_sites().x, best.on_sites().x)) << set;
      ASSERT_TRUE(same_bits(other.on_sites().y, best.on_sites().y)) << set;
      ASSERT_EQ(viscous_power(other, sheet), viscous_power(best, sheet)) << set;
      for (std::size_t row = 0; row < sheet.rows(); ++row)
        ASSERT_EQ(other.row_sums(row).has_events, best.row_sums(row).has_events) << set;
    }
  }
  kernels::use_instruction_set(sets.front());
}

// What the first thread does beside the rows decides how many of them it evaluates.
TEST(Forces, BitsDoNotDependOnWhatIsDoneBeside)
{
  const Subject subject{sheets::rubber_with_branches(), Orientation::rows_along_crack, {false, true}, 300.};
  const TriangularLattice sheet = sheet_of(subject, 30.);
  ASSERT_GT(sheet.n_places(), 2 * min_places_for_threads);
  const State state = random_state(sheet, subject.material, 5);
  const int threads_before = omp_get_max_threads();
  std::optional<State> expected;
  for (const auto &[threads, duration] : {std::pair(1, 0), {2, 0}, {2, 50}, {2, 2000}, {3, 50}, {3, 2000}, {40, 50}})
  {
    omp_set_num_threads(threads);
    Forces forces(sheet, subject.material);
    const auto sleep = [caller = std::this_thread::get_id(), duration = duration]
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      std::this_thread::sleep_for(std::chrono::microseconds(duration));
    };
    for (int time = 0; time < 5; ++time)
    {
      State moved = state;
      forces.set_elapsed(1e-6);
      forces.evaluate(
        state, state.velocity,
        [&](std::size_t row, const Forces::OfRow &force)
        { std::copy_n(force[0], sheet.columns(), &moved.acceleration.x[sheet.index(row, 0)]); },
        &moved.history, 0., sleep);
      const auto fail = [] { throw std::domain_error("beside"); };
      EXPECT_THROW(forces.evaluate(state, state.velocity, {}, nullptr, 0., fail), std::domain_error);
      if (!expected)
        expected = moved;
      ASSERT_TRUE(same_bits(moved.acceleration.x, expected->acceleration.x)) << threads << ' ' << duration;
      for (std::size_t kind = 0; kind < sheet.n_kinds(); ++kind)
        for (std::size_t v = 0; v < moved.history.kinds[kind].variables.size(); ++v)
          ASSERT_TRUE(same_bits(moved.history.kinds[kind].variables[v], expected->history.kinds[kind].variables[v]));
    }
  }
  omp_set_num_threads(threads_before);
}

// Some time after an update of memories, bonds taken out one by one, in whatever order, leave the power of a sheet that
// never had them, and single sites feel the forces of an evaluation of all, to the last bit.
TEST(Forces, AfterRemovingBondsAreThoseWithoutThem)
{
  const auto check = [](const TriangularLattice &sheet, const Material &material)
  {
    State state = random_state(sheet, material, 3);
    std::vector<Bond> bonds;
    for_each_bond(state, sheet,
                  [&](const Bond &bond)
                  {
                    if ((7 * bond.near + bond.kind) % 10 < 3)
                      bonds.push_back(bond);
                  });
    std::mt19937 random(4);
    std::shuffle(bonds.begin(), bonds.end(), random);
    Forces forces(sheet, material), without(sheet, material);
    forces.set_elapsed(3e-5);
    without.set_elapsed(3e-5);
    forces.evaluate(state, state.velocity);
    const double power = viscous_power(forces, sheet);
    for (const Bond &bond : bonds)
      state.bonds.remove(bond.near, bond.kind);
    for (std::size_t row = 0; row < sheet.rows(); ++row)
      forces.evaluate_row(state, state.velocity, row, {});
    without.evaluate(state, state.velocity);
    for (const std::size_t place : sheet.sites())
      ASSERT_EQ(forces.on_sites().at(place), without.on_sites().at(place));
    ASSERT_LT(viscous_power(without, sheet), 0.9 * power);
    ASSERT_EQ(viscous_power(forces, sheet), viscous_power(without, sheet));
  };
  for (const Subject &subject : subjects())
    check(sheet_of(subject), subject.material);
  for (const Periodic periodic : {Periodic{}, Periodic{true, true}})
    for (const Material &material : {sheets::rubber_with_memory(), sheets::plastic_rubber()})
      check(sheet_of({material, Orientation::rows_along_crack, periodic, 13.}), material);
  for (const double scatter : {0., 0.5})
    check(nonlocal_sheets::sheet(Grid::Kind::square, 2., 12., 10., 30., Orientation::rows_along_crack, scatter),
          sheets::disordered_rubber());
}

// Ends a process that starts anew, since the variable of the environment is read once.
void use_kernels()
{
  const TriangularLattice sheet = sheets::square(8);
  const State state = homogeneous_state(sheet, sheets::rubber(), sheets::stretched(1.2, 1.3), Edges::held);
  Forces forces(sheet, sheets::rubber());
  forces.evaluate(state, state.velocity);
  std::fprintf(stderr, "uses %s, best of %zu\n", kernels::loops().instruction_set, kernels::instruction_sets().size());
  std::exit(0);
}

TEST(InstructionSets, AreLimitedByTheEnvironment)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string last = kernels::instruction_sets().back(); // the same in that process
  const char *const name = "LATCON_INSTRUCTION_SET", *const before = std::getenv(name);
  setenv(name, last.c_str(), 1);
  EXPECT_EXIT(use_kernels(), testing::ExitedWithCode(0), "uses " + last + ", best of 1\n");
  before != nullptr ? setenv(name, before, 1) : unsetenv(name);
}

} // namespace forces_reference_test
