// Rows of the ranks.
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

    std::vector<std::size_t> field(sheet.n_places(), rows);
    for (const std::size_t row : own)
      field[sheet.index(row, 3)] = row;
    band.gather(field, {1, rows});
    for (std::size_t row = 1; band.is_first() && row < rows; ++row)
      EXPECT_EQ(field[sheet.index(row, 3)], row);
  }
}

} // namespace row_partition_test
