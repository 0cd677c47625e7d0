// The claim on a running crack fails when either side is wrong.
#include "verification/claims/running_crack/running_crack_claim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/verification/claims/faults.h"

namespace running_crack_test
{

using namespace latcon;
using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

// The rubber of Fig. 1 in a sheet just large enough for a far field.
RunningCrackOptions small()
{
  RunningCrackOptions options;
  options.length = 40.;
  options.height = 26.;
  options.start = 10.;
  options.advance = 18.;
  options.far = 8.;
  options.finest = 2.;
  return options;
}

const Subject &rubber()
{
  static const Subject subject = bridge::subject(subjects::paper_case());
  return subject;
}

using Plant = std::function<void(CrackSides &)>;

WaveContinuum &medium(CrackSides &sides, const std::string &name)
{
  for (NamedContinuum &side : sides.continua)
    if (side.name == name)
      return side.medium;
  throw std::invalid_argument(name);
}

// Rows of the claim with something changed.
Results with(const Plant &plant)
{
  CrackSides sides = crack_sides(rubber(), small());
  plant(sides);
  return running_crack_claim(rubber(), sides, small()).results;
}

// The gradient continua and the opening of the flanks are reported; see docs/running-crack.md.
TEST(RunningCrack, HoldsInTheFarFieldOfTheLocalContinuum)
{
  const Results results = with([](CrackSides &) {});
  EXPECT_EQ(faults::failing(results, "local"), 0u) << results.verdict_text(10);
  EXPECT_EQ(results.count(Verdict::holds), 3u);
  for (const Result &row : results.rows())
    if (row.tolerance)
    {
      EXPECT_LE(*row.tolerance, row.quantity.find("effective tip") != std::string::npos ? 0.75 : 0.07) << row.quantity;
    }
}

// Each continuum consists of the parts that its name says.
TEST(RunningCrack, HasContinuaWithAndWithoutGradients)
{
  RunningCrackOptions options = small();
  options.anisotropic = true;
  const CrackSides sides = crack_sides(rubber(), options);
  ASSERT_EQ(sides.continua.size(), 6u);
  for (const auto &[name, side] : sides.continua)
  {
    const bool is_bonds = name.find("bonds-") == 0, has_gradient = name.find("gradient") != std::string::npos;
    const continuum::Material &law = is_bonds ? static_cast<const continuum::Material &>(rubber().cauchy_born)
                                              : static_cast<const continuum::Material &>(rubber().network);
    const auto &energy = is_bonds ? rubber().lattice_gradient : rubber().network_gradient;
    EXPECT_EQ(side.constitution.local, &law) << name;
    EXPECT_EQ(side.constitution.gradient, has_gradient ? energy.get() : nullptr) << name;
    EXPECT_EQ(side.inertia.length, has_gradient ? rubber().lengths.lattice : 0.) << name;
    EXPECT_EQ(side.viscosity->gradient() != nullptr, name.find("viscous-gradient") != std::string::npos) << name;
  }
}

// The gradient viscosity resists the opening of the flanks, where the lattice has lost dashpots: it needs a tip further
// ahead. The lattice is the same, so that tips differ by the laws alone.
TEST(RunningCrack, IsHeldBackByGradientViscosity)
{
  const Results results = with([](CrackSides &) {});
  const auto tip = [&](const std::string &name)
  {
    for (const Result &row : results.rows())
      if (row.quantity.find("effective tip") != std::string::npos &&
          row.quantity.find("of the " + name + " continuum") != std::string::npos)
        return row.lattice.value();
    return std::nan("");
  };
  EXPECT_GT(tip("viscous-gradient"), tip("gradient") + 0.2);
  EXPECT_GT(tip("gradient"), tip("local"));
}

TEST(RunningCrack, FailsForATipThatIsOffByASpacing)
{
  const Results results = with([](CrackSides &sides) { sides.half.tip = rubber().spacing; });
  EXPECT_EQ(faults::failing(results, "effective tip"), 1u) << results.verdict_text(10);
  EXPECT_GE(faults::failing(results, "velocity"), 1u);
}

TEST(RunningCrack, FailsForWrongModuli)
{
  const auto stiffer = faults::scaled<continuum::IsotropicNetwork>(rubber().cauchy_born, 1.3);
  const Results results = with(
    [&](CrackSides &sides)
    {
      for (NamedContinuum &side : sides.continua)
        side.medium.constitution.local = &stiffer;
    });
  EXPECT_EQ(faults::failing(results, "opening stress"), 1u) << results.verdict_text(10);
}

TEST(RunningCrack, FailsForWrongViscosity)
{
  lattice::Material material = rubber().material;
  material.nearest.viscosity *= 3.;
  material.next_nearest->viscosity *= 3.;
  const lattice::TriangularLattice sheet(rubber().spacing, 0.01, 0.01, rubber().orientation);
  const std::shared_ptr<const continuum::Viscosity> viscosity = homogenised_viscosity(sheet, material);
  const Results results = with(
    [&](CrackSides &sides)
    {
      for (NamedContinuum &side : sides.continua)
        side.medium.viscosity = viscosity;
    });
  EXPECT_GE(faults::failing(results, "continuum against lattice"), 1u) << results.verdict_text(10);
}

TEST(RunningCrack, ReportsAGradientContinuumThatCannotBeComputed)
{
  const faults::Combination wrong(-1., rubber().network_gradient, 0., rubber().network_gradient);
  const Results results = with([&](CrackSides &sides) { medium(sides, "gradient").constitution.gradient = &wrong; });
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(10);
  EXPECT_TRUE(std::any_of(results.rows().begin(), results.rows().end(),
                          [](const Result &row)
                          {
                            return row.quantity.find(": gradient continuum: not computed") != std::string::npos &&
                                   row.verdict() == Verdict::reported;
                          }));
}

// A side that is no number fails, whatever it is compared with.
TEST(RunningCrack, FailsForWhatIsNoNumber)
{
  const Results results = with([](CrackSides &sides) { medium(sides, "local").inertia.density = std::nan(""); });
  EXPECT_EQ(faults::failing(results, "local continuum: not computed"), 1u) << results.verdict_text(10);
}

// Sheets in which there is no such crack are not compared.
TEST(RunningCrack, LeavesOutSheetsThatDoNotOpen)
{
  Case input = subjects::paper_case();
  input.strain_x = input.strain_y = 0.;
  const Results results = running_crack_claim(subject(input), small()).results;
  ASSERT_EQ(results.rows().size(), 1u);
  EXPECT_EQ(results.rows()[0].verdict(), Verdict::reported);
}

// Means over four samples meet each point twice; what lies between points is interpolated, and mirrored below the
// crack.
TEST(TipField, AveragesAndInterpolates)
{
  CrackDrive drive{1., lattice::Orientation::rows_along_crack, 40., 30., 0., 1., 4};
  drive.start_near(20.);
  const lattice::TriangularLattice sheet(1., 40., 30., drive.orientation);
  TipField field(drive);
  std::size_t n = 0;
  for (unsigned int stride = 1; stride <= CrackDrive::n_samples; ++stride)
    for (const TipSite &site : tip_sites(drive, sheet, drive.tip(stride), 6.))
    {
      TipValues values;
      values.velocity = {2. * site.xi + 3. * site.eta, -site.eta};
      values.opening_stress = 1. + site.xi;
      field.add(site, values);
      ++n;
    }
  const double full_area =
    0.5 * static_cast<double>(n) * field.point_area(); // a point has four sites, two of each half
  EXPECT_NEAR(full_area, M_PI * 36., 0.05 * M_PI * 36.);
  for (const TipField::Point &point : field.points())
  {
    EXPECT_NEAR(point.values.velocity.x(), 2. * point.xi + 3. * point.eta, 1e-12);
    EXPECT_NEAR(point.values.opening_stress, 1. + point.xi, 1e-12);
  }
  const TipValues between = field.at(1.3, 2.1);
  EXPECT_NEAR(between.velocity.x(), 2. * 1.3 + 3. * 2.1, 1e-12);
  EXPECT_NEAR(field.at(-0.7, 0.).velocity.y(), 0., 1e-12);
  EXPECT_FALSE(std::isfinite(field.at(7., 0.).velocity.x()));
  EXPECT_NEAR(stress_lobes(field, 3.).ratio, 1., 1e-12);
  const BackwardZone zone = backward_zone(field, 1., 5.);
  EXPECT_EQ(zone.area, 0.);
}

} // namespace running_crack_test
