#include "lattice/link_cells.h"

#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace link_cells_test
{

using latcon::lattice::LinkCells;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// That all pairs are shown: Contact.ListNeverMissesAPair.
TEST(LinkCells, LeaveOutWhatIsNowhere)
{
  LinkCells cells(1.);
  const Eigen::Vector2d nowhere(nan, 0.), at_infinity(0., infinity), farther_than_cells(1e12, 0.), here(0., 0.);
  cells.move(0, nowhere, here);
  cells.move(1, nowhere, nowhere);
  cells.move(2, nowhere, at_infinity);
  cells.move(3, at_infinity, farther_than_cells);
  std::vector<std::size_t> near;
  cells.for_each_near({0.5, 0.}, [&](const LinkCells::Point &point) { near.push_back(point.id); });
  EXPECT_EQ(near, std::vector<std::size_t>{0});
  cells.for_each_near(nowhere, [](const LinkCells::Point &) { FAIL(); });
  cells.for_each_near(farther_than_cells, [](const LinkCells::Point &) { FAIL(); });
  cells.clear();
  cells.for_each_near(here, [](const LinkCells::Point &) { FAIL(); });
  EXPECT_THROW(LinkCells(0.), std::invalid_argument);
}

} // namespace link_cells_test
