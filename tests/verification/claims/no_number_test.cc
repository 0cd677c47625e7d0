// Claim by claim and side by side: a side that is no number, or throws, fails the claim with a row that says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"
#include "verification/claims/claim_inputs.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/steady_crack/steady_crack_claim.h"
#include "verification/commands/command.h"

namespace no_number_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace output;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// The bonds of a shell, without a value from some stretch on.
class BondWithoutValues : public lattice::CustomBondLaw
{
public:
  explicit BondWithoutValues(const lattice::MooneyRivlinBond &bond) : bond_(bond) {}
  void set_last_stretch(double stretch) { last_stretch_ = stretch; }

  double energy(double stretch) const noexcept override { return at(stretch, bond_.energy(stretch)); }
  double force(double stretch) const noexcept override { return at(stretch, lattice::force(bond_, stretch)); }
  double stiffness(double stretch) const noexcept override { return at(stretch, bond_.stiffness(stretch)); }
  double largest_stiffness(double smallest_stretch) const noexcept override
  {
    return bond_.largest_stiffness(smallest_stretch);
  }

private:
  double at(double stretch, double value) const { return stretch > last_stretch_ ? not_a_number : value; }

  lattice::MooneyRivlinBond bond_;
  double last_stretch_ = std::numeric_limits<double>::infinity();
};

void without_values_beyond(Subject &subject, double stretch)
{
  for (lattice::Shell *shell : {&subject.material.nearest, &subject.material.next_nearest.value()})
  {
    const auto law = std::make_shared<BondWithoutValues>(std::get<lattice::MooneyRivlinBond>(shell->law));
    shell->law = lattice::CustomBond(law); // which must be sound at rest
    law->set_last_stretch(stretch);
  }
  subject.ratio_is_calibrated = false; // no Mooney-Rivlin law is fitted to bonds from outside
}

// A gradient energy that is no number, everywhere or where F is not I, or throws.
class GradientWithoutValues : public faults::Combination
{
public:
  enum class Kind
  {
    all,
    strained,
    throws
  };
  GradientWithoutValues(Law law, Kind kind) : Combination(1., law, 0., law), kind_(kind) {}

private:
  double factor(const dealii::Tensor<2, 2> &F) const override
  {
    if (kind_ == Kind::throws)
      throw std::domain_error("planted: no gradient energy");
    const bool is_strained = (F - dealii::Tensor<2, 2>(dealii::unit_symmetric_tensor<2>())).norm() > 1e-12;
    return kind_ == Kind::all || is_strained ? not_a_number : 1.;
  }

  Kind kind_;
};

using Kind = GradientWithoutValues::Kind;

std::function<void(Subject &)> without_values(faults::Combination::Law Subject::*law, Kind kind)
{
  return [law, kind](Subject &s) { s.*law = std::make_shared<GradientWithoutValues>(s.*law, kind); };
}

// A fibre network whose energy is beyond all numbers: infinite, and its stresses not numbers.
std::vector<continuum::FibreFamily> overflowing(const Subject &subject)
{
  std::vector<continuum::FibreFamily> families = subject.cauchy_born.families();
  for (continuum::FibreFamily &family : families)
  {
    family.potential = continuum::LinearPotential{1e300};
    family.weight = 1e300;
  }
  return families;
}

using parts::ClaimPart;
using parts::energy;
using parts::energy_of_waves;
using parts::intrinsic_length;
using parts::prestretch;
using parts::waves;

parts::States rest_and_loaded(const Subject &subject)
{
  return {Eigen::Matrix2d::Identity(), subject.deformation};
}

// In one state, and in two, of which the first leaves numbers that a maximum might keep.
const ClaimPart wave_energy{"energy, waves",
                            [](const Subject &s) { return energy_of_waves(s, {s.deformation}).results; }},
  wave_energy_in_both{"energy, waves", [](const Subject &s) { return energy_of_waves(s, rest_and_loaded(s)).results; }};
const ClaimPart wave_speeds{"wave-speeds",
                            [](const Subject &s) { return wave_speeds_claim(s, waves({s.deformation})).results; }},
  wave_speeds_in_both{"wave-speeds",
                      [](const Subject &s) { return wave_speeds_claim(s, waves(rest_and_loaded(s))).results; }};
const ClaimPart damped_waves{"wave-speeds, damped",
                             [](const Subject &s) { return wave_speeds_claim(s, waves({}, {s.deformation})).results; }};

CutStudy small_hole()
{
  CutStudy study = hole_study(true);
  study.sizes = {4., 5., 6., 8.};
  study.n_judged = 1;
  study.other_sizes = {8.};
  return study;
}

const ClaimPart hole{"prestretch, hole", [](const Subject &s) { return cut_claim(s, small_hole()).results; }};
const ClaimPart notch{"prestretch, notch", [](const Subject &s)
                      {
                        CutStudy study = notch_study(true);
                        study.sizes = {4., 5., 6., 8.};
                        study.other_sizes.clear();
                        study.mesh.cycles = 1;
                        return cut_claim(s, study).results;
                      }};

// With a memory, so that the claims about memories are among those before fracture.
lattice::Material material_with_branch()
{
  lattice::Material material = subjects::paper_case().material();
  material.nearest.memory = lattice::MaxwellMemory({{1e5, 1e-4}});
  return material;
}

// Quick versions of the claims before fracture for which there are no parts above.
std::vector<ClaimPart> claims_without_parts()
{
  std::vector<ClaimPart> list;
  for (const Claim &claim : latcon::commands::claims_before_fracture(material_with_branch()))
  {
    bool has_part = claim.is_about_program; // no subject has a part in it: NoNumberInSteadyCracks
    for (const ClaimPart &part : {energy, wave_energy, wave_speeds, damped_waves, intrinsic_length, prestretch})
      has_part = has_part || part.name == claim.name;
    if (!has_part)
      list.push_back({claim.name, [claim](const Subject &s)
                      {
                        const latcon::input::Case entries = claim_inputs(subjects::paper_case(), claim.entries);
                        return check_claim(claim.name, {s, entries, true, {}}).results;
                      }});
  }
  return list;
}

// A side of claims, made no number or to throw.
struct Side
{
  std::string name;
  std::function<void(Subject &)> plant;
  std::vector<ClaimPart> claims;
  std::string reason = ""; ///< words of a row that fails; none: a row fails because a value is not a number
};

struct Plant
{
  ClaimPart claim;
  Side side;
};

std::ostream &operator<<(std::ostream &out, const Plant &plant)
{
  return out << plant.claim.name << ": " << plant.side.name;
}

std::vector<Plant> every_claim_and_side()
{
  std::vector<ClaimPart> all = claims_without_parts();
  all.insert(all.end(), {energy, wave_energy, wave_speeds, damped_waves, intrinsic_length, prestretch, hole, notch});
  const std::string throws = "not computed: planted: no gradient energy";
  const auto lattice = &Subject::lattice_gradient, isotropic = &Subject::isotropic_gradient,
             network = &Subject::network_gradient;
  const std::vector<Side> sides{
    {"lattice", [](Subject &s) { without_values_beyond(s, 0.); }, all},
    {"Cauchy-Born", [](Subject &s) { s.cauchy_born = continuum::CauchyBorn(overflowing(s)); }, all},
    // Loaded bonds are up to 2.8 times as long: in these the first of several waves, or samples, are numbers.
    {"lattice where bonds are long",
     [](Subject &s) { without_values_beyond(s, 2.2); },
     {energy, wave_energy_in_both, wave_speeds_in_both, damped_waves, intrinsic_length, prestretch}},
    {"continuum throws, for it is turned inside out",
     [](Subject &s) { s.deformation = Eigen::Vector2d(-1.5, 1.5).asDiagonal(); },
     {energy, wave_energy, wave_speeds, damped_waves, intrinsic_length},
     "not computed: "},
    {"density",
     [](Subject &s) { s.material.density = not_a_number; },
     {energy, wave_energy, wave_speeds, damped_waves}},
    {"lattice gradient where it is strained",
     without_values(lattice, Kind::strained),
     {wave_energy_in_both, wave_speeds_in_both, damped_waves, intrinsic_length, hole}},
    {"lattice gradient throws",
     without_values(lattice, Kind::throws),
     {wave_energy, wave_speeds, damped_waves, intrinsic_length, hole},
     throws},
    {"lattice gradient",
     without_values(lattice, Kind::all),
     {wave_energy, wave_speeds, damped_waves, intrinsic_length}},
    {"intrinsic length",
     [](Subject &s) { s.lengths.lattice = not_a_number; },
     {wave_energy, wave_speeds, damped_waves, intrinsic_length}},
    {"isotropic gradient throws",
     without_values(isotropic, Kind::throws),
     {wave_speeds, intrinsic_length, hole},
     throws},
    {"isotropic gradient", without_values(isotropic, Kind::all), {intrinsic_length}},
    {"isotropic gradient where it is strained", without_values(isotropic, Kind::strained), {hole}},
    {"isotropic length", [](Subject &s) { s.lengths.isotropic_inertia = not_a_number; }, {intrinsic_length}},
    {"viscosity of all bonds",
     [](Subject &s) { s.material.nearest.viscosity = s.material.next_nearest->viscosity = not_a_number; },
     {damped_waves}},
    {"theory, shear modulus",
     [](Subject &s) { s.theory.shear_modulus = not_a_number; },
     {energy, intrinsic_length, prestretch, hole}},
    // It is a theory of the sheet at rest.
    {"theory, shear speed", [](Subject &s) { s.theory.shear_speed = not_a_number; }, {energy, wave_speeds_in_both}},
    {"theory, longitudinal speed", [](Subject &s) { s.theory.longitudinal_speed = not_a_number; }, {energy}},
    {"network",
     [](Subject &s) { s.network = continuum::IsotropicNetwork(overflowing(s)); },
     {energy, wave_speeds, intrinsic_length, prestretch, hole, notch},
     "network"},
    {"network gradient where it is strained", without_values(network, Kind::strained), {hole, notch}, "network"},
    {"network gradient", without_values(network, Kind::all), {wave_speeds, intrinsic_length}, "network"},
    {"network gradient throws", without_values(network, Kind::throws), {wave_speeds, intrinsic_length}, throws},
    // The plane-stress law is judged by the claim on energy alone.
    {"Mooney-Rivlin throws",
     [](Subject &s) { s.mooney_rivlin->law.c1 = not_a_number; },
     {energy},
     "not computed: Mooney-Rivlin constants must be finite"},
    {"Mooney-Rivlin", [](Subject &s) { s.mooney_rivlin->law.c1 = 1e308; }, {energy}},
    {"ellipticity of Mooney-Rivlin",
     [](Subject &s) { s.mooney_rivlin->smallest_acoustic_eigenvalue = not_a_number; },
     {energy},
     "slowest"}};
  std::vector<Plant> plants;
  for (const Side &side : sides)
    for (const ClaimPart &claim : side.claims)
      plants.push_back({claim, side});
  return plants;
}

// The plants in sheets with a hole or a notch, which take seconds each, or the others.
std::vector<Plant> plants(bool in_cut_sheets)
{
  std::vector<Plant> found;
  for (const Plant &plant : every_claim_and_side())
    if ((plant.claim.name == hole.name || plant.claim.name == notch.name) == in_cut_sheets)
      found.push_back(plant);
  return found;
}

std::string name_of(const testing::TestParamInfo<Plant> &test)
{
  std::string name = test.param.claim.name + "_" + test.param.side.name;
  std::replace_if(
    name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

using NoNumber = testing::TestWithParam<Plant>;
using NoNumberInCutSheets = testing::TestWithParam<Plant>;
INSTANTIATE_TEST_SUITE_P(Claims, NoNumber, testing::ValuesIn(plants(false)), name_of);
INSTANTIATE_TEST_SUITE_P(Claims, NoNumberInCutSheets, testing::ValuesIn(plants(true)), name_of);

// Its laws are fitted once. Plants replace laws in copies of it.
const Subject &right_subject()
{
  static const Subject right = subject(subjects::weakly_damped_case());
  return right;
}

void expect_that_the_claim_fails(const Plant &plant)
{
  Subject wrong = right_subject();
  plant.side.plant(wrong);
  const Results results = plant.claim.check(wrong);
  EXPECT_EQ(results.verdict(), Verdict::fails);
  std::string failing;
  std::size_t without_number = 0;
  for (const Result &row : results.rows())
    if (row.verdict() == Verdict::fails)
    {
      failing += row.quantity + "\n";
      without_number += !row.error || !std::isfinite(*row.error);
    }
  EXPECT_NE(failing.find(plant.side.reason), std::string::npos) << failing;
  EXPECT_TRUE(!plant.side.reason.empty() || without_number > 0) << failing;
}

TEST_P(NoNumber, FailsTheClaim)
{
  expect_that_the_claim_fails(GetParam());
}

TEST_P(NoNumberInCutSheets, FailsTheClaim)
{
  expect_that_the_claim_fails(GetParam());
}

// Each side of the steady crack: the run of the simulator, and the exact solution.
TEST(NoNumberInSteadyCracks, FailsTheirCheck)
{
  const std::pair<SteadyCrackSeries, const char *> wrong[] = {
    {{3., {1.1}, 0.}, "the crack stopped"},                                // the run throws
    {{3., {not_a_number}, 0.}, "not computed"},                            // and is no number
    {{0.5, {}, 8.}, "crack beyond the limit, beta 0.5"},                   // the exact solution throws
    {{not_a_number, {1.57}, 0.}, "crack, beta nan, Delta/Delta_G 1.57: "}, // and is no number
  };
  for (const auto &[series, reason] : wrong)
  {
    const Results results = steady_cracks(series).results;
    EXPECT_EQ(results.verdict(), Verdict::fails) << reason;
    EXPECT_GE(faults::failing(results, reason), 1u) << reason;
  }
}

} // namespace no_number_test
