// A checkpoint before a step that is divided (theory.md, eq. (L.24)): the run that goes on divides it too.
#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"
#include "tests/support/temporary_folder.h"
#include "verification/output/archive.h"

namespace divided_step_test
{

using namespace latcon;
using namespace lattice;

TEST(Checkpoint, LeavesTheNextStepDivided)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const std::size_t near = sheet.index(4, 3), far = near + 1;
  const double now = 0.7, then = 0.45, h = 1.01 * recoil_step({1., 2}, sheet, material, 0, short_stretch, nullptr);
  const auto start = [&]
  {
    auto simulation = std::make_unique<Simulation>(
      sheet, material, homogeneous_state(sheet, material, now * Eigen::Matrix2d::Identity(), Edges::held),
      TimeStepping(h, 2));
    Field vx(sheet.n_places()), vy(sheet.n_places());
    vx[near] = 0.5 * (now - then) * sheet.spacing() / h;
    vx[far] = -vx[near];
    simulation->set_velocities(vx, vy);
    return simulation;
  };
  const auto saved = start(), loaded = start();
  output::Hdf5Image image;
  output::CheckpointWriter writer(&image);
  saved->archive(writer);
  const TemporaryFolder folder;
  const std::string path = folder / "checkpoint.h5";
  std::ofstream(path, std::ios::binary) << image.take_bytes();
  const output::Hdf5File file(path);
  output::CheckpointReader reader(file);
  loaded->archive(reader);
  for (Simulation *simulation : {saved.get(), loaded.get()})
  {
    simulation->step();
    EXPECT_EQ(simulation->n_divided_steps(), 1u);
  }
  EXPECT_EQ(saved->state().x[near], loaded->state().x[near]);
}

} // namespace divided_step_test
