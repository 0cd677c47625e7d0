// Claims against constants that are wrong by 1 % on one side: the row that catches each. A claim that cannot fail
// claims nothing.
#include <gtest/gtest.h>

#include <iostream>
#include <map>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/small_sheet.h"
#include "verification/claims/energy/contact_rows.h"
#include "verification/claims/energy/energy_claim.h"
#include "verification/claims/energy/wave_energy.h"
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"
#include "verification/claims/prestretch/cut_study.h"
#include "verification/claims/wave_speeds/absorbing_end.h"
#include "verification/claims/wave_speeds/wave_speeds_claim.h"

namespace fault_matrix_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace output;

constexpr double wrong = 1.01;

using Change = std::function<lattice::Material(lattice::Material)>;

// Quick versions, on the shells of the case.
Results check(const std::string &claim, const Subject &subject, const Change &of_runs)
{
  if (claim == "energy")
  {
    Results results = energy_claim(subject, 50);
    WaveEnergyOptions options;
    options.states = {Eigen::Matrix2d::Identity()};
    options.kd = {0.25};
    results.add(wave_energy_claim(subject, options).results);
    return results;
  }
  if (claim == "wave-speeds")
  {
    WaveSpeedsOptions options;
    options.states = {Eigen::Matrix2d::Identity()};
    options.damped_states = {subject.deformation};
    options.kd = {0.1, 0.5};
    options.mesh.cells = 4;
    options.planted = of_runs;
    return wave_speeds_claim(subject, options).results;
  }
  if (claim == "intrinsic-length")
  {
    IntrinsicLengthOptions options;
    options.angle_step = 30.;
    return intrinsic_length_claim(subject, options).results;
  }
  if (claim == "prestretch")
    return prestretch_claim(subject, small_sheet());
  CutStudy study = hole_study(true);
  study.other_sizes.clear();
  return cut_claim(subject, study).results;
}

template <class Law>
Law scaled(const continuum::CauchyBorn &law)
{
  std::vector<continuum::FibreFamily> families = law.families();
  for (continuum::FibreFamily &family : families)
    family.weight *= wrong;
  return Law(std::move(families));
}

lattice::MooneyRivlinBond &bond(lattice::Shell &shell)
{
  return std::get<lattice::MooneyRivlinBond>(shell.law);
}

struct OnePercent
{
  const char *name;
  std::function<void(Subject &)> plant;
  std::map<std::string, const char *> caught_by; // claim: part of the name of a row that must fail
  Change of_runs = {};                           // material of the lattice's runs alone
};

std::ostream &operator<<(std::ostream &out, const OnePercent &fault)
{
  return out << fault.name;
}

// Of the lattice.
const std::map<std::string, const char *> of_moduli{{"energy", "mu at F = I, Cauchy-Born"},
                                                    {"wave-speeds", "long-wave speed, S, lattice run against closed"},
                                                    {"prestretch", "traction on the top edge, Cauchy-Born"}};

std::vector<OnePercent> all_faults()
{
  return {
    {"lattice: a, nearest", [](Subject &s) { bond(s.material.nearest).a *= wrong; }, of_moduli},
    {"lattice: b, nearest", [](Subject &s) { bond(s.material.nearest).b *= wrong; }, of_moduli},
    {"lattice: s, nearest", [](Subject &s) { s.material.nearest.area_factor *= wrong; }, of_moduli},
    {"lattice: a, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).a *= wrong; }, of_moduli},
    {"lattice: b, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).b *= wrong; }, of_moduli},
    {"lattice: s, next-nearest",
     [](Subject &s) { s.material.next_nearest->area_factor *= wrong; },
     {{"energy", "mu at F = I, Cauchy-Born"},
      {"wave-speeds", "long-wave speed, S, lattice run against closed"},
      {"intrinsic-length", "alpha in all directions, gradient continuum against closed form"},
      {"prestretch", "traction on the top edge, Cauchy-Born"},
      {"hole", "reactions"}}},
    {"lattice: density",
     [](Subject &s) { s.material.density *= wrong; },
     {{"energy", "c_S at F = I, Cauchy-Born"}, {"wave-speeds", "long-wave speed, S, lattice run against closed"}}},
    {"lattice's runs: density",
     [](Subject &) {},
     {{"wave-speeds", "long-wave speed, S, lattice run against a, b, s and rho alone"}},
     [](lattice::Material material)
     {
       material.density *= wrong;
       return material;
     }},
    {"lattice's runs: dashpots",
     [](Subject &) {},
     {{"wave-speeds", "decay, lattice and finite elements each against its theory"}},
     [](lattice::Material material)
     {
       material.nearest.viscosity *= wrong;
       material.next_nearest->viscosity *= wrong;
       return material;
     }},
    {"continuum: weights, Cauchy-Born",
     [](Subject &s) { s.cauchy_born = scaled<continuum::CauchyBorn>(s.cauchy_born); },
     {{"energy", "mu at F = I, lattice and Cauchy-Born against a, b and s alone"},
      {"wave-speeds", "gradient continuum against Bloch"},
      {"intrinsic-length", "alpha in all directions, gradient continuum against closed form"},
      {"prestretch", "traction on the top edge, Cauchy-Born"},
      {"hole", "energy"}}},
    {"continuum: weights, network",
     [](Subject &s) { s.network = scaled<continuum::IsotropicNetwork>(s.cauchy_born); },
     {{"energy", "network against the lattice's mean over rotations"},
      {"wave-speeds", "network with gradient energy against the lattice's mean over rotations"},
      {"intrinsic-length", "network in all directions against the lattice's mean over directions"},
      {"prestretch", "traction on the top edge, network against the lattice's mean over rotations"},
      {"hole", "network: energy"}}},
    {"continuum: gradient energy",
     [](Subject &s)
     { s.lattice_gradient = std::make_shared<faults::Combination>(wrong, s.lattice_gradient, 0., s.lattice_gradient); },
     {{"intrinsic-length", "alpha in all directions, gradient continuum against closed form"}}},
    {"continuum: l_d",
     [](Subject &s) { s.lengths.lattice *= wrong; },
     {{"energy", "excess of the gradient continuum's energy over l_d^2 k^2"},
      {"wave-speeds", "gradient continuum against Bloch"},
      {"intrinsic-length", "intrinsic length l_d"}}},
  };
}

class FaultMatrix : public testing::TestWithParam<OnePercent>
{
};
INSTANTIATE_TEST_SUITE_P(Claims, FaultMatrix, testing::ValuesIn(all_faults()));

TEST_P(FaultMatrix, EachIsCaughtByARow)
{
  Subject subject = bridge::subject(subjects::paper_case());
  GetParam().plant(subject);
  for (const auto &[claim, row] : GetParam().caught_by)
  {
    const Results results = check(claim, subject, GetParam().of_runs);
    EXPECT_GE(faults::failing(results, row), 1u) << claim << ": " << row;
    for (const Result &found : results.rows())
      if (found.verdict() == Verdict::fails && found.quantity.find(row) != std::string::npos)
      {
        std::cout << "| " << GetParam().name << " | " << claim << " | " << row << " | " << found.error.value_or(-1.)
                  << " | " << found.tolerance.value_or(-1.) << " |\n";
        break;
      }
  }
}

// What a crack may use besides: contact and absorbing ends, either integrator.
TEST(Surroundings, AreThoseOfTheirClosedForms)
{
  for (const auto integrator :
       {input::Case::Integrator::velocity_verlet, input::Case::Integrator::runge_kutta_chebyshev})
  {
    input::Case input = subjects::paper_case();
    input.integrator = integrator;
    const Subject subject = bridge::subject(input);
    const Results right = contact_rows(subject, input);
    EXPECT_TRUE(right.all_hold()) << right.verdict_text(3);
    for (const Result &row : right.rows())
      std::cout << row.quantity << ": " << row.lattice.value_or(-1.) << " " << row.error.value_or(-1.) << "\n";
    const Results stiffer = contact_rows(subject, input, [](lattice::ContactLaw &law) { law.stiffness *= wrong; }),
                  damped = contact_rows(subject, input, [](lattice::ContactLaw &law) { law.viscosity *= wrong; });
    EXPECT_EQ(faults::failing(stiffer, "restitution"), 1u) << stiffer.rows()[0].error.value_or(-1.);
    EXPECT_EQ(faults::failing(damped, "restitution"), 1u) << damped.rows()[0].error.value_or(-1.);
    WaveSpeedsOptions options;
    options.damped_states = {subject.deformation};
    options.mesh.cells = 4;
    options.integrator = integrator;
    const Results waves = wave_speeds_claim(subject, options).results;
    EXPECT_TRUE(waves.all_hold()) << waves.verdict_text(6);
  }
  const Subject subject = bridge::subject(subjects::paper_case());
  const Results right = absorbing_end_rows(subject);
  EXPECT_TRUE(right.all_hold()) << right.verdict_text(3);
  for (const Result &row : right.rows())
    std::cout << row.quantity << ": " << row.error.value_or(-1.) << "\n";
}

// Without a fault none of them fails.
TEST(FaultMatrix, HoldsWithoutFault)
{
  const Subject subject = bridge::subject(subjects::paper_case());
  for (const char *claim : {"energy", "wave-speeds", "intrinsic-length", "prestretch", "hole"})
    EXPECT_EQ(faults::failing(check(claim, subject, {})), 0u) << claim;
}

} // namespace fault_matrix_test
