#include "lattice/bonds/formulas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/largest_error.h"
#include "tests/lattice/sheets.h"

namespace memory_laws_test
{

using namespace latcon;

using namespace lattice;
using Branch = MaxwellMemory::Branch;

TEST(MaxwellMemory, RejectsInvalidBranches)
{
  EXPECT_NO_THROW(MaxwellMemory({{1e5, 1e-4}}));
  EXPECT_NO_THROW(MaxwellMemory(std::vector<Branch>(max_history_variables, {1e5, 1e-4})));
  EXPECT_THROW(MaxwellMemory(std::vector<Branch>(max_history_variables + 1, {1e5, 1e-4})), std::invalid_argument);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Branch &branch : {Branch{0., 1.}, Branch{-1., 1.}, Branch{1., 0.}, Branch{1., -1.}, Branch{infinity, 1.},
                               Branch{1., infinity}, Branch{std::nan(""), 1.}, Branch{1., std::nan("")}})
    EXPECT_THROW(MaxwellMemory({branch}), std::invalid_argument);
}

// theory.md, eq. (L.28): at most a dozen roundings, of numbers up to 1, and their growth in log2(r / 0.5) squarings.
TEST(MaxwellMemory, DecaysExponentially)
{
  for (const double r : {0., 1e-12, 1e-3, 0.3, 0.5, 0.51, 1., 7., 100., 749., 751., 1e9})
  {
    const double modulus = 2e5, time = 1e-4;
    MaxwellMemory memory({{modulus, time}});
    memory.set_duration(r * time);
    const double gain = r > 0. ? modulus * -std::expm1(-r) / r : modulus;
    EXPECT_NEAR(memory.decay[0], std::exp(-r), 2e-15) << r;
    EXPECT_NEAR(memory.gain[0], gain, 4e-15 * gain) << r;
  }
  // No time, no change of any bit.
  EXPECT_EQ(MaxwellMemory({{2e5, 1e-4}}).decay[0], 1.);
}

// Exact for a stretch that is linear in time, for any step: q = E tau rate (1 - e^(-t/tau)).
// theory.md, eq. (L.28).
TEST(MaxwellMemory, IsExactOnARamp)
{
  const std::vector<Branch> branches{{2e5, 1e-5}, {1e5, 1e-3}};
  MaxwellMemory memory(branches);
  const double rate = 300.;
  for (const double h : {1e-7, 3e-6, 2e-4})
  {
    memory.set_duration(h);
    double q[2] = {0., 0.}, dissipation[2] = {0., 0.}, sum = 0.;
    const int n = 50;
    for (int i = 0; i < n; ++i)
      sum = formulas::advance(memory, 2, 1. + i * h * rate, 1. + (i + 1) * h * rate, q, dissipation);
    double exact = 0.;
    std::vector<double> of_branches;
    for (const auto &[modulus, time] : branches)
    {
      of_branches.push_back(-modulus * time * rate * std::expm1(-n * h / time));
      exact += of_branches.back();
    }
    // Each difference of stretches is off by the round-off of 1.
    const double round_off = 4. * 3e5 * n * 2.3e-16 + 1e-13 * exact;
    EXPECT_NEAR(sum, exact, round_off) << h;
    for (std::size_t i = 0; i < branches.size(); ++i)
    {
      const double q_exact = of_branches[i],
                   power = q_exact * q_exact / (branches[i].modulus * branches[i].relaxation_time);
      EXPECT_NEAR(dissipation[i], power, 2. * power * round_off / q_exact) << h;
      EXPECT_NEAR(memory.stored_energy(i, 1., q), 0.5 * q[i] * q[i] / branches[i].modulus, 1e-15 * sum);
    }
  }
}

TEST(PlasticMemory, RejectsInvalidConstants)
{
  EXPECT_NO_THROW(PlasticMemory(1e5, 1e4, 0.));
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const std::size_t wrong : {0, 1, 2}) // modulus, yield stress, hardening
    for (const double value : {wrong == 2 ? -1e-9 : 0., -1., infinity, nan})
    {
      std::array<double, 3> constants{1., 1., 1.};
      constants[wrong] = value;
      EXPECT_THROW(PlasticMemory(constants[0], constants[1], constants[2]), std::invalid_argument);
    }
}

// theory.md, eqs. (L.41) to (L.43): the work on a bond that is stretched to an amplitude and cycled, in closed form.
TEST(PlasticMemory, DissipatesWhatACycleTakes)
{
  const double modulus = 2e5, yield_stress = 3e4, amplitude = 0.8;
  for (const double hardening : {0., 5e4})
    for (const int n : {1, 7, 100})
    {
      const PlasticMemory memory(modulus, yield_stress, hardening);
      double variables[2] = {0., 0.}, stretch = 1., dissipated = 0.;
      double q = 0., yield = yield_stress, work = 0.;
      for (const double to : {1. + amplitude, 1. - amplitude, 1. + amplitude, 1.})
      {
        const double from = stretch, sign = to > from ? 1. : -1.;
        for (int i = 1; i <= n; ++i)
        {
          const double now = from + (to - from) * i / n;
          double slipped = 0.;
          formulas::advance(memory, 2, stretch, now, variables, &slipped);
          EXPECT_GE(slipped, 0.);
          dissipated += slipped;
          stretch = now;
        }
        // Elastic to the yield stress, then with the slope of both springs in series.
        const double elastic = std::min((sign * yield - q) / (sign * modulus), std::abs(to - from));
        const double plastic = std::abs(to - from) - elastic, at_yield = q + sign * modulus * elastic;
        const double slope = modulus * hardening / (modulus + hardening), end = at_yield + sign * slope * plastic;
        work += 0.5 * (q + at_yield) * sign * elastic + 0.5 * (at_yield + end) * sign * plastic;
        q = end;
        yield = support::largest_of({yield, std::abs(end)});
        // A dozen roundings of q and of the work per increment.
        const double round_off = 12. * n * 2.3e-16 * modulus * (1. + amplitude);
        EXPECT_NEAR(variables[0], q, 4. * round_off) << n;
        EXPECT_NEAR(memory.stored_energy(0, stretch, variables) + dissipated, work, 4. * round_off) << n;
        // Nothing slips further while the stretch stays, to the last bit.
        double again[2] = {variables[0], variables[1]}, none = 1.;
        EXPECT_EQ(formulas::advance(memory, 2, stretch, stretch, again, &none), variables[0]);
        EXPECT_EQ(again[1], variables[1]);
        EXPECT_EQ(none, 0.);
      }
      EXPECT_GT(dissipated, 0.5 * work);
    }
}

TEST(CustomMemory, RejectsLawsWithStressAtRest)
{
  struct Mistaken : sheets::BranchFromOutside
  {
    Mistaken(std::size_t n_, double stress_, double stiffness_)
      : BranchFromOutside({1e5, 1e-4}), n(n_), stress(stress_), stiffness(stiffness_)
    {
    }
    std::size_t n_variables() const noexcept override { return n; }
    double advance(double, double, double, double *) const noexcept override { return stress; }
    double largest_stiffness() const noexcept override { return stiffness; }
    std::size_t n;
    double stress, stiffness;
  };
  const auto with = [](std::size_t n, double stress, double stiffness)
  { return CustomMemory(std::make_shared<Mistaken>(n, stress, stiffness)); };
  EXPECT_THROW(CustomMemory(nullptr), std::invalid_argument);
  EXPECT_NO_THROW(with(1, 0., 1e5));
  EXPECT_THROW(with(0, 0., 1e5), std::invalid_argument);
  EXPECT_THROW(with(max_history_variables + 1, 0., 1e5), std::invalid_argument);
  EXPECT_THROW(with(1, 1., 1e5), std::invalid_argument);
  EXPECT_THROW(with(1, 0., -1.), std::invalid_argument);
  EXPECT_THROW(with(1, 0., std::nan("")), std::invalid_argument);
}

} // namespace memory_laws_test
