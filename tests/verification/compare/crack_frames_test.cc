// Frames written by the claim `running-crack` can be compared.
#include "verification/claims/running_crack/running_crack_claim.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/verification/claims/faults.h"
#include "verification/compare/comparison.h"

namespace crack_frames_test
{

using namespace latcon;
using namespace bridge;
using namespace claims;
using namespace compare;
using namespace output;

// The frames of both sides have the same time and common coordinates.
TEST(RunningCrack, LeavesFramesThatCanBeCompared)
{
  const Subject rubber = subject(subjects::paper_case());
  TemporaryFolder folder;
  RunningCrackOptions options;
  options.length = 40.;
  options.height = 26.;
  options.start = 10.;
  options.advance = 18.;
  options.far = 8.;
  options.finest = 2.;
  options.frames = folder.path();
  const CrackSides sides = crack_sides(rubber, options);
  const ClaimOutcome outcome = running_crack_claim(rubber, sides, options);
  const Table &table = outcome.tables.at("running_crack_frames");
  ASSERT_EQ(table.rows().size(), 4u);
  const auto path = [&](std::size_t row) { return options.frames + "/" + std::get<std::string>(table.rows()[row][2]); };
  const Position tip{{std::get<double>(table.rows()[0][3]), std::get<double>(table.rows()[0][4])}};
  const LatticeFrame lattice = read_lattice_frame(find_frame(path(0), Side::lattice, {}));
  EXPECT_NEAR(lattice.time, sides.drive.n_strides * sides.drive.stride_time(), 1e-9 * lattice.time);
  for (const std::size_t side : {1u, 2u, 3u})
  {
    const ContinuumFrame continuum = read_continuum_frame(find_frame(path(side), Side::continuum, {}));
    EXPECT_NO_THROW(require_same_time(lattice, continuum));
    const auto difference = [&](const Position &centre)
    {
      const Scope scope{true, {{centre, 5. * rubber.spacing}}};
      const Results results =
        norms(lattice, continuum, compare::compare(lattice, continuum, scope, MPI_COMM_WORLD), {});
      for (const Result &row : results.rows())
        if (row.quantity == "velocity, largest difference")
          return row.error.value();
      return std::nan("");
    };
    // The largest difference is at the tip.
    EXPECT_LT(difference(tip), 0.5 * difference({{tip[0] - 8. * rubber.spacing, tip[1]}}));
  }
}

} // namespace crack_frames_test
