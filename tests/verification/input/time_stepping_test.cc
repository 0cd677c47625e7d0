// Time stepping of the lattice as chosen by a case. Refused choices: tests/verification/refusals.txt.
#include <gtest/gtest.h>

#include "lattice/chebyshev_stages.h"
#include "tests/verification/input/small_case.h"

namespace time_stepping_test
{

using namespace latcon;
using namespace input;

using small_case::Lines;

constexpr const char *chebyshev = "Time/integrator=runge-kutta-chebyshev";

// The rubber of fig1.prm.
void read(const Lines &overrides, Case &input)
{
  Parameters parameters;
  small_case::read(overrides, input, parameters,
                   {"Sheet/spacing=0.625 mm", "Loading/strain x=1.3", "Loading/strain y=1.8",
                    "Nearest neighbours/viscosity=65.625", "Next-nearest neighbours/viscosity=196.875"});
  parameters.finish();
}

lattice::TimeStepping stepping(const Lines &overrides)
{
  Case input;
  read(overrides, input);
  return input.fracture_time_stepping();
}

lattice::TimeStepLimits limits()
{
  Case input;
  read({}, input);
  return lattice::time_step_limits(input.lattice(), input.material(), smallest_stable_stretch, input.contact_law());
}

TEST(TimeStepping, IsVelocityVerletUnlessToldOtherwise)
{
  EXPECT_EQ(stepping({}).stages, 0u);
  EXPECT_EQ(stepping({}).step, 0.9 * limits().combined);
  EXPECT_EQ(stepping({"Time/step=1e-8"}).step, 1e-8);
}

TEST(TimeStepping, TakesStagesForTheStep)
{
  const lattice::TimeStepping automatic = stepping({chebyshev});
  EXPECT_EQ(automatic.stages, lattice::ChebyshevStages::needed(automatic.step / limits().viscous));
  EXPECT_GT(automatic.step, 10. * limits().combined);
  const lattice::TimeStepping shorter = stepping({chebyshev, "Time/safety factor=0.3"});
  EXPECT_NEAR(shorter.step, automatic.step / 3., 1e-12 * automatic.step);
  EXPECT_LT(shorter.stages, automatic.stages);
  EXPECT_EQ(stepping({chebyshev, "Time/step=5e-6"}).stages, lattice::ChebyshevStages::needed(5e-6 / limits().viscous));
}

// Stages too few for the automatic step shorten it; a given step is not changed.
TEST(TimeStepping, TakesTheStepForStages)
{
  const lattice::TimeStepping few = stepping({chebyshev, "Time/stages=3"});
  EXPECT_EQ(few.stages, 3u);
  EXPECT_EQ(few.step, lattice::ChebyshevStages(3).real_limit() * limits().viscous);
  EXPECT_EQ(stepping({chebyshev, "Time/stages=20"}).step, stepping({chebyshev}).step);
  const lattice::TimeStepping stated = stepping({chebyshev, "Time/stages=4", "Time/step=2.5e-6"});
  EXPECT_EQ(stated.stages, 4u);
  EXPECT_EQ(stated.step, 2.5e-6);
}

// Sites of a crack may touch; the motion of a whole sheet has no contacts.
TEST(TimeStepping, CountsContactsUnderRungeKuttaChebyshev)
{
  const Lines breaks{chebyshev, "Fracture/breaking stretch=3.05", "Sheet/length=40 mm"};
  const auto with = [&](const std::string &entry)
  {
    Lines all = breaks;
    all.push_back(entry);
    Case input;
    read(all, input);
    return std::pair(input.fracture_time_stepping(), input.lattice_time_stepping());
  };
  const auto [as_bonds, alone] = with("Contact/stiffness=1");
  EXPECT_EQ(as_bonds.step, alone.step);
  double before = as_bonds.step;
  for (const std::string stiffness : {"1000", "1e6"})
  {
    const auto [stiff, without] = with("Contact/stiffness=" + stiffness);
    EXPECT_LT(stiff.step, 0.1 * before);
    EXPECT_EQ(without.step, alone.step);
    before = stiff.step;
  }
  EXPECT_EQ(with("Contact/present=false").first.step, alone.step);
  EXPECT_NO_THROW(stepping({chebyshev, "Contact/viscosity=0"})); // nothing breaks
}

// The stiff contacts of a crack shorten its step, but `latcon lattice` reads the same case.
TEST(TimeStepping, ComparesRelaxationTimesWithTheLongerStep)
{
  Lines lines{chebyshev, "Fracture/breaking stretch=3.05", "Sheet/length=40 mm", "Contact/stiffness=1000",
              "Nearest neighbours/branch moduli=1 Pa"};
  Case input;
  read({lines[0], lines[1], lines[2], lines[3]}, input);
  const double step = input.lattice_time_stepping().step;
  ASSERT_LT(input.fracture_time_stepping().step, 0.1 * step);
  const auto relaxing_in = [&](double time)
  {
    Lines all = lines;
    all.push_back("Nearest neighbours/relaxation times=" + std::to_string(1e9 * time) + "e-9");
    return all;
  };
  EXPECT_THROW(stepping(relaxing_in(0.5 * step)), support::InputError);
  EXPECT_NO_THROW(stepping(relaxing_in(2. * step)));
}

} // namespace time_stepping_test
