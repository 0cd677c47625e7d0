// The claim on a running crack fails when either side is wrong.
#include "verification/claims/running_crack/running_crack_claim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "continuum/flank.h"
#include "support/fits.h"
#include "tests/verification/claims/faults.h"
#include "verification/claims/bonds.h"

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

// Rows of the claim with something changed, for some of the continua.
Results with(const Plant &plant, const std::vector<std::string> &names = {"local"})
{
  CrackSides sides = crack_sides(rubber(), small());
  const auto is_other = [&](const NamedContinuum &side)
  { return std::find(names.begin(), names.end(), side.name) == names.end(); };
  sides.continua.erase(std::remove_if(sides.continua.begin(), sides.continua.end(), is_other), sides.continua.end());
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
  ASSERT_EQ(sides.continua.size(), 10u);
  for (const auto &[name, side, cut] : sides.continua)
  {
    EXPECT_EQ(cut.size(), name.find("-flank") != std::string::npos ? 6u : 0u) << name;
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
// ahead. Without what the crack has cut, the continuum is nearer to the lattice, and loses as much energy. The lattice
// is the same, so that tips differ by the laws alone.
TEST(RunningCrack, IsHeldBackByWhatTheLatticeLacks)
{
  const Results results = with([](CrackSides &) {}, {"local", "gradient", "viscous-gradient", "local-flank"});
  const auto row = [&](const std::string &what, const std::string &name)
  {
    for (const Result &candidate : results.rows())
      if (candidate.quantity.find(what) != std::string::npos &&
          candidate.quantity.find(" " + name + " continuum") != std::string::npos)
        return candidate;
    throw std::invalid_argument(what + name);
  };
  const auto tip = [&](const std::string &name) { return row("effective tip", name).lattice.value(); };
  EXPECT_GT(tip("viscous-gradient"), tip("gradient") + 0.2);
  const auto gain = [&](const std::string &what)
  { return *row(what, "local-flank").error / *row(what, "local").error; };
  // All are 1 with whole flanks; the velocity is 0.78 and the flux 0.63 if dashpots alone are cut.
  const std::pair<const char *, double> limits[] = {
    {"velocity, 5 d", 0.7}, {"velocity, 1.5 d", 0.8}, {"opening profile, 5 d", 0.8}, {"energy flux", 0.6}};
  for (const auto &[quantity, limit] : limits)
    EXPECT_LT(gain(quantity), limit) << quantity;
}

// What a straight cut takes from a homogeneous sheet, exactly: energy of bonds and power of dashpots
// (theory-comparison.md, eq. (H.31)).
TEST(Flank, LacksTheBondsThatTheLatticeLacks)
{
  const Eigen::Matrix2d F{{2.3, 0.4}, {-0.2, 2.8}}, rate{{20., -90.}, {30., 50.}};
  for (const lattice::Orientation orientation :
       {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
  {
    const double d = rubber().spacing, from = 8.1 * d;
    CrackDrive drive{d, orientation, 40. * d, 20. * d, from, 1., 4};
    const double to = from + 8. * (drive.rows_along() ? d : std::sqrt(3.) * d); // whole periods
    const lattice::TriangularLattice sheet(d, drive.length, drive.height, orientation);
    double energy = 0., power = 0.;
    const lattice::State state = lattice::homogeneous_state(sheet, rubber().material, F, lattice::Edges::free);
    for (const lattice::Bond &bond : bonds(state, sheet))
    {
      const Eigen::Vector2d L = sheet.bond_vector(bond.kind), X = sheet.reference(bond.near);
      const double share = (drive.axis() - X.y()) / L.y(), crossing = X.x() + share * L.x();
      if (!(share > 0. && share < 1. && crossing > from && crossing < to))
        continue;
      const lattice::Shell &shell = *rubber().material.shell(bond.kind);
      const double l = sheet.rest_length(bond.kind), section = lattice::cross_section(shell, sheet);
      const Eigen::Vector2d n = (F * L).normalized();
      energy += section * l * lattice::energy(shell.law, (F * L).norm() / l);
      power += section / l * shell.viscosity * std::pow(n.dot(rate * L), 2);
    }

    const auto viscosity = homogenised_viscosity(sheet, rubber().material);
    const continuum::CauchyBorn whole = cauchy_born(sheet, rubber().material);
    continuum::Flank flank(drive.axis(), from, drive.pitch(), bond_families(sheet, rubber().material), whole,
                           viscosity.get());
    const auto E = to_continuum(F);
    const auto dissipation = [&](const continuum::Viscosity &of)
    {
      continuum::PointIntegrand density;
      continuum::clear(density, continuum::Order::value);
      const Eigen::Matrix2d rate_and_identity = rate + Eigen::Matrix2d::Identity();
      of.add_density(continuum::field_derivatives(E), continuum::field_derivatives(to_continuum(rate_and_identity)),
                     continuum::Order::value, 0., density);
      return density.value;
    };
    double missing_energy = 0., missing_power = 0.;
    const double area = 2. * (to - from) * drive.pitch(); // of a layer, on both flanks
    for (int layer = 0; layer < 5; ++layer)
    {
      const dealii::Point<2> X(0.5 * (from + to), drive.axis() + (layer + 0.5) * drive.pitch());
      flank.cut_to(from);
      EXPECT_EQ(flank.law().at(X).energy(E), whole.energy(E));
      flank.cut_to(to);
      missing_energy += area * (whole.energy(E) - flank.law().at(X).energy(E));
      missing_power += area * (dissipation(*viscosity) - dissipation(flank.viscosity()->at(X)));
    }
    EXPECT_NEAR(missing_energy / energy, 1., 1e-12);
    EXPECT_NEAR(missing_power / power, 1., 1e-12);

    const continuum::Material &law = flank.law().at({0.5 * (from + to), drive.axis() + 0.5 * drive.pitch()});
    const double e = 1e-5;
    for (unsigned int k = 0; k < 4; ++k)
    {
      auto up = E, down = E;
      up[k / 2][k % 2] += e;
      down[k / 2][k % 2] -= e;
      const double scale = law.first_piola_stress(E).norm();
      EXPECT_NEAR((law.energy(up) - law.energy(down)) / (2. * e) / scale,
                  law.first_piola_stress(E)[k / 2][k % 2] / scale, 1e-8);
      const auto slope = (law.first_piola_stress(up) - law.first_piola_stress(down)) / (2. * e);
      for (unsigned int i = 0; i < 4; ++i)
        EXPECT_NEAR(slope[i / 2][i % 2] / scale, law.tangent(E)[i / 2][i % 2][k / 2][k % 2] / scale, 1e-8);
    }
  }
}

// A strip with free edges that is stretched along its rows: its edges hold the energy of the lattice's, up to a part of
// what the rows next to an edge gain by moving.
TEST(Flank, HasTheEdgeEnergyOfALattice)
{
  const double d = rubber().spacing;
  const lattice::TriangularLattice sheet = rubber().sheet();
  const CrackDrive drive{d, rubber().orientation, 10. * d, 10. * d, 0., 1., 4};
  constexpr std::size_t n_rows = 10;
  for (const double along : {1.01, 1.5, 2.3})
  {
    // Per period d of the rows, which are at heights y [m].
    const auto energy = [&](const std::vector<double> &y)
    {
      double sum = 0.;
      for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
        if (const lattice::Shell *shell = rubber().material.shell(kind))
        {
          const Eigen::Vector2d L = sheet.bond_vector(kind);
          const auto rows = static_cast<std::size_t>(std::lround(std::abs(L.y()) / drive.pitch()));
          const double l = sheet.rest_length(kind), section = lattice::cross_section(*shell, sheet);
          for (std::size_t j = 0; j + rows < y.size(); ++j)
            sum += section * l * lattice::energy(shell->law, std::hypot(along * L.x(), y[j + rows] - y[j]) / l);
        }
      return sum;
    };
    // Least energy of a layer per period and row, and the stretch across it.
    const auto relaxed = [&](const continuum::Material &law)
    {
      const auto of = [&](double across) {
        return law.energy(to_continuum(Eigen::Matrix2d{{along, 0.}, {0., across}}));
      };
      const double across = support::golden_section(of, 0.4, 1.2, 1e-9);
      return std::pair(of(across) * d * drive.pitch(), across);
    };
    const auto [bulk, across] = relaxed(rubber().cauchy_born);

    std::vector<double> y(n_rows);
    for (std::size_t j = 0; j < n_rows; ++j)
      y[j] = across * drive.pitch() * static_cast<double>(j);
    const auto of_edge = [&, bulk_energy = bulk] { return 0.5 * (energy(y) - n_rows * bulk_energy); };
    const double homogeneous = of_edge();
    for (int sweep = 0; sweep < 200; ++sweep)
      for (double &height : y)
        height = support::golden_section(
          [&](double candidate)
          {
            height = candidate;
            return energy(y);
          },
          height - 0.1 * drive.pitch(), height + 0.1 * drive.pitch(), 1e-9 * d);
    const double of_lattice = of_edge();

    continuum::Flank flank(drive.axis(), 0., drive.pitch(), bond_families(sheet, rubber().material),
                           rubber().cauchy_born, nullptr);
    flank.cut_to(2. * d);
    double of_layers = 0.;
    for (int layer = 0; layer < 3; ++layer)
      of_layers += relaxed(flank.law().at({d, drive.axis() + (layer + 0.5) * drive.pitch()})).first - bulk;
    EXPECT_LT(of_lattice, of_layers) << along;
    EXPECT_LT(of_layers, homogeneous) << along;
    EXPECT_NEAR(of_layers / of_lattice, 1., 0.02) << along << " homogeneous " << homogeneous / of_lattice;
  }
}

// Faults, and parts of the names of rows that fail; one row, unless there may be more.
TEST(RunningCrack, FailsWhereEitherSideIsWrong)
{
  const auto stiffer = faults::scaled<continuum::IsotropicNetwork>(rubber().cauchy_born, 1.3);
  lattice::Material material = rubber().material;
  material.nearest.viscosity *= 3.;
  material.next_nearest->viscosity *= 3.;
  const lattice::TriangularLattice sheet(rubber().spacing, 0.01, 0.01, rubber().orientation);
  const std::shared_ptr<const continuum::Viscosity> viscosity = homogenised_viscosity(sheet, material);
  const struct
  {
    Plant plant;
    const char *one_row, *rows;
  } planted[] = {
    {[](CrackSides &sides) { sides.half.tip = rubber().spacing; }, "effective tip", "velocity"},
    {[&](CrackSides &sides) { medium(sides, "local").constitution.local = &stiffer; }, "opening stress", ""},
    {[&](CrackSides &sides) { medium(sides, "local").viscosity = viscosity; }, "", "continuum against lattice"},
    {[](CrackSides &sides) { medium(sides, "local").inertia.density = std::nan(""); }, "local continuum: not computed",
     ""}};
  for (const auto &[plant, one_row, rows] : planted)
  {
    const Results results = with(plant);
    EXPECT_TRUE(*one_row == '\0' || faults::failing(results, one_row) == 1u) << results.verdict_text(10);
    EXPECT_GE(faults::failing(results, rows), 1u) << results.verdict_text(10);
  }
}

TEST(RunningCrack, ReportsAGradientContinuumThatCannotBeComputed)
{
  const faults::Combination wrong(-1., rubber().network_gradient, 0., rubber().network_gradient);
  const Results results =
    with([&](CrackSides &sides) { medium(sides, "gradient").constitution.gradient = &wrong; }, {"local", "gradient"});
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(10);
  EXPECT_TRUE(std::any_of(results.rows().begin(), results.rows().end(),
                          [](const Result &row)
                          {
                            return row.quantity.find(": gradient continuum: not computed") != std::string::npos &&
                                   row.verdict() == Verdict::reported;
                          }));
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
      values.velocity = {2. * site.xi + 3. * site.eta - 10., -site.eta};
      values.opening_stress = 1. + site.xi;
      field.add(site, values);
      ++n;
    }
  const double full_area =
    0.5 * static_cast<double>(n) * field.pitch().prod(); // a point has four sites, two of each half
  EXPECT_NEAR(full_area, M_PI * 36., 0.05 * M_PI * 36.);
  for (const TipField::Point &point : field.points())
  {
    EXPECT_NEAR(point.values.velocity.x(), 2. * point.xi + 3. * point.eta - 10., 1e-12);
    EXPECT_NEAR(point.values.opening_stress, 1. + point.xi, 1e-12);
  }
  const TipValues between = field.at(1.3, 2.1);
  EXPECT_NEAR(between.velocity.x(), 2. * 1.3 + 3. * 2.1 - 10., 1e-12);
  EXPECT_NEAR(field.at(-0.7, 0.).velocity.y(), 0., 1e-12);
  EXPECT_FALSE(std::isfinite(field.at(7., 0.).velocity.x()));
  EXPECT_EQ(opening_stress(field, 3.).ratio, 1.);
  EXPECT_FALSE(opening_stress(field, 7.).ratio >= 1.);
  // Slower than -1: 2 xi + 3 eta < 9, points 7, 5 and 2 of the three lowest lines.
  const analysis::NegativeZone zone = negative_zone(field, 1., 5.);
  EXPECT_NEAR(zone.area, 14. * field.pitch().prod(), 1e-12);
  EXPECT_NEAR(zone.depth, 2. * 0.375 + 3. * 0.5 * field.pitch().y() - 10., 1e-12);
}

} // namespace running_crack_test
