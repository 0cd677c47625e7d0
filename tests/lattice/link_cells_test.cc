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

using namespace latcon;

using lattice::LinkCells;
using Cloud = std::vector<std::pair<double, double>>;
using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

double distance(const Cloud &cloud, std::size_t i, std::size_t j)
{
  return std::hypot(cloud[i].first - cloud[j].first, cloud[i].second - cloud[j].second);
}

Pairs all_pairs(const Cloud &cloud, double reach)
{
  Pairs pairs;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t j = i + 1; j < cloud.size(); ++j)
      if (distance(cloud, i, j) <= reach)
        pairs.insert({i, j});
  return pairs;
}

// Pairs within reach that the cells show, each of which must be shown once from either end.
// @param earlier where the points were before, if anywhere
Pairs pairs_from_cells(const Cloud &cloud, double reach, const Cloud &earlier = {})
{
  LinkCells cells(reach);
  for (const Cloud &positions : {earlier, cloud})
    for (std::size_t i = 0; i < positions.size(); ++i)
      cells.put(i, positions[i].first, positions[i].second);
  std::multiset<std::pair<std::size_t, std::size_t>> seen;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cells.for_each_near(cloud[i].first, cloud[i].second,
                        [&](std::size_t j)
                        {
                          if (i != j && distance(cloud, i, j) <= reach)
                            seen.insert({std::min(i, j), std::max(i, j)});
                        });
  const Pairs pairs(seen.begin(), seen.end());
  for (const auto &pair : pairs)
    EXPECT_EQ(seen.count(pair), 2u) << pair.first << ", " << pair.second;
  return pairs;
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

TEST(LinkCells, ShowThePairsOfRandomCloudsAtEveryDensity)
{
  for (const double reach : {0.01, 0.1, 0.3, 2.}) // from hardly a neighbour to all of them
    for (const unsigned int seed : {1u, 2u, 3u})
    {
      const Cloud cloud = random_cloud(400, 2., 0.5, seed);
      EXPECT_EQ(pairs_from_cells(cloud, reach), all_pairs(cloud, reach)) << reach;
    }
}

TEST(LinkCells, ShowThePairsOfAClusterAmongStragglers)
{
  Cloud cloud = random_cloud(200, 0.02, 0.02, 4);
  for (const auto &point : random_cloud(50, 1e4, 1e4, 5))
    cloud.push_back(point);
  EXPECT_EQ(pairs_from_cells(cloud, 0.01), all_pairs(cloud, 0.01));
}

TEST(LinkCells, ShowPointsWhereTheyWerePutLast)
{
  Cloud earlier = random_cloud(300, 2., 0.5, 6);
  for (std::size_t i = 0; i < 50; ++i) // in one cell, and nowhere
    earlier[i] = i % 2 == 0 ? earlier[0] : std::pair(std::numeric_limits<double>::infinity(), 0.);
  const Cloud cloud = random_cloud(400, 2., 0.5, 7);
  EXPECT_EQ(pairs_from_cells(cloud, 0.1, earlier), all_pairs(cloud, 0.1));
}

// Points on a grid of the reach: neighbours at exactly the reach, on the borders of cells if these were no larger.
TEST(LinkCells, ShowPairsOnTheBordersOfCells)
{
  const double reach = 0.1;
  Cloud cloud;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      cloud.emplace_back(i * reach, j * reach);
  const Pairs pairs = pairs_from_cells(cloud, reach);
  EXPECT_EQ(pairs, all_pairs(cloud, reach));
  EXPECT_GT(pairs.size(), 17u * 16u); // rounding puts some of the 2 * 17 * 16 a bit beyond
}

TEST(LinkCells, LeaveOutWhatIsNowhere)
{
  LinkCells cells(1.);
  cells.put(0, 0., 0.);
  cells.put(1, std::numeric_limits<double>::quiet_NaN(), 0.);
  cells.put(2, 0., std::numeric_limits<double>::infinity());
  std::vector<std::size_t> near;
  cells.for_each_near(0.5, 0., [&](std::size_t id) { near.push_back(id); });
  EXPECT_EQ(near, std::vector<std::size_t>{0});
  cells.for_each_near(std::numeric_limits<double>::quiet_NaN(), 0., [](std::size_t) { FAIL(); });
  cells.clear();
  cells.for_each_near(0., 0., [](std::size_t) { FAIL(); });
  EXPECT_THROW(LinkCells(0.), std::invalid_argument);
}

} // namespace link_cells_test
