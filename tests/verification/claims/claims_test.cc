#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "verification/energy/energy_claim.h"
#include "verification/prestretch/prestretch_claim.h"

namespace
{

using namespace verification;

constexpr unsigned int samples = 200;

PrestretchOptions small_sheet()
{
  PrestretchOptions options;
  options.length = 24.;
  options.height = 16.;
  options.cells_x = 4;
  options.cells_y = 3;
  return options;
}

TEST(Energy, HoldsForBothShellSetsOrientationsAndLaws)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
    for (const auto law : {ShellCase::Law::mooney_rivlin, ShellCase::Law::linear})
    {
      Case input = subjects::paper_case();
      input.orientation = orientation;
      input.nearest.law = input.next_nearest.law = law;
      input.nearest.modulus = input.next_nearest.modulus = 2.35e5;
      for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
      {
        const Results results = energy_claim(subject(input, material), samples);
        // Strong ellipticity of the calibrated law is judged for rubber alone: springs are another material.
        for (const Result &row : results.rows())
          EXPECT_TRUE(row.verdict() != Verdict::fails) << row.quantity;
      }
    }
}

TEST(Prestretch, HoldsForBothShellSetsAndOrientations)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
  {
    Case input = subjects::paper_case();
    input.orientation = orientation;
    for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
    {
      const Results results = prestretch_claim(subject(input, material), small_sheet());
      EXPECT_TRUE(results.all_hold());
      for (const Result &row : results.rows())
        EXPECT_TRUE(row.verdict() != Verdict::fails) << row.quantity;
    }
  }
}

// A claim that cannot fail claims nothing: every constant of the lattice, wrong by 1 % against laws that are right.
using faults::Fault;

lattice::MooneyRivlinBond &bond(lattice::Shell &shell)
{
  return std::get<lattice::MooneyRivlinBond>(shell.law);
}

class OnePercent : public testing::TestWithParam<Fault>
{
};
INSTANTIATE_TEST_SUITE_P(
  Claims, OnePercent,
  testing::Values(Fault{"a, nearest", [](Subject &s) { bond(s.material.nearest).a *= 1.01; }},
                  Fault{"b, nearest", [](Subject &s) { bond(s.material.nearest).b *= 1.01; }},
                  Fault{"s, nearest", [](Subject &s) { s.material.nearest.area_factor *= 1.01; }},
                  Fault{"a, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).a *= 1.01; }},
                  Fault{"b, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).b *= 1.01; }},
                  Fault{"s, next-nearest", [](Subject &s) { s.material.next_nearest->area_factor *= 1.01; }}));

TEST_P(OnePercent, FailsTheEnergyClaim)
{
  Subject wrong = subject(subjects::paper_case());
  GetParam().plant(wrong);
  const Results results = energy_claim(wrong, samples);
  EXPECT_EQ(results.verdict(), Verdict::fails);
  // Energy, stress, both moduli and both speeds, each of them.
  for (std::size_t row = 0; row < 6; ++row)
    EXPECT_EQ(results.rows()[row].verdict(), Verdict::fails) << results.rows()[row].quantity;
}

TEST_P(OnePercent, FailsThePrestretchClaim)
{
  Subject wrong = subject(subjects::paper_case());
  GetParam().plant(wrong);
  const Results results = prestretch_claim(wrong, small_sheet());
  EXPECT_EQ(results.verdict(), Verdict::fails);
  std::size_t failing = 0;
  for (const Result &row : results.rows())
    failing += row.verdict() == Verdict::fails;
  EXPECT_EQ(failing, 4u); // energy density, two tractions, stress; displacements are those of the edges all the same
}

// The network law is judged by itself: every one of its rows, for weights that are wrong by 1 %.
TEST(Energy, FailsForAWrongNetwork)
{
  for (const double factor : {1.01, 0.99})
  {
    Subject wrong = subject(subjects::paper_case());
    std::vector<continuum::FibreFamily> families = wrong.cauchy_born.families();
    for (continuum::FibreFamily &family : families)
      family.weight *= factor;
    wrong.network = continuum::IsotropicNetwork(families);
    const Results results = energy_claim(wrong, samples);
    for (const Result &row : results.rows())
      EXPECT_EQ(row.verdict() == Verdict::fails, row.quantity.find("network") != std::string::npos) << row.quantity;
  }
}

TEST(Energy, FailsForAWrongDensity)
{
  Subject wrong = subject(subjects::paper_case());
  wrong.material.density *= 1.01;
  EXPECT_EQ(energy_claim(wrong, 10).verdict(), Verdict::fails);
}

TEST(Energy, FailsForAMooneyRivlinLawThatIsNotElliptic)
{
  Subject wrong = subject(subjects::paper_case());
  EXPECT_GT(wrong.mooney_rivlin.smallest_acoustic_eigenvalue, 0.);
  wrong.mooney_rivlin.smallest_acoustic_eigenvalue *= -1e-3;
  const Results results = energy_claim(wrong, 10);
  for (const Result &row : results.rows())
    EXPECT_EQ(row.verdict() == Verdict::fails, row.quantity.find("slowest") != std::string::npos) << row.quantity;
  EXPECT_EQ(results.verdict(), Verdict::fails);
}

TEST(Energy, FailsForAWrongMooneyRivlinConstant)
{
  for (double continuum::MooneyRivlin::Constants::*constant :
       {&continuum::MooneyRivlin::Constants::c1, &continuum::MooneyRivlin::Constants::c2,
        &continuum::MooneyRivlin::Constants::kappa})
  {
    Subject wrong = subject(subjects::paper_case());
    wrong.mooney_rivlin.law.*constant *= 1.01;
    EXPECT_EQ(energy_claim(wrong, 10).verdict(), Verdict::fails);
  }
}

} // namespace
