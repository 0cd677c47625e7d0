// The claim on disorder, and what makes it fail.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "lattice/state.h"
#include "tests/verification/claims/faults.h"
#include "verification/claims/disorder/disorder_claim.h"

namespace disorder_claim_test
{

using namespace latcon;

using namespace claims;
using bridge::subject;
using lattice::Distribution;
using Kind = Distribution::Kind;

DisorderOptions with(const Distribution &stiffness, std::uint64_t seed = 1)
{
  DisorderOptions options;
  options.disorder = {{}, stiffness, seed};
  return options;
}

TEST(EffectiveMedium, AveragesOverTheDensity)
{
  for (const auto &[kind, width] :
       {std::pair(Kind::uniform, 0.3), {Kind::normal, 0.1}, {Kind::weibull, 0.1}, {Kind::weibull, 0.5}})
  {
    const Distribution distribution(kind, width);
    EXPECT_NEAR(mean_over(distribution, [](double) { return 1.; }), 1., 1e-9);
    EXPECT_NEAR(mean_over(distribution, [](double g) { return g; }), 1., 1e-9);
    EXPECT_NEAR(mean_over(distribution, [](double g) { return (g - 1.) * (g - 1.); }), width * width, 1e-8);
  }
}

// Feng, Thorpe and Garboczi (1985): of nearest neighbours each bond has the share 2/3, but for the translations, and
// disorder of a small width takes 2/3 of its square.
TEST(EffectiveMedium, IsThatOfTheTriangularNet)
{
  const input::Case input = subjects::paper_case();
  constexpr double n = 24.;
  const lattice::TriangularLattice sheet(input.spacing, n * input.spacing, std::sqrt(0.75) * n * input.spacing,
                                         lattice::Orientation::rows_along_crack, {true, true});
  const auto sum = [](const std::array<double, lattice::n_bond_kinds> &values)
  {
    double total = 0.;
    for (const double value : values)
      total += value;
    return total;
  };
  const double both = 2. * (1. - 1. / static_cast<double>(sheet.n_sites()));
  const EffectiveMedium nearest =
    effective_medium(sheet, subjects::nearest_only(input), Distribution(Kind::uniform, 0.01));
  EXPECT_NEAR(sum(nearest.share), both, 1e-10);
  for (std::size_t kind = 0; kind < lattice::n_kinds_per_shell; ++kind)
  {
    EXPECT_NEAR(nearest.share[kind], 2. / 3., 2. / static_cast<double>(sheet.n_sites()));
    // The fourth order, 1e-8, is left out.
    EXPECT_NEAR(1. - nearest.factor[kind], nearest.share[kind] * 1e-4, 1e-8);
  }
  const EffectiveMedium all = effective_medium(sheet, input.material(), Distribution(Kind::weibull, 0.1));
  EXPECT_NEAR(sum(all.share), both, 1e-10);
  for (std::size_t kind = 0; kind < 2 * lattice::n_kinds_per_shell; ++kind) // of both shells
  {
    EXPECT_LT(all.factor[kind], 1.);
    EXPECT_GT(all.factor[kind], 1. - 0.01);
  }
}

// theory-comparison.md, eqs. (H.21) to (H.24).
TEST(DisorderClaim, HoldsForEveryDistribution)
{
  const input::Case input = subjects::paper_case();
  for (const Distribution &stiffness :
       {Distribution(), Distribution(Kind::normal, 0.05), Distribution(Kind::weibull, 0.3)})
  {
    const ClaimOutcome both = disorder_claim(subject(input), with(stiffness));
    EXPECT_TRUE(both.results.all_hold()) << both.results.verdict_text(6);
    EXPECT_EQ(both.results.rows().size(), 6u);
    EXPECT_EQ(both.results.count(output::Verdict::holds), 6u);
  }
  const bridge::Subject nearest = subject(input, subjects::nearest_only(input));
  EXPECT_TRUE(disorder_claim(nearest, with(Distribution(Kind::uniform, 0.1))).results.all_hold());
}

struct Fault
{
  const char *name;
  std::function<void(lattice::State &)> plant;
  std::vector<const char *> quantities;
};

// Another factor of each bond.
std::function<void(lattice::State &)> factors(const std::function<void(double &factor, std::size_t place)> &change)
{
  return [change](lattice::State &state)
  {
    for (lattice::Field &of_kind : state.stiffness.kinds)
      for (std::size_t place = 0; place < of_kind.size(); ++place)
        if (of_kind[place] > 0.)
          change(of_kind[place], place);
  };
}

TEST(DisorderClaim, FailsForWrongFactors)
{
  const input::Case input = subjects::paper_case();
  const std::vector<Fault> planted{
    {"mean 1 % off", factors([](double &factor, std::size_t) { factor *= 1.01; }), {"mean factor"}},
    {"mean 1 % low", factors([](double &factor, std::size_t) { factor *= 0.99; }), {"mean factor"}},
    {"3 % wider",
     factors([](double &factor, std::size_t) { factor = 1. + 1.03 * (factor - 1.); }),
     {"standard deviation"}},
    {"20 % wider",
     factors([](double &factor, std::size_t) { factor = 1. + 1.2 * (factor - 1.); }),
     {"standard deviation", "reduction of the bulk", "reduction of the shear"}},
    {"none",
     factors([](double &factor, std::size_t) { factor = 1.; }),
     {"standard deviation", "reduction of the bulk", "reduction of the shear"}},
    {"not a number",
     factors([](double &factor, std::size_t place) { factor = place % 97 == 0 ? std::nan("") : factor; }),
     {"sheets with disorder"}},
    // Sheets that scatter more than a distribution allows: the width is doubled in every other one (both signs of two
    // loads), none in the others.
    {"as wide in the mean of sheets as none is",
     [n = 0u](lattice::State &state) mutable
     {
       const double wider = n++ / 4 % 2 == 0 ? 2. : 0.;
       factors([=](double &factor, std::size_t) { factor = 1. + wider * (factor - 1.); })(state);
     },
     {"reduction of the bulk", "reduction of the shear"}},
    // Bonds that know of each other: rows of stiff and of soft ones.
    {"not independent",
     [](lattice::State &state)
     {
       for (lattice::Field &of_kind : state.stiffness.kinds)
         of_kind = state.stiffness.kinds[0];
     },
     {"reduction of the"}}};
  for (const Fault &fault : planted)
  {
    DisorderOptions options = with(Distribution(Kind::uniform, 0.1));
    options.n_sheets = 12;
    options.planted = fault.plant;
    const output::Results results = disorder_claim(subject(input), options).results;
    for (const char *quantity : fault.quantities)
      EXPECT_GE(faults::failing(results, quantity), 1u) << fault.name << ": " << quantity;
  }
}

} // namespace disorder_claim_test
