#include "lattice/fracture.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/reference_forces.h"
#include "tests/lattice/running_crack.h"

namespace fracture_test
{

using namespace latcon;

using namespace lattice;

// Ten sites of a free lattice of nearest neighbours, named (row, column); the eleventh, (2, 3), is cut out:
//
//   row 2     o   o   o   x
//   row 1       o   o   o
//   row 0     o   o   o   o
struct TenSites
{
  explicit TenSites(Toughening toughening, double breaking_stretch = 1.5)
    : sheet(1., 3., std::sqrt(3.), Orientation::rows_along_crack), material(sheets::nearest_only()),
      forces(sheet, material), fracture(sheet, material, breaking_stretch, toughening, Eigen::Matrix2d::Identity()),
      state(homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free))
  {
    fracture.configure(state, forces);
    EXPECT_EQ(sheet.n_sites(), 11u);
    EXPECT_EQ(fracture.remove_sites(state, {sheet.index(2, 3)}), 0.); // undeformed bonds hold no energy
  }

  std::vector<BrokenBond> apply()
  {
    forces.evaluate(state, state.velocity);
    return fracture.apply(state, forces, state.velocity);
  }

  std::size_t n_bonds() const
  {
    std::size_t n = 0;
    for_each_bond(state, sheet, [&](const Bond &) { ++n; });
    return n;
  }

  double limit(std::size_t row, std::size_t column, std::size_t kind) const
  {
    const std::size_t place = sheet.index(row, column);
    return state.bonds.present(place, kind) ? breaking_stretch_of(state, sheet.bond(place, kind)) : 0.;
  }

  TriangularLattice sheet;
  Material material;
  Forces forces;
  Fracture fracture;
  State state;
};

// Rows hold 3 + 2 + 3 bonds, the gaps 6 each; the cut corner takes one of a row and one of a gap with it.
TEST(Fracture, CuttingASiteTakesItsBonds)
{
  const TenSites sheet{Toughening{}};
  EXPECT_EQ(sheet.n_bonds(), 20u - 2u);
  EXPECT_EQ(sheet.state.lost_bonds[sheet.sheet.index(2, 2)], 1);
  EXPECT_EQ(sheet.state.lost_bonds[sheet.sheet.index(1, 2)], 1);
  EXPECT_EQ(sheet.state.inverse_mass[sheet.sheet.index(2, 3)], 0.);
}

// Site (0, 0) pulled to the left by 0.6: its bond along the row comes to 1.6, the one at 60 degrees to
// sqrt(1.1^2 + 3/4) = 1.4. Only the first is beyond 1.5.
TEST(Fracture, BreaksWhatIsBeyondTheLimitForGood)
{
  TenSites sheet{Toughening{}};
  const std::size_t corner = sheet.sheet.index(0, 0);
  sheet.state.position.x[corner] -= 0.6;
  const std::vector<BrokenBond> broken = sheet.apply();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].near, corner);
  EXPECT_EQ(broken[0].far, corner + 1);
  EXPECT_EQ(broken[0].kind, 0u);
  EXPECT_NEAR(broken[0].stretch, 1.6, 1e-14);
  EXPECT_NEAR(broken[0].X, 0.5, 1e-14);
  EXPECT_NEAR(broken[0].Y, -std::sqrt(3.) / 2., 1e-14);
  const double volume = cross_section(sheet.material.nearest, sheet.sheet) * 1.;
  EXPECT_NEAR(broken[0].energy, volume * energy(sheet.material.nearest.law, 1.6), 1e-9);
  EXPECT_EQ(sheet.n_bonds(), 17u);
  EXPECT_EQ(sheet.state.lost_bonds[corner], 1);
  EXPECT_EQ(sheet.state.lost_bonds[corner + 1], 1);

  // Only the other bond still pulls on the corner, already in the same evaluation.
  sheet.forces.evaluate(sheet.state, sheet.state.velocity);
  const Eigen::Vector2d pull = sheet.forces.on_sites().at(corner);
  EXPECT_NEAR(pull.normalized().dot(Eigen::Vector2d(1.1, std::sqrt(0.75)).normalized()), 1., 1e-12);

  sheet.state.position.x[corner] += 0.6; // back home: still broken
  EXPECT_TRUE(sheet.apply().empty());
  EXPECT_EQ(sheet.n_bonds(), 17u);
  EXPECT_EQ(sheet.limit(0, 0, 0), 0.);
}

// A bond within a few units in the last place of its limit, and a little farther, in many directions: the row is
// flagged if and only if the bond breaks, or toughens, whether breaking looks ahead or not.
TEST(Fracture, FlagsARowIfAndOnlyIfOneOfItsBondsHasAnEvent)
{
  const TriangularLattice sheet = sheets::square(8);
  const Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  const std::size_t row = 4, near = sheet.index(row, 3);
  int n_events = 0, n_none = 0;
  for (const auto &[ahead, material] : {std::pair(0., sheets::rubber()),
                                        {1e-6, sheets::rubber()},
                                        {0., sheets::disordered_rubber()},
                                        {1e-6, sheets::disordered_rubber()}})
    for (const bool breaks : {true, false})
      for (const std::size_t kind : {std::size_t{1}, std::size_t{4}})
      {
        State state = homogeneous_state(sheet, material, F, Edges::free);
        state.bonds.clear(sheet.n_places());
        const double strength = bond_factors(sheet, material, BondProperty::strength).of(near, kind);
        // 1.5 is the limit of a bond of mean strength, 0.8 the fraction of retraction.
        const double limit = breaks ? 1.5 * strength : 0.8, l = sheet.rest_length(kind);
        const std::size_t far = sheet.bond(near, kind).far;
        for (int direction = 0; direction < 60; ++direction)
          for (const int ulps : {-9999, -3, -2, -1, 0, 1, 2, 3, 9999})
          {
            State trial = state;
            trial.bonds.add(near, kind);
            const double angle = 0.1 * direction + 0.01, speed = 100. * (direction % 7 - 3);
            const Eigen::Vector2d n(std::cos(angle), std::sin(angle)), v(speed * n.x(), speed * n.y());
            const double length = limit * l * (1. + ulps * 0x1p-53);
            trial.position.x[near] = trial.position.y[near] = 0.;
            trial.position.x[far] = length * n.x() - ahead * v.x();
            trial.position.y[far] = length * n.y() - ahead * v.y();
            trial.velocity.set(far, v);
            Forces forces(sheet, material);
            // Rows are screened by the limit that all bonds have, unless there is retraction or disorder.
            const Toughening toughening = breaks && kind == 1 ? Toughening{} : Toughening{2., 0.8};
            Fracture fracture(sheet, material, 1.5, toughening, F);
            fracture.configure(trial, forces);
            forces.evaluate(trial, trial.velocity, {}, nullptr, ahead);
            const bool flagged = forces.row_sums(row).has_events;
            // Applied to a sheet with all rows flagged, by another bond of each that is far beyond its limit.
            State crowded = trial;
            const std::size_t other = sheet.index(row, 0);
            crowded.bonds.add(other, 0);
            crowded.position.x[other + 1] = crowded.position.x[other] + 9. * l;
            forces.evaluate(crowded, crowded.velocity, {}, nullptr, ahead);
            fracture.apply(crowded, forces, crowded.velocity);
            const bool happened = breaks ? !crowded.bonds.present(near, kind) : crowded.bonds.toughened(near, kind);
            EXPECT_EQ(flagged, happened) << ahead << ' ' << limit << ' ' << kind << ' ' << direction << ' ' << ulps;
            if (std::abs(ulps) > 3)
            {
              EXPECT_EQ(happened, (ulps > 0) == breaks) << ahead << ' ' << limit << ' ' << kind << ' ' << direction;
            }
            ++(happened ? n_events : n_none);
          }
      }
  EXPECT_GT(n_events, 200);
  EXPECT_GT(n_none, 200);
}

// Six bonds at most: the tip needs two losses. The corner's two bonds go; then its neighbours have lost one each.
TEST(Fracture, TipIsTheRightMostSiteThatLostAQuarterOfItsBonds)
{
  TenSites sheet{Toughening{}};
  EXPECT_FALSE(sheet.fracture.tip());
  sheet.state.position.x[sheet.sheet.index(0, 0)] -= 2.;
  EXPECT_EQ(sheet.apply().size(), 2u);
  ASSERT_TRUE(sheet.fracture.tip());
  EXPECT_EQ(*sheet.fracture.tip(), sheet.sheet.index(0, 0));
  // (0, 1) sinks: it loses (0, 2), (1, 0), (1, 1); now three of its own four are gone, and (1, 1) at X = 1.5 has lost
  // one.
  sheet.state.position.y[sheet.sheet.index(0, 1)] -= 2.;
  sheet.apply();
  EXPECT_EQ(*sheet.fracture.tip(), sheet.sheet.index(0, 1));
  // (0, 0) further left changes nothing; the tip never goes back.
  sheet.state.position.x[sheet.sheet.index(2, 0)] -= 2.;
  sheet.apply();
  EXPECT_EQ(*sheet.fracture.tip(), sheet.sheet.index(0, 1));
}

// In a state that was cut or loaded from outside the tip may be any site.
TEST(Fracture, FindsTheTipWhereverItIs)
{
  const TenSites whole{Toughening{}};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < whole.sheet.sites_in_row(row); ++column)
    {
      TenSites sheet{Toughening{}};
      const std::size_t place = sheet.sheet.index(row, column);
      sheet.state.lost_bonds[place] = 3;
      sheet.fracture.locate_tip(sheet.state);
      if (sheet.state.removed[place] != 0)
        EXPECT_FALSE(sheet.fracture.tip());
      else
        EXPECT_EQ(sheet.fracture.tip(), place);
    }
}

// Each bond alone, those of held sites among them.
TEST(Fracture, LeavesHeldSitesHeld)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = 2. * Eigen::Matrix2d::Identity();
  const State whole = homogeneous_state(sheet, material, F, Edges::held);
  for_each_bond(whole, sheet,
                [&](const Bond &bond)
                {
                  State state = whole;
                  state.bonds.clear(sheet.n_places());
                  state.bonds.add(bond.near, bond.kind);
                  Forces forces(sheet, material);
                  Fracture fracture(sheet, material, 1.5, Toughening{}, F);
                  fracture.configure(state, forces);
                  forces.evaluate(state, state.velocity);
                  EXPECT_EQ(fracture.apply(state, forces, state.velocity).size(), 1u);
                  EXPECT_EQ(state.held, whole.held);
                });
}

// A state has bonds that never break until a Fracture sets their limits. A site is pulled aside: the bond that is
// toughened comes to 1.6 of 1.5, others come to less.
TEST(Fracture, OwnsTheBreakingStretch)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.4, 1.4);
  State state = homogeneous_state(sheet, material, F, Edges::held);
  const std::size_t near = sheet.index(4, 3), far = near + 1;
  EXPECT_EQ(breaking_stretch_of(state, sheet.bond(near, 0)), unbreakable);
  // Which must not pass silently for bonds that hold.
  Forces forces(sheet, material);
  forces.evaluate(state, state.velocity);
  EXPECT_THROW(Fracture(sheet, material, 1.5, Toughening{}, F).apply(state, forces, state.velocity), std::logic_error);
  state.position.x[far] += 0.2 * sheets::spacing;
  state.bonds.toughen(near, 0);
  // Of all bonds the longest is not the nearest to its limit.
  const std::optional<StretchedBond> nearest =
    Fracture(sheet, material, 1.5, Toughening{2.}, F).nearest_to_breaking(state);
  ASSERT_TRUE(nearest);
  EXPECT_EQ(nearest->limit, 1.5);
  for_each_bond(state, sheet,
                [&](const Bond &bond)
                {
                  const bool is_toughened = bond.near == near && bond.kind == 0;
                  EXPECT_TRUE(is_toughened || stretch(state, sheet, bond) <= nearest->stretch);
                });
  const auto n_broken = [&](const Toughening &toughening)
  {
    Simulation simulation(sheet, material, state, 1e-12, Fracture(sheet, material, 1.5, toughening, F));
    simulation.step();
    return simulation.n_broken();
  };
  const std::size_t all = n_broken(Toughening{});
  EXPECT_GT(all, 1u);
  EXPECT_EQ(n_broken(Toughening{1.}), all);
  EXPECT_EQ(n_broken(Toughening{2.}), all - 1);
  EXPECT_EQ(n_broken(Toughening{unbreakable}), all - 1);
  EXPECT_EQ(n_broken(Toughening{2., 0., 1.}), all - 1);
  EXPECT_EQ(n_broken(Toughening{2., 0.5}), all - 1);
  EXPECT_EQ(n_broken(Toughening{1., 0.5}), all);
}

// A held site that is cut out is no longer held and does not move with its edge.
TEST(Fracture, CutsHeldSitesOutForGood)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.2, 1.2);
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, F, Edges::held), 1e-9,
                        Fracture(sheet, material, 3., Toughening{}, F));
  const std::size_t corner = sheet.index(0, 0), next = sheet.index(0, 1);
  simulation.cut({corner});
  simulation.constrain({held_sites(simulation.state(), sheet), true, true, steady(sheets::stretched(400., 200.))});
  simulation.step();
  EXPECT_EQ(simulation.state().held[corner], 0);
  EXPECT_EQ(simulation.state().velocity.x[corner], 0.);
  EXPECT_EQ(simulation.state().velocity.y[corner], 0.);
  EXPECT_NE(simulation.state().velocity.y[next], 0.);
}

// Bonds cut on a schedule leave the sheet whatever their stretch, once; what they held is in the ledger.
TEST(Fracture, CutsGivenBonds)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.2, 1.3);
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, F, Edges::held), 1e-9,
                        Fracture(sheet, material, unbreakable, Toughening{}, F));
  const double before = simulation.energies().elastic;
  const std::size_t place = sheet.index(4, 3);
  simulation.cut_bonds({{place, 0}, {place, 4}, {place, 0}});
  simulation.cut_bonds({{place, 4}});
  EXPECT_FALSE(simulation.state().bonds.present(place, 0));
  EXPECT_FALSE(simulation.state().bonds.present(place, 4));
  EXPECT_TRUE(simulation.state().bonds.present(place, 1));
  EXPECT_EQ(simulation.state().lost_bonds[place], 2);
  const EnergyBalance energies = simulation.energies();
  EXPECT_GT(energies.broken, 0.);
  EXPECT_NEAR(energies.elastic + energies.broken, before, 1e-12 * before);
  // The forces are those without the bonds: the site is no longer in equilibrium.
  EXPECT_NE(simulation.state().acceleration.x[place], 0.);
  EXPECT_THROW(simulation.cut_bonds({{place, n_bond_kinds}}), std::invalid_argument);
  EXPECT_THROW(simulation.cut_bonds({{sheet.index(0, 0) - 1, 0}}), std::invalid_argument);
}

// Bond (2, 0)-(2, 1) squeezed to 0.7 of its loaded stretch, which is 1 here, toughens at fraction 0.8; the others do
// not.
TEST(Fracture, ToughensOnRetraction)
{
  TenSites sheet{Toughening{2., 0.8}};
  sheet.state.position.x[sheet.sheet.index(2, 0)] += 0.15;
  sheet.apply();
  EXPECT_EQ(sheet.limit(2, 0, 0), 1.5); // 0.85: not yet
  sheet.state.position.x[sheet.sheet.index(2, 0)] += 0.15;
  sheet.apply();
  EXPECT_EQ(sheet.limit(2, 0, 0), 3.);
  EXPECT_EQ(sheet.limit(0, 0, 0), 1.5);
  EXPECT_EQ(sheet.limit(2, 1, 0), 1.5);
  sheet.apply();
  EXPECT_EQ(sheet.limit(2, 0, 0), 3.);           // once
  sheet.state.position.x[sheet.sheet.index(2, 0)] -= 1.3; // stretch 2
  for (const BrokenBond &bond : sheet.apply())
    EXPECT_NE(bond.near, sheet.sheet.index(2, 0));
  EXPECT_EQ(sheet.limit(2, 0, 0), 3.);
}

// Bonds are toughened in a strip that follows the tip: after every step exactly those behind its boundary are. The
// tip advances by several spacings.
TEST(Fracture, ToughensAllBondsBehindARunningTip)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    const double distance = 2.2 * sheets::spacing, side = 40. * sheets::spacing;
    const TriangularLattice sheet(sheets::spacing, side, side, orientation);
    running_crack::Choice choice;
    choice.stepping = {4e-6, 7};
    choice.toughening = Toughening{2., 0., distance};
    choice.noise = 0.01;
    const auto crack = running_crack::start(sheet, choice);
    Simulation &simulation = *crack;
    ASSERT_TRUE(simulation.tip());
    double first_tip = 0., tip = 0.;
    for (int step = 0; step <= 220; ++step)
    {
      if (step > 0)
        simulation.step();
      tip = sheet.reference(*simulation.tip()).x();
      if (step == 0)
        first_tip = tip;
      std::size_t wrong = 0;
      for_each_bond(simulation.state(), sheet,
                    [&](const Bond &bond)
                    {
                      const double midpoint = sheet.reference(bond.near).x() + 0.5 * sheet.bond_vector(bond.kind).x();
                      wrong +=
                        simulation.state().bonds.toughened(bond.near, bond.kind) != (midpoint < tip - distance) ? 1 : 0;
                    });
      ASSERT_EQ(wrong, 0u) << "after step " << step << ", tip at " << tip;
    }
    EXPECT_GT(tip, first_tip + 8. * sheets::spacing);
  }
}

TEST(Fracture, RefusesRulesOutOfRange)
{
  EXPECT_THROW(TenSites(Toughening{0.5}), std::invalid_argument);
  const TriangularLattice periodic(1., 10., 10., Orientation::rows_along_crack, {true, false});
  EXPECT_THROW(Fracture(periodic, sheets::rubber(), 3., Toughening{}, Eigen::Matrix2d::Identity()),
               std::invalid_argument);
  TenSites sheet(Toughening{});
  EXPECT_THROW(sheet.forces.evaluate(sheet.state, sheet.state.velocity, {}, nullptr, -1.), std::invalid_argument);
  EXPECT_THROW(TenSites(Toughening{}, 0.), std::invalid_argument);
  EXPECT_THROW(TenSites(Toughening{2., 0., -1.}), std::invalid_argument);
  EXPECT_THROW(TenSites(Toughening{0.5, 0., 1.}), std::invalid_argument);
  EXPECT_THROW(TenSites(Toughening{2., 1.2}), std::invalid_argument);
}

} // namespace fracture_test
