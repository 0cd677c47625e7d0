// Claims about memories of bonds, and what makes them fail.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "tests/lattice/sheets.h"
#include "tests/verification/claims/faults.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/relaxation/relaxation_claim.h"
#include "verification/claims/viscoelastic_waves/viscoelastic_waves_claim.h"

namespace memory_claims_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using lattice::Material;
using lattice::MaxwellMemory;
using Branch = MaxwellMemory::Branch;

// The rubber of the paper with two branches in nearest-neighbour bonds, three in the others, and little viscosity.
input::Case case_with_branches()
{
  input::Case input = subjects::paper_case();
  input.nearest.viscosity = 5.;
  input.nearest.branch_moduli = {2e5, 1e5};
  input.nearest.relaxation_times = {2e-5, 2e-4};
  input.next_nearest.viscosity = 15.;
  input.next_nearest.branch_moduli = {3e5, 1e5, 5e4};
  input.next_nearest.relaxation_times = {1e-5, 5e-5, 1e-3};
  return input;
}

// A fault of the branches of nearest neighbours.
struct PlantedFault
{
  const char *name;
  std::function<void(std::vector<Branch> &)> change;

  Material operator()(Material material) const
  {
    std::vector<Branch> branches = std::get<MaxwellMemory>(material.nearest.memory).branches();
    change(branches);
    material.nearest.memory = MaxwellMemory(branches);
    return material;
  }
};
const PlantedFault relaxation_time{"a relaxation time 1 % off",
                                   [](auto &branches) { branches.front().relaxation_time *= 1.01; }},
  modulus{"a modulus 1 % off", [](auto &branches) { branches.front().modulus *= 1.01; }},
  another{"another branch", [](auto &branches) {
            branches.push_back({1e5, 1e-4});
          }};

ViscoelasticWavesOptions waves_at_rest()
{
  ViscoelasticWavesOptions options;
  options.states = {Eigen::Matrix2d::Identity()};
  options.frequencies = {0.3, 0.6, 1., 1.7, 3.};
  return options;
}

void expect_holds(const output::Results &results)
{
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(20);
}

TEST(Relaxation, FollowsTheClosedForm)
{
  for (const input::Case &input : {case_with_branches(), subjects::paper_case()})
    for (const Material &material : {input.material(), subjects::nearest_only(input)})
    {
      const ClaimOutcome outcome = relaxation_claim(subject(input, material), {});
      expect_holds(outcome.results);
      EXPECT_EQ(outcome.results.rows().size(), 15u); // five for each integrator, and for finite elements
    }
}

// Stretches of small strains have few digits. For the largest, branches are in next-nearest bonds alone.
TEST(Relaxation, HoldsForSmallStrains)
{
  for (const double strain : {1e-6, 1e-4, 0.011})
  {
    input::Case input = case_with_branches();
    input.strain_x = input.strain_y = strain;
    if (strain > 0.01)
      input.nearest.branch_moduli = input.nearest.relaxation_times = {};
    SCOPED_TRACE(strain);
    expect_holds(relaxation_claim(subject(input), {}).results);
  }
}

// A branch that relaxes within a stable time step: the energy imbalance is that of the trapezoidal rule, to round-off.
TEST(Relaxation, ResolvesTheShortestRelaxationTime)
{
  input::Case input = case_with_branches();
  input.nearest.relaxation_times = {5e-8, 2e-7};
  input.has_next_nearest = false;
  const ClaimOutcome outcome = relaxation_claim(subject(input), {});
  expect_holds(outcome.results);
  std::size_t n_rows = 0;
  for (const output::Result &row : outcome.results.rows())
    if (row.quantity.find("energy imbalance") != std::string::npos &&
        row.quantity.find("finite elements") == std::string::npos) // whose updates are exact
    {
      ++n_rows;
      EXPECT_LT(row.tolerance.value(), 1e-9) << row.quantity;
      // The branch loses energy within few steps.
      EXPECT_GT(std::abs(row.lattice.value()), 1e-4) << row.quantity;
    }
  EXPECT_EQ(n_rows, 2u);
}

TEST(Relaxation, FailsForWrongBranches)
{
  for (const PlantedFault &fault : {relaxation_time, modulus, another})
  {
    RelaxationOptions options;
    options.planted = fault;
    const output::Results results = relaxation_claim(subject(case_with_branches()), options).results;
    for (const char *quantity : {"velocity Verlet, first Piola stress", "Chebyshev, first Piola stress",
                                 "energy stored", "energy dissipated", "finite elements, first Piola stress",
                                 "finite elements, energy stored", "finite elements, energy dissipated"})
      EXPECT_GE(faults::failing(results, quantity), 1u) << fault.name << ": " << quantity;
  }
  // Memories of other programs have no continuum: rows say so.
  RelaxationOptions options;
  options.planted = [](Material material)
  {
    material.nearest.memory = sheets::memory_from_outside({2e5, 2e-5});
    return material;
  };
  EXPECT_GE(faults::failing(relaxation_claim(subject(case_with_branches()), options).results, "finite elements"), 1u);
}

// Dashpots so strong that no wave oscillates leave no frequency and no decay.
TEST(MemoryWaves, AreNoNumbersWhereNothingOscillates)
{
  const input::Case input = subjects::paper_case();
  const lattice::TriangularLattice sheet = input.lattice();
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const Eigen::Vector2d K(0.7 / input.spacing, 0.);
  Material material = without_memory(input.material());
  const double first = material.nearest.viscosity;
  int alone = 0;
  for (double factor = 0.001; factor < 10.; factor *= 1.2) // a longitudinal wave stops sooner
  {
    material.nearest.viscosity = factor * first;
    if (material.next_nearest)
      material.next_nearest->viscosity = factor * first;
    const auto waves = memory_waves(sheet, material, I, K);
    const auto expected = plane_waves(bloch_matrices(sheet, material, I, K), wave_normal(I, K));
    for (std::size_t w = 0; w < 2; ++w)
      if (expected[w].frequency > 0.)
        EXPECT_NEAR(waves[w].frequency(), expected[w].frequency, 1e-8 * expected[w].frequency) << factor << ' ' << w;
      else
        EXPECT_TRUE(std::isnan(waves[w].frequency()) && std::isnan(waves[w].decay()) &&
                    std::isnan(waves[w].polarisation[0].real()))
          << factor << ' ' << w;
    alone += (expected[0].frequency > 0.) != (expected[1].frequency > 0.) ? 1 : 0;
  }
  EXPECT_TRUE(std::isnan(memory_waves(sheet, material, I, K)[0].frequency()));
  EXPECT_GT(alone, 0);
}

// theory.md, eq. (L.30) on the lattice; theory-viscoelastic.md, eqs. (V.6) and (V.8) in finite elements, whose waves
// without gradient part have the order 2, not 4.
TEST(ViscoelasticWaves, FollowTheComplexModulus)
{
  const input::Case input = case_with_branches();
  ViscoelasticWavesOptions options = waves_at_rest();
  const ClaimOutcome nearest = viscoelastic_waves_claim(subject(input, subjects::nearest_only(input)), options);
  expect_holds(nearest.results);
  EXPECT_EQ(nearest.results.rows().size(), 15u); // nine of closed forms and the lattice, six of finite elements
  options.states = {input.deformation()};
  options.frequencies = {0.6, 1., 1.7};
  options.element_frequencies = {};
  expect_holds(viscoelastic_waves_claim(subject(input), options).results);
  // A nearly buckled sheet: its slow wave does not oscillate with a branch that relaxes as fast as the other one moves.
  Material linear = subjects::nearest_only(subjects::paper_case());
  linear.nearest.law = lattice::LinearBond(2.35e5);
  options.states = {Eigen::Vector2d(0.7, 1.03).asDiagonal().toDenseMatrix()};
  expect_holds(viscoelastic_waves_claim(subject(input, linear), options).results);
  // Springs and branches of a sheared sheet have different axes.
  options.states = {(Eigen::Matrix2d() << 2., 1., 0., 2.).finished()};
  expect_holds(viscoelastic_waves_claim(subject(input, subjects::nearest_only(input)), options).results);
  // A wave that the branch damps so strongly that its frequency is below the rubbery limit, and one that it overdamps.
  Material stiffens_little = linear;
  stiffens_little.nearest.law = lattice::MooneyRivlinBond(0., 2.5e5);
  options.states = {Eigen::Vector2d(3., 1.03).asDiagonal().toDenseMatrix(),
                    Eigen::Vector2d(3.5, 1.05).asDiagonal().toDenseMatrix()};
  options.frequencies = {0.1, 0.3, 0.6};
  expect_holds(viscoelastic_waves_claim(subject(input, stiffens_little), options).results);
}

// Of a small fault; Relaxation.FailsForWrongBranches has all.
TEST(ViscoelasticWaves, FailForWrongBranches)
{
  const input::Case input = case_with_branches();
  ViscoelasticWavesOptions options = waves_at_rest();
  options.frequencies = {1.};
  options.planted = relaxation_time;
  const output::Results results =
    viscoelastic_waves_claim(subject(input, subjects::nearest_only(input)), options).results;
  for (const std::string side : {", lattice run", ", finite elements"})
    for (const std::string quantity :
         {"one branch, frequency", "one branch, decay", "own branches, frequency", "own branches, decay"})
      EXPECT_GE(faults::failing(results, quantity + side), 1u) << quantity << side;
}

} // namespace memory_claims_test
