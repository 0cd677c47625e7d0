#include "lattice/link_cells.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace link_cells_test
{

using latcon::lattice::LinkCells;
using Cloud = std::vector<std::pair<double, double>>;
using Pairs = std::multiset<std::pair<std::size_t, std::size_t>>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_near(const Cloud &cloud, std::size_t i, std::size_t j, double reach)
{
  return i != j && std::hypot(cloud[i].first - cloud[j].first, cloud[i].second - cloud[j].second) <= reach;
}

Cloud random_cloud(std::size_t n, double width, double height, unsigned int seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i)
  {
    const double x = width * uniform(generator);
    cloud.emplace_back(x, height * uniform(generator));
  }
  return cloud;
}

// Pairs within reach must be shown once from either end.
// @param earlier where the points were before, if anywhere
void expect_all_pairs(const Cloud &cloud, double reach, const Cloud &earlier = {})
{
  LinkCells cells(reach);
  for (const Cloud &positions : {earlier, cloud})
    for (std::size_t i = 0; i < positions.size(); ++i)
      cells.put(i, positions[i].first, positions[i].second);
  Pairs expected, shown;
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    for (std::size_t j = 0; j < cloud.size(); ++j)
      if (is_near(cloud, i, j, reach))
        expected.insert({i, j});
    cells.for_each_near(cloud[i].first, cloud[i].second,
                        [&](std::size_t j)
                        {
                          if (is_near(cloud, i, j, reach))
                            shown.insert({i, j});
                        });
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(shown, expected) << reach;
}

TEST(LinkCells, ShowAllPairsAtEveryDensity)
{
  for (const double reach : {0.01, 0.1, 0.3, 2.}) // from hardly a neighbour to all of them
    expect_all_pairs(random_cloud(400, 2., 0.5, 1), reach);
  Cloud cluster = random_cloud(200, 0.02, 0.02, 4); // among stragglers
  for (const auto &point : random_cloud(50, 1e4, 1e4, 5))
    cluster.push_back(point);
  expect_all_pairs(cluster, 0.01);
  Cloud grid; // neighbours at the reach, on the borders of cells if these were no larger
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      grid.emplace_back(i * 0.1, j * 0.1);
  expect_all_pairs(grid, 0.1);
}

TEST(LinkCells, ShowPointsWhereTheyWerePutLast)
{
  Cloud earlier = random_cloud(300, 2., 0.5, 6);
  for (std::size_t i = 0; i < 50; ++i) // in one cell, and nowhere
    earlier[i] = i % 2 == 0 ? earlier[0] : std::pair(infinity, 0.);
  expect_all_pairs(random_cloud(400, 2., 0.5, 7), 0.1, earlier);
}

TEST(LinkCells, LeaveOutWhatIsNowhere)
{
  LinkCells cells(1.);
  cells.put(0, 0., 0.);
  cells.put(1, nan, 0.);
  cells.put(2, 0., infinity);
  cells.put(3, 1e12, 0.); // farther than cells are numbered
  std::vector<std::size_t> near;
  cells.for_each_near(0.5, 0., [&](std::size_t id) { near.push_back(id); });
  EXPECT_EQ(near, std::vector<std::size_t>{0});
  cells.for_each_near(nan, 0., [](std::size_t) { FAIL(); });
  cells.for_each_near(1e12, 0., [](std::size_t) { FAIL(); });
  cells.clear();
  cells.for_each_near(0., 0., [](std::size_t) { FAIL(); });
  EXPECT_THROW(LinkCells(0.), std::invalid_argument);
}

} // namespace link_cells_test
