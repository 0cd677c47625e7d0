// Stresses of sites whose bonds have a memory.
#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "lattice/site_fields.h"
#include "tests/lattice/sheets.h"

namespace memory_stress_test
{

using namespace latcon::lattice;

// A sheet at rest in the reference configuration that is stretched at once. theory.md, eq. (L.31), at the start:
// P = P_law + sum A0 l / V E (lam - 1) n N.
TEST(BondMemoryStress, IsThatOfTheOverstress)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber_with_memory();
  const Eigen::Matrix2d F = sheets::stretched(1.4, 1.3);
  State at_rest = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  relax_memory(at_rest, sheet, material);
  State stretched = homogeneous_state(sheet, material, F, Edges::held);
  stretched.history = at_rest.history;
  const Simulation simulation(sheet, material, std::move(stretched), 2e-7);
  State without = simulation.state();
  without.history = {};

  const std::size_t middle = sheet.index(sheet.rows() / 2, sheet.columns() / 2);
  Eigen::Matrix2d overstress = Eigen::Matrix2d::Zero();
  for (std::size_t kind = 0; kind < 2 * n_kinds_per_shell; ++kind)
  {
    const Eigen::Vector2d R = sheet.bond_vector(kind), r = F * R;
    const double modulus = TriangularLattice::is_nearest(kind) ? 3e5 : 1.5e5; // as in rubber_with_memory()
    overstress += cross_section(*material.shell(kind), sheet) / sheet.site_area() * modulus *
                  (r.norm() / R.norm() - 1.) * r.normalized() * R.transpose();
  }
  const SiteEvaluator evaluator(sheet, material);
  const Eigen::Matrix2d found =
    evaluator.at(simulation.state(), middle).first_piola_stress - evaluator.at(without, middle).first_piola_stress;
  // Sums over twelve bonds, the stress of the laws being several times that of the memories.
  EXPECT_LT((found - overstress).norm(), 1e-13 * overstress.norm());
}

} // namespace memory_stress_test
