// Stored verdicts are those of the claims only if they have the claims' rows.
#include "verification/claims/gate_rows.h"
#include "verification/commands/claim_registry.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

using namespace latcon;

namespace
{

using output::Result;
using output::Results;

// With a memory, so that the claims about memories are among those before fracture.
lattice::Material material_with_branch()
{
  const lattice::MaxwellMemory branch({{1e5, 1e-4}});
  return {944., {lattice::LinearBond{1e5}, 1., 1., branch}, std::nullopt};
}

std::string row_problem(const Results &results, const std::string &shells)
{
  return claims::row_problem(results, shells, commands::claims_before_fracture(material_with_branch()));
}

// Rows as a claim leaves them, all with the same numbers.
class GateRows : public testing::Test
{
protected:
  // All that are asked for, found by asking for one after the other.
  GateRows()
  {
    for (std::string problem = row_problem(all_, "NN"); !problem.empty(); problem = row_problem(all_, "NN"))
    {
      const auto quoted = [&](std::size_t from)
      {
        const std::size_t begin = problem.find('`', from) + 1;
        return problem.substr(begin, problem.find('`', begin) - begin);
      };
      const std::string quantity = quoted(0);
      all_.add(row(quoted(quantity.size() + 14), quantity));
      if (all_.rows().size() > 200)
        throw std::logic_error(problem);
    }
  }

  static Result row(const std::string &claim, const std::string &quantity)
  {
    return {claim, quantity, "1", 1., 1., {}, 1e-12, 1e-10};
  }

  Results all_;
};

TEST_F(GateRows, AreThoseOfAllClaims)
{
  std::set<std::string> found;
  for (const Result &row : all_.rows())
    found.insert(row.claim);
  std::set<std::string> expected;
  for (const claims::Claim &claim : commands::claims_before_fracture(material_with_branch()))
    expected.insert(claim.name);
  EXPECT_EQ(found, expected);
  EXPECT_GE(all_.rows().size(), 30u);
}

TEST_F(GateRows, MayBeMore)
{
  all_.add(row("energy", "NN: something else"));
  EXPECT_EQ(row_problem(all_, "NN"), "");
}

TEST_F(GateRows, AreAllNeeded)
{
  for (std::size_t without = 0; without < all_.rows().size(); ++without)
  {
    Results results;
    for (std::size_t i = 0; i < all_.rows().size(); ++i)
      if (i != without)
        results.add(all_.rows()[i]);
    EXPECT_NE(row_problem(results, "NN").find(all_.rows()[without].quantity), std::string::npos);
  }
}

TEST_F(GateRows, AreDecided)
{
  Results results;
  for (Result row : all_.rows())
  {
    row.tolerance.reset();
    results.add(row);
  }
  EXPECT_NE(row_problem(results, "NN"), "");
}

TEST_F(GateRows, AreNotThoseOfOtherShellsOrClaims)
{
  EXPECT_NE(row_problem(all_, "NN+NNN"), "");
  for (const auto &[claim, quantity] :
       {std::pair("energy", "planted"), {"planted", "NN: planted"}, {"energy", "NN+NNN: planted"}})
  {
    Results results = all_;
    results.add(row(claim, quantity));
    EXPECT_NE(row_problem(results, "NN").find(quantity), std::string::npos);
  }
}

} // namespace
