// The claim on disorder, and what makes it fail.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "lattice/bond_factors.h"
#include "tests/verification/claims/subjects.h"
#include "verification/claims/disorder/disorder_claim.h"
#include "verification/commands/command.h"

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

std::string failing(const ClaimOutcome &outcome)
{
  std::string rows;
  for (const output::Result &row : outcome.results.rows())
    if (row.verdict() == output::Verdict::fails)
      rows += row.quantity + "\n";
  return rows;
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
  for (std::size_t kind = 0; kind < lattice::n_nearest_kinds; ++kind)
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
    EXPECT_TRUE(both.results.all_hold()) << failing(both);
    EXPECT_EQ(both.results.rows().size(), 6u);
    EXPECT_EQ(both.results.count(output::Verdict::holds), 6u);
  }
  const ClaimOutcome nearest =
    disorder_claim(subject(input, subjects::nearest_only(input)), with(Distribution(Kind::uniform, 0.1)));
  EXPECT_TRUE(nearest.results.all_hold()) << failing(nearest);
}

struct Fault
{
  const char *name;
  std::function<void(double &factor, std::size_t place)> change;
  std::vector<const char *> quantities;
};

TEST(DisorderClaim, FailsForWrongFactors)
{
  const input::Case input = subjects::paper_case();
  const std::vector<Fault> faults{
    {"mean 1 % off", [](double &factor, std::size_t) { factor *= 1.01; }, {"mean factor"}},
    {"mean 1 % low", [](double &factor, std::size_t) { factor *= 0.99; }, {"mean factor"}},
    {"3 % wider", [](double &factor, std::size_t) { factor = 1. + 1.03 * (factor - 1.); }, {"standard deviation"}},
    {"20 % wider",
     [](double &factor, std::size_t) { factor = 1. + 1.2 * (factor - 1.); },
     {"standard deviation", "reduction of the bulk", "reduction of the shear"}},
    {"none",
     [](double &factor, std::size_t) { factor = 1.; },
     {"standard deviation", "reduction of the bulk", "reduction of the shear"}},
    {"not a number",
     [](double &factor, std::size_t place) { factor = place % 97 == 0 ? std::nan("") : factor; },
     {"sheets with disorder"}}};
  for (const Fault &fault : faults)
  {
    DisorderOptions options = with(Distribution(Kind::uniform, 0.1));
    options.n_sheets = 12;
    options.planted = [&](lattice::State &state)
    {
      for (lattice::Field &factors : state.stiffness.kinds)
        for (std::size_t place = 0; place < factors.size(); ++place)
          if (factors[place] > 0.)
            fault.change(factors[place], place);
    };
    const std::string rows = failing(disorder_claim(subject(input), options));
    for (const char *quantity : fault.quantities)
      EXPECT_NE(rows.find(quantity), std::string::npos) << fault.name << ": " << quantity;
  }
}

// Bonds that know of each other are no sheet with independent ones: rows of stiff and of soft bonds.
TEST(DisorderClaim, FailsForBondsThatAreNotIndependent)
{
  const input::Case input = subjects::paper_case();
  DisorderOptions options = with(Distribution(Kind::uniform, 0.1));
  options.n_sheets = 12;
  options.planted = [](lattice::State &state)
  {
    for (lattice::Field &factors : state.stiffness.kinds)
      factors = state.stiffness.kinds[0];
  };
  const std::string rows = failing(disorder_claim(subject(input), options));
  EXPECT_NE(rows.find("reduction of the"), std::string::npos) << rows;
}

TEST(DisorderClaim, IsForMaterialsWithDisorder)
{
  input::Case input = subjects::paper_case();
  const Claim claim = latcon::commands::selected_claims({"disorder"}, input.material()).front();
  EXPECT_FALSE(claim.is_default_for(input.material()));
  EXPECT_FALSE(claim.is_before_fracture(input.material()));
  input.disorder.strength.kind = Kind::weibull;
  EXPECT_TRUE(claim.is_default_for(input.material()));
}

} // namespace disorder_claim_test
