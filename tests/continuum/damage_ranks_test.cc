// Motion with damage on several ranks: the bits of one rank. Each rank moves the whole sheet on its own communicator,
// then all move it together.
#include "continuum/damage/damage_motion.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace damage_ranks_test
{

using namespace latcon::continuum;
using dealii::Point;
using dealii::Tensor;

constexpr double pi = 3.14159265358979323846, spacing = 1e-3;

// Triangular lattice with both shells.
std::vector<BondFamily> bonds()
{
  std::vector<BondFamily> all;
  for (unsigned int k = 0; k < 6; ++k)
  {
    const Tensor<1, 2> N({std::cos(pi * k / 6.), std::sin(pi * k / 6.)});
    all.push_back({{N, k % 2 == 0 ? 0.7 : 1.4, RodPotential{1e5, 1.5e5}}, (k % 2 == 0 ? 1. : std::sqrt(3.)) * spacing});
  }
  return all;
}

struct Kind
{
  double viscosity, step; // [Pa s], [s]
  bool has_gradient, has_micro_inertia;
};

// A strip held along Y = -top and top, with a seed crack off the middle and an uneven velocity. Its rows divide evenly
// among no number of ranks from 2 to 4.
DamageMotion strip(const Kind &kind, MPI_Comm communicator, const double velocity = 0.3)
{
  const double top = 0.0105;
  DamageMotionSetup setup{Rectangle{0.02, 2. * top, 40, 42}, {}, {}, {}, 1000., {2e5, spacing}, {}, {}, kind.step};
  setup.loading[0][0] = 1.2;
  setup.loading[1][1] = 1.8;
  for (const BondFamily &bond : bonds())
  {
    setup.families.push_back(bond.fibre);
    if (kind.viscosity > 0.)
      setup.dashpots.push_back({bond.fibre.direction, bond.fibre.weight, kind.viscosity});
  }
  if (kind.has_gradient)
    setup.gradient = GradientSetup{bonds(), 0.5 * spacing, kind.has_micro_inertia};
  setup.is_held = [top](const Point<2> &X, unsigned int) { return std::abs(X[1]) > top - 1e-6; };
  setup.is_intact = [top](const Point<2> &X) { return std::abs(X[1]) > top - 2.1 * spacing; };
  setup.communicator = communicator;
  DamageMotion motion(setup);
  motion.set_damage(
    [](const Point<2> &X)
    {
      const double left = 1. - std::hypot(std::max(X[0] - 0.006, 0.), X[1] - 0.001) / (2. * spacing);
      return left > 0. ? std::min(1., 1.3 * left * left) : 0.;
    });
  motion.set_motion([](const Point<2> &) { return Tensor<1, 2>(); },
                    [velocity](const Point<2> &X) {
                      return Tensor<1, 2>({velocity * std::sin(900. * X[1]), velocity * std::cos(700. * X[0])});
                    });
  return motion;
}

class DamageOnRanks : public testing::TestWithParam<Kind>
{
};

TEST_P(DamageOnRanks, HasTheBitsOfOneRank)
{
  DamageMotion alone = strip(GetParam(), MPI_COMM_SELF), together = strip(GetParam(), MPI_COMM_WORLD);
  for (int step = 0; step < 12; ++step)
  {
    alone.advance();
    together.advance();
  }
  EXPECT_GT(alone.ledger().fracture, 0.);
  for (const unsigned int i : {0u, 1u})
  {
    EXPECT_EQ(together.displacement()[i], alone.displacement()[i]);
    EXPECT_EQ(together.velocity()[i], alone.velocity()[i]);
  }
  EXPECT_EQ(together.damage().nodal(), alone.damage().nodal());
  EXPECT_EQ(together.cell_energies(), alone.cell_energies());
  EXPECT_EQ(together.ledger().viscous, alone.ledger().viscous);
  EXPECT_EQ(together.ledger().gradient, alone.ledger().gradient);
  EXPECT_EQ(together.ledger().imbalance, alone.ledger().imbalance);
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamageOnRanks,
                         testing::Values(Kind{0., 4e-6, false, false}, Kind{20., 8e-6, false, false},
                                         Kind{20., 3e-6, true, true}, Kind{20., 3e-6, true, false}));

TEST(DamageOnRanks, FailsOnAllRanksWithOneMessage)
{
  std::string messages[2];
  for (const MPI_Comm communicator : {MPI_COMM_SELF, MPI_COMM_WORLD})
  {
    std::string &message = messages[communicator == MPI_COMM_WORLD ? 1 : 0];
    DamageMotion motion = strip({20., 8e-6, false, false}, communicator, 3e3); // inverts cells
    try
    {
      for (int step = 0; step < 100; ++step)
        motion.advance();
    }
    catch (const NonPhysicalState &error)
    {
      message = error.what();
    }
  }
  EXPECT_NE(messages[0], "");
  EXPECT_EQ(messages[1], messages[0]);
}

TEST(DamageOnRanks, NeedARowEach)
{
  const auto n = static_cast<unsigned int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
  EXPECT_NO_THROW(RowBands(NodeGrid(Rectangle{1., 1., 2, n}), MPI_COMM_WORLD));
  if (n > 2)
  {
    EXPECT_THROW(RowBands(NodeGrid(Rectangle{1., 1., 2, n - 2}), MPI_COMM_WORLD), InvalidInput);
  }
}

} // namespace damage_ranks_test
