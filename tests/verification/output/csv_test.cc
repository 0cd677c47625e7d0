// Tables are read back unchanged, and refuse rows with another number of cells.
#include "verification/claims/rows.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace csv_test
{

using namespace latcon;
using claims::ClaimOutcome;
using output::Table;

TEST(Table, WritesNumbersInFullPrecisionAndQuotesWords)
{
  Table table({"wave", "k d", "speed, phase [m/s]"});
  table.add({std::string("L"), 0.1, 1. / 3.});
  table.add({std::string("a \"b\", c"), -2., 1e-300});
  EXPECT_EQ(table.csv(), "wave,k d,\"speed, phase [m/s]\"\nL,0.1,0.3333333333333333\n\"a \"\"b\"\", c\",-2,1e-300\n");
}

TEST(Table, RefusesRowsThatDoNotFit)
{
  Table table({"a", "b"});
  EXPECT_THROW(table.add({1.}), std::invalid_argument);
  EXPECT_THROW(table.add(Table({"a", "c"})), std::invalid_argument);
}

TEST(ClaimOutcome, JoinsTablesOfTheSameName)
{
  ClaimOutcome first, second;
  first.table("t", {"a"}).add({1.});
  second.table("t", {"a"}).add({2.});
  second.table("u", {"b"}).add({3.});
  second.results.add({"c", "q", "1", {}, {}, {}, 0., 1.});
  first.add(second);
  EXPECT_EQ(first.tables.at("t").csv(), "a\n1\n2\n");
  EXPECT_EQ(first.tables.at("u").csv(), "b\n3\n");
  EXPECT_EQ(first.results.rows().size(), 1u);
}

} // namespace csv_test
