#include "lattice/contact.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <omp.h>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

namespace contact_test
{

using namespace latcon;

using namespace lattice;

// A sheet of which loose sites are left: free, without bonds, having lost some.
State loose_sites(const TriangularLattice &sheet, const Material &material, const std::vector<std::size_t> &places)
{
  State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free);
  state.bonds.clear(sheet.n_places());
  const double inverse_mass = 1. / site_mass(material, sheet);
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    state.removed[place] = sheet.is_site(place) ? 1 : 0;
    state.inverse_mass[place] = 0.;
  }
  for (const std::size_t place : places)
  {
    state.removed[place] = 0;
    state.inverse_mass[place] = inverse_mass;
    state.lost_bonds[place] = 1;
  }
  return state;
}

constexpr double touching_distance = 0.9 * sheets::spacing;
constexpr double approach = 3.; // m/s

// Two sites that fly at each other along a line at 30 degrees, with a common velocity besides.
struct HeadOn
{
  HeadOn(const ContactLaw &law, double time_step, double gap)
    : sheet(sheets::square(10)), material(sheets::rubber()), left(sheet.index(4, 2)), right(sheet.index(7, 5)),
      direction(std::sqrt(3.) / 2., 0.5)
  {
    State state = loose_sites(sheet, material, {left, right});
    const Eigen::Vector2d far = state.position.at(left) + (law.distance + gap) * direction;
    state.position.set(right, far);
    const Eigen::Vector2d common(7., -2.);
    const Eigen::Vector2d v_left = common + 0.5 * approach * direction, v_right = common - 0.5 * approach * direction;
    state.velocity.set(left, v_left);
    state.velocity.set(right, v_right);
    simulation = std::make_unique<Simulation>(sheet, material, std::move(state), time_step);
    simulation->enable_contact(law);
  }
  Eigen::Vector2d velocity(std::size_t place) const
  {
    return {simulation->state().velocity.x[place], simulation->state().velocity.y[place]};
  }
  double distance() const
  {
    const State &state = simulation->state();
    return std::hypot(state.position.x[right] - state.position.x[left],
                      state.position.y[right] - state.position.y[left]);
  }
  double separation_speed() const { return (velocity(right) - velocity(left)).dot(direction); }

  TriangularLattice sheet;
  Material material;
  std::size_t left, right;
  Eigen::Vector2d direction;
  std::unique_ptr<Simulation> simulation;
};

// beta = c / (2 M), omega_0^2 = k / M, M half the mass of a site.
ContactLaw law_of(double omega_0, double beta)
{
  const double reduced_mass = 0.5 * site_mass(sheets::rubber(), sheets::square(10));
  return {touching_distance, reduced_mass * omega_0 * omega_0, 2. * reduced_mass * beta};
}

// Theory.md, eq. (L.13).
double duration(double omega_0, double beta)
{
  if (beta < omega_0)
  {
    const double omega = std::sqrt(omega_0 * omega_0 - beta * beta);
    return std::atan2(2. * beta * omega, beta * beta - omega * omega) / omega;
  }
  const double rate = std::sqrt(beta * beta - omega_0 * omega_0);
  return std::log((beta + rate) / (beta - rate)) / rate;
}
double restitution(double omega_0, double beta)
{
  return std::exp(-beta * duration(omega_0, beta));
}

constexpr double omega_0 = 1e5; // 1/s

// Relative error of the restitution for steps of 1 / `steps` of the duration, from the moment of touching on.
double restitution_error(double beta, std::size_t steps, double gap)
{
  const double time_step = duration(omega_0, beta) / static_cast<double>(steps);
  HeadOn pair(law_of(omega_0, beta), time_step, gap);
  for (std::size_t step = 0; step < 2 * steps; ++step)
    pair.simulation->step();
  EXPECT_EQ(pair.simulation->contact()->last().size(), 0u) << "still in touch";
  return pair.separation_speed() / approach / restitution(omega_0, beta) - 1.;
}

using Restitution = testing::TestWithParam<double>;
INSTANTIATE_TEST_SUITE_P(Contact, Restitution, testing::Values(0., 0.1, 0.6, 0.95, 1.05, 2.));

// Starting in touch the force is smooth to its end, where it has a kink: second order.
// theory.md, eqs. (L.12) and (L.13).
TEST_P(Restitution, ConvergesToTheClosedFormAtSecondOrder)
{
  const double beta = GetParam() * omega_0, hair = -1e-9 * sheets::spacing;
  const double coarse = restitution_error(beta, 100, hair), fine = restitution_error(beta, 400, hair);
  EXPECT_LT(std::abs(fine), 1e-4);
  // The end falls anywhere into a step, so the error is not smooth in h: between a bit less and a lot more.
  EXPECT_GT(std::abs(coarse), 8. * std::abs(fine));
}

TEST_P(Restitution, KeepsMomentumAndLedger)
{
  const double beta = GetParam() * omega_0;
  const ContactLaw law = law_of(omega_0, beta);
  HeadOn pair(law, duration(omega_0, beta) / 400., 0.05 * sheets::spacing);
  const Eigen::Vector2d before = pair.velocity(pair.left) + pair.velocity(pair.right);
  double smallest = 0.;
  for (int step = 0; step < 2000; ++step)
  {
    pair.simulation->step();
    const EnergyBalance e = pair.simulation->energies();
    const double overlap = std::max(0., law.distance - pair.distance());
    const double dissipated = e.contact - 0.5 * law.stiffness * overlap * overlap;
    smallest = std::min(smallest, dissipated);
    // h^2 (a . f) / 4 at most while they touch: (omega_0 h)^2 + (2 beta h)^2 of the energy of the impact.
    ASSERT_LT(std::abs(e.imbalance()), 1e-3 * e.initial) << step;
  }
  const EnergyBalance e = pair.simulation->energies();
  EXPECT_LT(pair.separation_speed(), approach * (1. + 1e-4));
  EXPECT_GT(pair.separation_speed(), 0.01 * approach);
  EXPECT_LT((pair.velocity(pair.left) + pair.velocity(pair.right) - before).norm(), 1e-13 * before.norm());
  EXPECT_LT(std::abs(e.imbalance()), 1e-12 * e.initial); // out of touch it closes to round-off
  EXPECT_GT(smallest, -1e-4 * e.initial);
}

TEST(Contact, OfBondedOrWholeSitesThereIsNone)
{
  const TriangularLattice sheet = sheets::square(10);
  const Material material = sheets::rubber();
  const std::size_t a = sheet.index(4, 4);
  // All sites have lost one bond, are too close, and are bonded to those they are close to.
  State state = homogeneous_state(sheet, material, 0.8 * Eigen::Matrix2d::Identity(), Edges::free);
  const auto n_touching = [&]
  {
    Contact contact(sheet, contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 1.));
    contact.find_candidates(state);
    return contact.evaluate(state, state.velocity).size() / 2;
  };
  EXPECT_EQ(n_touching(), 0u); // whole
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    state.lost_bonds[place] = sheet.is_site(place) ? 1 : 0;
  EXPECT_EQ(n_touching(), 0u); // bonded
  state.bonds.remove(a, 0);
  EXPECT_EQ(n_touching(), 1u);
  state.lost_bonds[a] = 0;
  EXPECT_EQ(n_touching(), 0u); // a site that has lost none is no candidate
  state.lost_bonds[a] = 1;
  state.removed[a] = 1;
  EXPECT_EQ(n_touching(), 0u); // nor is one that was cut out
}

TEST(Contact, RefusesLawsOutOfRange)
{
  const TriangularLattice sheet = sheets::square(10);
  EXPECT_THROW(Contact(sheet, {0., 1., 0.}), std::invalid_argument);
  EXPECT_THROW(Contact(sheet, {1., 0., 0.}), std::invalid_argument);
  EXPECT_THROW(Contact(sheet, {1., 1., -1.}), std::invalid_argument);
}

// Hundreds of sites fly about and more join them, as if bonds had broken: at every step the forces are those of all
// pairs, in the order of places.
TEST(Contact, ListNeverMissesAPair)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = sheets::rubber();
  const std::vector<std::size_t> places = sheet.sites();
  State state = loose_sites(sheet, material, places);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  for (const std::size_t place : places)
  {
    state.position.x[place] += sheets::spacing * uniform(generator);
    state.position.y[place] += sheets::spacing * uniform(generator);
    state.velocity.x[place] = uniform(generator) + (place % 7 == 0 ? 5. * uniform(generator) : 0.);
    state.velocity.y[place] = uniform(generator);
    state.lost_bonds[place] = place % 3 == 0 ? 1 : 0;
  }
  const ContactLaw law{sheets::spacing, 1e5, 10.};
  Contact contact(sheet, law);
  contact.find_candidates(state);
  std::size_t touched = 0;
  for (std::size_t step = 0; step < 300; ++step)
  {
    for (const std::size_t place : places)
    {
      state.position.x[place] += 0.02 * sheets::spacing * state.velocity.x[place];
      state.position.y[place] += 0.02 * sheets::spacing * state.velocity.y[place];
    }
    const std::size_t near = places[(step * 37) % places.size()], far = places[(step * 101 + 5) % places.size()];
    if (near != far)
    {
      state.lost_bonds[near] = state.lost_bonds[far] = 1;
      contact.add_broken_bonds({{{near, 0, far}, 0., 0., 0., 1., 0.}});
    }
    const std::vector<SiteForce> &forces = contact.evaluate(state, state.velocity);
    std::vector<SiteForce> wanted;
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t j = i + 1; j < places.size(); ++j)
      {
        const std::size_t a = places[i], b = places[j];
        if (state.lost_bonds[a] == 0 || state.lost_bonds[b] == 0)
          continue;
        const Eigen::Vector2d between = state.position.at(b) - state.position.at(a);
        const double r = between.norm();
        const Eigen::Vector2d rate = state.velocity.at(b) - state.velocity.at(a);
        const double repulsion = law.stiffness * (law.distance - r) - law.viscosity * rate.dot(between) / r;
        if (r >= law.distance || repulsion <= 0.)
          continue;
        wanted.push_back({a, -repulsion / r * between});
        wanted.push_back({b, repulsion / r * between});
      }
    ASSERT_EQ(forces.size(), wanted.size()) << step;
    for (std::size_t i = 0; i < wanted.size(); ++i)
    {
      ASSERT_EQ(forces[i].place, wanted[i].place) << step;
      ASSERT_LT((forces[i].force - wanted[i].force).norm(), 1e-10 * law.stiffness * law.distance);
    }
    touched += wanted.size() / 2;
  }
  EXPECT_GT(touched, 1000u);
}

// A bond that breaks while it is pressed together: its ends overlap when they become a pair.
TEST(Contact, LedgerClosesWhereAPairOverlapsFromTheStart)
{
  const TriangularLattice sheet = sheets::square(10);
  const Material material = sheets::rubber();
  const std::size_t left = sheet.index(5, 4), right = left + 1;
  const auto balance = [&](double time_step)
  {
    State state = loose_sites(sheet, material, {left, right});
    state.bonds.add(left, 0);
    state.position.x[right] = state.position.x[left] + 0.8 * sheets::spacing;
    Simulation simulation(sheet, material, std::move(state), time_step,
                          Fracture(sheet, material, 0.5, Toughening{}, Eigen::Matrix2d::Identity()));
    simulation.enable_contact(contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 0.));
    const auto steps = static_cast<int>(std::lround(4e-5 / time_step));
    simulation.step();
    EXPECT_EQ(simulation.n_broken(), 1u);
    EXPECT_EQ(simulation.contact()->last().size(), 2u) << "the contact must begin as the bond ends";
    for (int step = 1; step < steps; ++step)
      simulation.step();
    return simulation.energies();
  };
  const EnergyBalance coarse = balance(4e-7), fine = balance(1e-7);
  EXPECT_GT(fine.broken, 0.5 * fine.initial);
  // The energy that appeared in the spring is kinetic now. The step in which the bond breaks changes the overlap by a
  // few percent.
  const double stiffness = contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 0.).stiffness;
  EXPECT_NEAR(fine.contact / (-0.5 * stiffness * std::pow(0.2 * sheets::spacing, 2)), 1., 0.05);
  EXPECT_LT(std::abs(fine.imbalance()), 1e-3 * fine.initial);
  EXPECT_GT(std::abs(coarse.imbalance()), 8. * std::abs(fine.imbalance()));
}

// Pairs and forces in the same order, with the same bits, for any number of threads that share them.
TEST(Contact, ListsDoNotDependOnThreads)
{
  const TriangularLattice sheet = sheets::square(80);
  const Material material = sheets::rubber();
  const std::vector<std::size_t> places = sheet.sites();
  State state = loose_sites(sheet, material, places);
  add_noise(state, sheet, 0.3 * sheets::spacing, 1);
  const auto forces = [&](int threads)
  {
    omp_set_num_threads(threads);
    Contact contact(sheet, contact_like_nearest_bond(sheet, material, 1.1 * sheets::spacing, 1., 1.));
    contact.find_candidates(state);
    return contact.evaluate(state, state.velocity);
  };
  const int before = omp_get_max_threads();
  const std::vector<SiteForce> one = forces(1);
  EXPECT_GT(one.size(), 8192u); // so many that threads share them
  for (const int threads : {2, 3})
  {
    const std::vector<SiteForce> several = forces(threads);
    ASSERT_EQ(several.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i)
    {
      ASSERT_EQ(several[i].place, one[i].place);
      ASSERT_EQ(several[i].force, one[i].force);
    }
  }
  omp_set_num_threads(before);
}

} // namespace contact_test
