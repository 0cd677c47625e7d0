// Rows of the ranks, and communication between them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <gtest/gtest.h>

#include "lattice/row_partition.h"

namespace row_partition_test
{

using namespace latcon;

using namespace lattice;

TriangularLattice sheet_of(std::size_t rows, bool periodic = false)
{
  const double pitch = std::sqrt(0.75);
  const double height = periodic ? static_cast<double>(rows) : static_cast<double>(rows - 1);
  return {1., 7., height * pitch, Orientation::rows_along_crack, {false, periodic}};
}

double value_at(std::size_t place)
{
  return std::sin(static_cast<double>(place));
}

TEST(Ranks, AreAsManyAsTheTestWants)
{
  const char *const wanted = std::getenv("LATCON_RANKS");
  int n = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  if (wanted != nullptr)
  {
    EXPECT_EQ(n, std::atoi(wanted));
  }
}

// Three rows are fewer than five ranks, five rows give them one each.
TEST(RowPartition, SharesOutAllRows)
{
  for (const std::size_t rows : {3u, 5u, 7u, 31u})
  {
    const TriangularLattice sheet = sheet_of(rows);
    ASSERT_EQ(sheet.rows(), rows);
    const RowPartition band(sheet, MPI_COMM_WORLD);
    std::vector<std::size_t> own;
    for (std::size_t row = band.rows().begin; row < band.rows().end; ++row)
    {
      own.push_back(row);
      EXPECT_EQ(band.owner(row), band.rank());
      EXPECT_TRUE(band.owns(sheet.index(row, 0)));
      EXPECT_TRUE(band.is_relevant(sheet.index(row, 3)));
    }
    EXPECT_LE(own.size(), rows / band.n_ranks() + 1);
    EXPECT_GE(own.size(), rows / band.n_ranks());
    for (std::size_t rank = 0; rank < band.n_ranks(); ++rank)
      for (std::size_t row = 0; row < rows; ++row)
      {
        const std::vector<std::size_t> halo = band.halo_of(rank);
        EXPECT_EQ(band.is_relevant_to(rank, sheet.index(row, 3)),
                  band.owner(row) == rank || std::find(halo.begin(), halo.end(), row) != halo.end());
      }
    for (const std::size_t row : band.halo())
    {
      EXPECT_FALSE(band.owns(sheet.index(row, 0)));
      EXPECT_TRUE(band.is_relevant(sheet.index(row, 0)));
    }
    std::vector<std::size_t> all(rows);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(band.all_gather(own), all);
    EXPECT_FALSE(band.owns(0)) << "the margin is nobody's";
  }
}

TEST(RowPartition, KeepsTwoRowsOnEitherSide)
{
  for (const bool periodic : {false, true})
    for (const std::size_t rows : {4u, 6u, 12u, 30u})
    {
      const TriangularLattice sheet = sheet_of(periodic ? rows : rows + 1, periodic);
      const RowPartition band(sheet, MPI_COMM_WORLD);
      const auto n = static_cast<std::ptrdiff_t>(sheet.rows());
      for (std::ptrdiff_t row = 0; row < n; ++row)
      {
        bool near = false;
        for (auto own = static_cast<std::ptrdiff_t>(band.rows().begin);
             own < static_cast<std::ptrdiff_t>(band.rows().end); ++own)
          for (const std::ptrdiff_t image : {row - n, row, row + n})
            near = near || (std::abs(own - image) <= 2 && (image == row || periodic));
        EXPECT_EQ(band.is_relevant(sheet.index(static_cast<std::size_t>(row), 0)), near) << row << " of " << n;
      }
    }
}

// Nowhere but in the halo, and there all of it, also while the interior changes.
TEST(HaloExchange, BringsTheHaloUpToDate)
{
  for (const bool periodic : {false, true})
    for (const std::size_t rows : {4u, 6u, 10u, 40u})
    {
      const TriangularLattice sheet = sheet_of(periodic ? rows : rows + 1, periodic);
      const RowPartition band(sheet, MPI_COMM_WORLD);
      HaloExchange halo(band);
      Field one(sheet.n_places()), two(sheet.n_places());
      const auto set = [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t row = begin; row < end; ++row)
          for (std::size_t column = 0; column < sheet.columns(); ++column)
          {
            const std::size_t place = sheet.index(row, column);
            one[place] = value_at(place);
            two[place] = -value_at(place);
          }
      };
      const Rows own = band.rows(), interior = halo.interior();
      ASSERT_LE(own.begin, interior.begin);
      ASSERT_LE(interior.begin, interior.end);
      ASSERT_LE(interior.end, own.end);
      set(own.begin, interior.begin);
      set(interior.end, own.end);
      halo.start({&one, &two});
      set(interior.begin, interior.end);
      halo.finish();
      for (std::size_t row = 0; row < sheet.rows(); ++row)
        for (std::size_t column = 0; column < sheet.columns(); ++column)
        {
          const std::size_t place = sheet.index(row, column);
          ASSERT_EQ(one[place], band.is_relevant(place) ? value_at(place) : 0.);
          ASSERT_EQ(two[place], band.is_relevant(place) ? -value_at(place) : 0.);
        }
    }
}

TEST(RowPartition, AddsUpRowsInTheirOrder)
{
  const TriangularLattice sheet = sheet_of(31);
  std::vector<double> values(31);
  for (std::size_t row = 0; row < 31; ++row)
    values[row] = std::exp(value_at(row) * 20.); // many magnitudes: another order gives other bits
  const double expected = RowPartition(sheet).sum(values);
  EXPECT_EQ(expected, std::accumulate(values.begin(), values.end(), 0.));
  const RowPartition band(sheet, MPI_COMM_WORLD);
  for (std::size_t row = 0; row < 31; ++row)
    if (row < band.rows().begin || row >= band.rows().end)
      values[row] = 1e30;
  EXPECT_EQ(band.sum(values), expected);
}

TEST(RowPartition, SharesSitesAndGathersRows)
{
  const TriangularLattice sheet = sheet_of(31);
  const RowPartition band(sheet, MPI_COMM_WORLD);
  Field field(sheet.n_places());
  SiteFlags marks(sheet.n_places());
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    if (band.owns(place))
    {
      field[place] = value_at(place);
      marks[place] = static_cast<std::uint8_t>(place % 7);
    }
  // To each rank other sites.
  const auto places = [&](std::size_t to)
  {
    return std::vector<std::size_t>{sheet.index(30, to), sheet.index(2, 5), sheet.index(17, 2 * to), sheet.index(2, 3)};
  };
  SitesOfRanks sent(band.n_ranks()), received(band.n_ranks());
  for (std::size_t rank = 0; rank < band.n_ranks(); ++rank)
    if (rank != band.rank())
      for (const std::size_t place : places(rank))
        if (band.owns(place))
          sent[rank].push_back(place);
  for (const std::size_t place : places(band.rank()))
    if (!band.owns(place))
      received[band.owner(sheet.row_of(place))].push_back(place);
  band.exchange(sent, received, {&field});
  for (const std::size_t place : places(band.rank()))
    EXPECT_EQ(field[place], value_at(place));
  const Rows rows{4, 29};
  band.gather(field, rows);
  band.gather(marks, rows);
  if (band.is_first())
    for (std::size_t row = rows.begin; row < rows.end; ++row)
      for (std::size_t column = 0; column < sheet.columns(); ++column)
      {
        EXPECT_EQ(field[sheet.index(row, column)], value_at(sheet.index(row, column)));
        EXPECT_EQ(marks[sheet.index(row, column)], sheet.index(row, column) % 7);
      }
  if (band.is_shared() && band.is_first())
  {
    EXPECT_EQ(field[sheet.index(29, 4)], 0.) << "a row that nobody asked for";
  }
}

} // namespace row_partition_test
