// A result holds if and only if its error is a finite number within its tolerance; files and table agree.
#include "support/errors.h"
#include "verification/claims/rows.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>

namespace results_test
{

using namespace latcon;
using output::Result;
using output::Results;
using output::Verdict;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Result checked(const std::optional<double> error, const std::optional<double> tolerance)
{
  Result result;
  result.claim = "energy";
  result.quantity = "energy density";
  result.unit = "J/m^3";
  result.error = error;
  result.tolerance = tolerance;
  return result;
}

Results sample()
{
  Results results;
  Result row = checked(1. / 3., 0.5);
  row.lattice = 0.1;
  row.theory = -1e-300;
  row.tolerance.reason = "half, for a test";
  row.gate = true;
  results.add(row);
  row = checked(-not_a_number, 1e-10);
  EXPECT_EQ(row.tolerance.reason, "");
  row.claim = "a \"quoted\", odd claim";
  row.unit = "\"";
  row.kind = output::RowKind::ledger;
  row.quantity = "two\nlines";
  row.continuum = infinity;
  results.add(row);
  results.add(checked({}, {}));
  return results;
}

TEST(Results, HoldIfAFiniteErrorIsWithinAFiniteTolerance)
{
  const double next = std::nextafter(1e-10, 1.);
  for (const auto &[error, tolerance] : {std::pair(0.5, 1.), std::pair(0., 0.), std::pair(1e-10, 1e-10)})
    EXPECT_EQ(checked(error, tolerance).verdict(), Verdict::holds) << error;
  for (const auto &[error, tolerance] :
       {std::pair(2., 1.), std::pair(next, 1e-10), std::pair(not_a_number, 1.), std::pair(0., not_a_number),
        std::pair(infinity, infinity), std::pair(-infinity, 1.), std::pair(0., infinity)})
    EXPECT_EQ(checked(error, tolerance).verdict(), Verdict::fails) << error << ' ' << tolerance;
  EXPECT_EQ(checked({}, 1.).verdict(), Verdict::fails);
  EXPECT_EQ(checked(1., {}).verdict(), Verdict::reported);
  EXPECT_EQ(checked(not_a_number, {}).verdict(), Verdict::reported);
}

TEST(Results, WhatIsNotFiniteOnAnySideFails)
{
  for (std::optional<double> Result::*side : {&Result::lattice, &Result::continuum, &Result::theory})
  {
    Result row = checked(0., 1.);
    row.*side = 2.;
    EXPECT_EQ(row.verdict(), Verdict::holds);
    for (const double value : {not_a_number, infinity, -infinity})
    {
      row.*side = value;
      EXPECT_EQ(row.verdict(), Verdict::fails);
      Result reported = row;
      reported.tolerance.reset();
      EXPECT_EQ(reported.verdict(), Verdict::reported);
    }
  }
}

TEST(Results, APartThatThrowsIsARowThatFailsAndSaysWhy)
{
  Results results;
  EXPECT_TRUE(results.attempt("energy", "NN: waves", [&] { results.add(checked(0., 1.)); }));
  EXPECT_TRUE(results.all_hold());
  EXPECT_FALSE(results.attempt("energy", "NN: waves", [] { throw std::invalid_argument("no positive step"); }));
  ASSERT_EQ(results.rows().size(), 2u);
  EXPECT_EQ(results.rows()[1].verdict(), Verdict::fails);
  EXPECT_EQ(results.rows()[1].claim, "energy");
  EXPECT_EQ(results.rows()[1].quantity, "NN: waves: not computed: no positive step");
  // These errors have their own exit codes.
  EXPECT_THROW(results.attempt("energy", "", [] { throw latcon::support::InputError("wrong"); }),
               latcon::support::InputError);
  EXPECT_THROW(results.attempt("energy", "", [] { throw std::bad_alloc(); }), std::bad_alloc);
  EXPECT_EQ(results.rows().size(), 2u);
}

TEST(Results, AllHoldNeedsAtLeastOneCheck)
{
  Results results;
  EXPECT_FALSE(results.all_hold());
  EXPECT_EQ(results.verdict(), Verdict::reported);
  results.add(checked(1., {}));
  EXPECT_FALSE(results.all_hold());
  results.add(checked(0., 1.));
  EXPECT_TRUE(results.all_hold());
  Results bad;
  bad.add(checked(not_a_number, 1.));
  results.add(bad);
  results.add(checked(0., 1.));
  EXPECT_FALSE(results.all_hold());
  EXPECT_EQ(results.verdict(), Verdict::fails);
  EXPECT_EQ(results.rows().size(), 4u);
  results.add(results);
  EXPECT_EQ(results.rows().size(), 8u);
}

// Whatever a computation estimates, the bounds stay.
TEST(Tolerance, IsLimitedFromBothSides)
{
  const auto of = [](double estimate) { return latcon::output::limited(estimate, 1e-3, 5e-3, "scatter"); };
  EXPECT_EQ(*of(2e-3), 2e-3);
  EXPECT_EQ(*of(0.), 1e-3);
  EXPECT_EQ(*of(infinity), 5e-3);
  EXPECT_EQ(of(2e-3).reason, "scatter (at least 0.001, at most 0.005)");
  Result row = checked(0., {});
  row.tolerance = of(not_a_number);
  EXPECT_EQ(row.verdict(), Verdict::fails);
}

TEST(Results, JsonHasARowPerResultInFullPrecision)
{
  const auto document = nlohmann::ordered_json::parse(sample().json());
  const auto expected = nlohmann::ordered_json::parse(R"({"verdict": "fails", "claims": [
    {"claim": "energy", "quantity": "energy density", "unit": "J/m^3", "lattice": 0.1, "continuum": null, "theory": -1e-300,
     "error": 0.33333333333333331, "tolerance": 0.5, "verdict": "holds", "reason": "half, for a test", "gate": true, "kind": "claim"},
    {"claim": "a \"quoted\", odd claim", "quantity": "two\nlines", "unit": "\"", "lattice": null, "continuum": "inf",
     "theory": null, "error": "nan", "tolerance": 1e-10, "verdict": "fails", "reason": "", "gate": false, "kind": "ledger"},
    {"claim": "energy", "quantity": "energy density", "unit": "J/m^3", "lattice": null, "continuum": null, "theory": null,
     "error": null, "tolerance": null, "verdict": "reported", "reason": "", "gate": false, "kind": "claim"}]})");
  EXPECT_EQ(document["verdict"], expected["verdict"]);
  EXPECT_EQ(document["claims"].dump(1), expected["claims"].dump(1)); // in this order
  using Failed = std::vector<std::pair<std::string, output::RowKind>>;
  EXPECT_EQ(sample().failed_rows(), (Failed{{"a \"quoted\", odd claim: two\nlines", output::RowKind::ledger}}));
}

// RFC 4180
TEST(Results, CsvHasTheSameRows)
{
  EXPECT_EQ(sample().csv(),
            "claim,quantity,unit,lattice,continuum,theory,error,tolerance,verdict,reason,gate,kind\n"
            "energy,energy density,J/m^3,0.1,,-1e-300,0.3333333333333333,0.5,holds,\"half, for a test\",true,claim\n"
            "\"a \"\"quoted\"\", odd claim\",\"two\nlines\",\"\"\"\",,inf,,nan,1e-10,fails,,false,ledger\n"
            "energy,energy density,J/m^3,,,,,,reported,,false,claim\n");
}

TEST(Results, TextThatIsNotUtf8DoesNotLoseTheFile)
{
  Results results;
  Result row = checked(0., 1.);
  row.quantity = "bad \xff byte";
  results.add(row);
  EXPECT_TRUE(nlohmann::json::accept(results.json()));
}

TEST(Results, TableShowsNamesUnitsAndSevenDigits)
{
  Results results;
  Result row = checked(1.23456e-11, 1e-10);
  row.lattice = 1. / 3.;
  row.theory = 2e6;
  results.add(row);
  std::ostringstream out;
  results.print(out);
  EXPECT_EQ(out.str(), "claim   quantity [unit]           lattice  continuum   theory     error  tolerance  verdict\n"
                       "-------------------------------------------------------------------------------------------\n"
                       "energy  energy density [J/m^3]  0.3333333             2000000  1.23e-11      1e-10  holds\n");
}

TEST(ClaimOutcome, JoinsTablesOfTheSameName)
{
  claims::ClaimOutcome first, second;
  first.table("t", {"a"}).add({1.});
  second.table("t", {"a"}).add({2.});
  second.table("u", {"b"}).add({3.});
  second.results.add(checked(0., 1.));
  first.add(second);
  EXPECT_EQ(first.tables.at("t").csv(), "a\n1\n2\n");
  EXPECT_EQ(first.tables.at("u").csv(), "b\n3\n");
  EXPECT_EQ(first.results.rows().size(), 1u);
}

} // namespace results_test
