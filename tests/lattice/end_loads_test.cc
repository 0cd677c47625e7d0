#include "lattice/end_loads.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/sheets.h"

namespace end_loads_test
{

using namespace latcon;

using namespace lattice;
using End = EndLoads::End;

Eigen::Matrix2d sheared()
{
  Eigen::Matrix2d F;
  F << 2.3, 0.4, 0., 2.8;
  return F;
}

class Ends : public testing::TestWithParam<std::tuple<Orientation, bool>>
{
protected:
  Orientation orientation() const { return std::get<0>(GetParam()); }
  Material material() const { return std::get<1>(GetParam()) ? sheets::rubber(0.) : sheets::nearest_only(0.); }
};
INSTANTIATE_TEST_SUITE_P(
  EndLoads, Ends,
  testing::Combine(testing::Values(Orientation::rows_along_crack, Orientation::rows_across_crack), testing::Bool()));

// Neither end held: the loaded sheet stays in equilibrium to round-off of the forces of single bonds.
// theory.md, eqs. (L.6) and (L.15).
TEST_P(Ends, KeepTheLoadedSheetInEquilibrium)
{
  const TriangularLattice sheet = sheets::square(14, orientation());
  const Material bonds = material();
  Simulation simulation(sheet, bonds, homogeneous_state(sheet, bonds, sheared(), {false, false, true, true}), 1e-7);
  const auto largest_residual = [&]
  {
    double largest = 0.;
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      largest = support::largest_of(
        {largest, std::hypot(simulation.state().acceleration.x[place], simulation.state().acceleration.y[place])});
    return largest * site_mass(bonds, sheet) / (cross_section(bonds.nearest, sheet) * force(bonds.nearest.law, 2.5));
  };
  EXPECT_GT(largest_residual(), 0.5);
  simulation.load_ends(sheared(), End::free, End::absorbing);
  EXPECT_LT(largest_residual(), 1e-13);
}

// (W.1) for a long wave along x: omega^2 = p . D p, the sines evaluated at k d = 1e-3.
TEST_P(Ends, TangentIsThatOfLongWaves)
{
  const TriangularLattice sheet = sheets::square(14, orientation());
  const Material bonds = material();
  const double k = 1e-3 / sheets::spacing;
  // Forces of a wave on a site, from the energy of its bonds: differences of the axial force, no formula for h.
  const Eigen::Matrix2d F = sheared();
  const auto bond_force = [&](const Shell &shell, const Eigen::Vector2d &r, double l) -> Eigen::Vector2d
  { return cross_section(shell, sheet) * force(shell.law, r.norm() / l) * r.normalized(); };
  Eigen::Matrix2d dynamical = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i)
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      if (const Shell *shell = bonds.shell(kind))
      {
        const Eigen::Vector2d R = sheet.bond_vector(kind);
        const double step = 1e-6 * sheets::spacing, l = sheet.rest_length(kind);
        const Eigen::Vector2d e = step * Eigen::Vector2d::Unit(i);
        const Eigen::Vector2d stiffness =
          (bond_force(*shell, F * R + e, l) - bond_force(*shell, F * R - e, l)) / (2. * step);
        dynamical.col(i) += 4. * std::pow(std::sin(0.5 * k * R.x()), 2) / site_mass(bonds, sheet) * stiffness;
      }
  const Eigen::Matrix2d tangent = tangent_along_x(sheet, bonds, F);
  EXPECT_LT((bonds.density / (k * k) * dynamical - tangent).norm(), 1e-5 * tangent.norm());
}

// Largest velocity that a pulse of the given width [spacings] leaves behind after it has met the right end, over its
// own. `balance`: the ledger at the end, `energy`: of the pulse, twice its kinetic one.
double reflection(const Material &bonds, Orientation orientation, const Eigen::Vector2d &polarisation, double width,
                  bool held, EnergyBalance *balance = nullptr, double *energy = nullptr)
{
  const double d = sheets::spacing, distance = 6. * width;
  const TriangularLattice sheet(d, 2. * distance * d, 8. * d, orientation, {false, true});
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  const double speed = std::sqrt(polarisation.dot(tangent_along_x(sheet, bonds, F) * polarisation) / bonds.density);
  State state = homogeneous_state(sheet, bonds, F, {false, held, true, true});
  VectorField velocity(sheet.n_places());
  const double amplitude = 1e-3 * d, middle = sheet.length() - distance * d;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    const double z = (sheet.reference(place).x() - middle) / (width * d);
    const double u = amplitude * std::exp(-0.5 * z * z);
    if (state.held[place] != 0)
      continue;
    state.position.add(place, u * polarisation);
    velocity.set(place, speed * z / (width * d) * u * polarisation);
  }
  const double largest = speed / (width * d) * amplitude * std::exp(-0.5);
  Simulation simulation(sheet, bonds, std::move(state),
                        0.9 * time_step_limits(sheet, bonds, 1., {}, end_impedance(sheet, bonds, F)).combined);
  simulation.load_ends(F, End::absorbing, held ? End::held : End::absorbing);
  simulation.set_velocities(velocity);
  if (energy != nullptr)
    *energy = 2. * simulation.energies().kinetic;
  const double end = 2. * distance * d / speed;
  while (simulation.state().time < end)
    simulation.step();
  if (balance != nullptr)
    *balance = simulation.energies();
  double left = 0.;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    if (simulation.state().inverse_mass[place] > 0.)
      left = support::largest_of(
        {left, std::hypot(simulation.state().velocity.x[place], simulation.state().velocity.y[place])});
  return left / largest;
}

// The end site's own mass and the bonds it lacks are a layer of about half a spacing: reflection of order k d / 2,
// first order in the wave number, k d = 1 / width.
// theory.md, eq. (L.16).
TEST_P(Ends, AbsorbPulsesAndHeldOnesReflectThem)
{
  for (const Eigen::Vector2d &polarisation : {Eigen::Vector2d(1., 0.), Eigen::Vector2d(0., 1.)})
  {
    EnergyBalance e{};
    double energy = 0.;
    const double fine = reflection(material(), orientation(), polarisation, 16., false, &e, &energy);
    const double coarse = reflection(material(), orientation(), polarisation, 8., false);
    EXPECT_LT(fine, 0.03);
    EXPECT_NEAR(coarse / fine, 2., 0.2);
    // The pulse is gone from the sheet, and the ledger knows where to.
    EXPECT_LT(e.kinetic, 1e-3 * energy);
    EXPECT_LT(std::abs(e.imbalance()), 1e-3 * energy);
    EXPECT_NEAR(reflection(material(), orientation(), polarisation, 8., true), 1., 0.05);
  }
}

// Branches that hardly relax while a pulse passes: it is faster than in the relaxed sheet, and so is what ends absorb.
// Relaxed ends would reflect (sqrt2 - 1) / (sqrt2 + 1) = 0.17 of each pulse where branches double the stiffness.
// Linear springs without dashpots leave the least room for those of the end: their stiffness, and so the stable step,
// does not depend on the stretch, and at large stretch their waves are fastest.
TEST(EndLoads, AbsorbFastPulses)
{
  Material springs = sheets::nearest_only(0.);
  springs.nearest.law = LinearBond{1e5};
  Material branches = springs;
  branches.nearest.memory = MaxwellMemory({{1e5, 1.}});
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    EXPECT_LT(reflection(branches, orientation, {1., 0.}, 16., false), 0.03);
    EXPECT_LT(reflection(springs, orientation, {1., 0.}, 8., false), 0.1);
  }
}

// Without dashpots of bonds those of the ends decide on the step. A sheet of springs in random motion only loses
// energy.
TEST(EndLoads, ShortenTheStepOfSprings)
{
  Material springs = sheets::rubber(0.);
  springs.nearest.law = springs.next_nearest->law = LinearBond{1e5};
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    const TriangularLattice sheet = sheets::square(12, orientation);
    const Eigen::Matrix2d F = sheets::stretched(2., 2.);
    State state = homogeneous_state(sheet, springs, F, {false, false, true, true});
    add_noise(state, sheet, 0.01, 1);
    Simulation simulation(sheet, springs, std::move(state),
                          0.9 * time_step_limits(sheet, springs, 1., {}, end_impedance(sheet, springs, F)).combined);
    simulation.load_ends(F, End::absorbing, End::absorbing);
    const double before = simulation.energies().elastic;
    for (int i = 0; i < 2000; ++i)
      simulation.step();
    EXPECT_LT(simulation.energies().elastic + simulation.energies().kinetic, before);
  }
}

// Loads are on free sites of ends that are loaded, nowhere else, whatever the other edges are.
TEST_P(Ends, LoadTheirFreeSitesAlone)
{
  const TriangularLattice sheet = sheets::square(14, orientation());
  const Material bonds = material();
  for (const bool held : {true, false}) // the long edges
    for (const auto &[left, right] : {std::pair{End::free, End::held}, std::pair{End::held, End::absorbing}})
    {
      State state = homogeneous_state(sheet, bonds, sheared(), {false, false, held, held});
      EndLoads loads(sheet, bonds, state, sheared(), left, right);
      const std::vector<SiteForce> &forces = loads.evaluate(state, state.velocity);
      EXPECT_FALSE(forces.empty());
      for (const SiteForce &on : forces)
      {
        EXPECT_EQ(state.held[on.place], 0);
        EXPECT_EQ(sheet.reference(on.place).x() < 0.5 * sheet.length(), right == End::held);
      }
    }
}

TEST(EndLoads, NeedWavesToAbsorb)
{
  const TriangularLattice sheet = sheets::square(10);
  Material material = sheets::nearest_only();
  material.nearest.law = LinearBond{1e5};
  // Bonds pressed to a tenth push sideways harder than they resist.
  const Eigen::Matrix2d F = sheets::stretched(0.1, 0.1);
  const State state = homogeneous_state(sheet, material, F, {true, false, true, true});
  EXPECT_THROW(EndLoads(sheet, material, state, F, End::held, End::absorbing), std::invalid_argument);
  EXPECT_NO_THROW(EndLoads(sheet, material, state, F, End::held, End::free));
}

} // namespace end_loads_test
