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
