// Faults planted on one side of a claim: the rows that must fail, and those that compare a side with its own theory and
// must hold. A claim that cannot fail claims nothing. Without a fault none fails: claims_test.cc.
#include <gtest/gtest.h>

#include <vector>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"

namespace fault_matrix_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace output;

constexpr double wrong = 1.01;

using Change = std::function<lattice::Material(lattice::Material)>;
using Plant = std::function<void(Subject &)>;

// Short versions of a claim, or of a part of it.
Results check(const std::string &claim, const Subject &subject, const Change &of_runs)
{
  for (const parts::ClaimPart &part : {parts::energy, parts::intrinsic_length, parts::prestretch})
    if (claim == part.name)
      return part.check(subject);
  if (claim == "energy of waves")
    return parts::energy_of_waves(subject, {Eigen::Matrix2d::Identity()}).results;
  if (claim == "wave-speeds" || claim == "damped waves")
  {
    WaveSpeedsOptions options =
      claim == "wave-speeds" ? parts::waves({Eigen::Matrix2d::Identity()}) : parts::waves({}, {subject.deformation});
    options.kd = {0.2, 0.4}; // where faults of one percent are larger than what long waves leave
    if (of_runs)
      options.planted = of_runs;
    return wave_speeds_claim(subject, options).results;
  }
  CutStudy study = hole_study(true);
  study.sizes = {6., 8., 12., 16.};
  study.other_sizes.clear();
  return cut_claim(subject, study).results;
}

// Rows whose names contain a text; how many of them fail, by default at least one.
struct Failing
{
  Failing(const char *part, std::size_t number = 0) : text(part), n(number) {}
  std::string text;
  std::size_t n;
};

struct Rows
{
  std::string claim;
  std::vector<Failing> fail;
  std::vector<std::string> hold = {};
  bool no_others = false; // the first of `fail` names all rows that fail, and no row that does not
};

struct PlantedFault
{
  const char *name;
  Plant plant;
  std::vector<Rows> rows;
  Change of_runs = {}; // material of the lattice's runs alone
  bool has_third_shell = false;
};

std::ostream &operator<<(std::ostream &out, const PlantedFault &fault)
{
  return out << fault.name;
}

lattice::MooneyRivlinBond &bond(lattice::Shell &shell)
{
  return std::get<lattice::MooneyRivlinBond>(shell.law);
}

// The laws of the continuum with other bonds than the lattice has; those of the third shell are the last from 6 on.
Plant continuum_bonds(const std::function<void(std::vector<continuum::BondFamily> &)> &change)
{
  return [change](Subject &s)
  {
    const lattice::TriangularLattice sheet(s.spacing, 10. * s.spacing, 10. * s.spacing, s.orientation);
    std::vector<continuum::BondFamily> bonds = bond_families(sheet, s.material);
    change(bonds);
    std::vector<continuum::FibreFamily> fibres;
    for (const continuum::BondFamily &bond : bonds)
      fibres.push_back(bond.fibre);
    s.cauchy_born = continuum::CauchyBorn(fibres);
    s.lattice_gradient = std::make_shared<continuum::LatticeGradient>(bonds, s.lengths.lattice);
  };
}

std::vector<PlantedFault> all_faults()
{
  using Constants = continuum::MooneyRivlin::Constants;
  const auto mooney_rivlin = [](double Constants::*constant) -> Plant
  { return [constant](Subject &s) { s.mooney_rivlin->law.*constant *= wrong; }; };
  // Of a side with its own theory.
  const std::vector<std::string> own_waves{"lattice run against Bloch", "finite elements against their continuum"},
    own_energy{"energy of the lattice against Bloch"}, own_alpha{"lattice run against closed form"};
  const Rows energy{"energy",
                    {"energy density, Cauchy-Born", "first Piola stress, Cauchy-Born", "mu at F = I, Cauchy-Born",
                     "lambda at F = I, Cauchy-Born", "c_S at F = I, Cauchy-Born", "c_L at F = I, Cauchy-Born"}},
    long_waves{"wave-speeds", {"long-wave speed, S, lattice run against closed"}, own_waves},
    // Energy density, two tractions, stress; displacements are those of the edges all the same. The network's stress is
    // judged by its tractions alone.
    prestretch{"prestretch", {{", Cauchy-Born", 4}, {", network", 3}, "traction on the top edge, Cauchy-Born"}},
    gradient_alpha{"intrinsic-length", {"alpha in all directions, gradient continuum against closed form"}, own_alpha};
  // Constants of a bond enter all claims by its stiffness alone: one of them is planted in all.
  const std::vector<Rows> of_moduli{energy},
    of_third_shell{{"energy", {", Cauchy-Born"}}, {"prestretch", {", Cauchy-Born"}}},
    of_gradient{
      {"wave-speeds", {""}, own_waves}, {"energy of waves", {""}, own_energy}, {"intrinsic-length", {""}, own_alpha}},
    of_mooney_rivlin{{"energy", {"Mooney-Rivlin"}}};
  const auto third = [](const char *name, const Plant &plant, const std::vector<Rows> &rows) {
    return PlantedFault{name, plant, rows, {}, true};
  };
  return {
    {"lattice: a, nearest", [](Subject &s) { bond(s.material.nearest).a *= wrong; }, {energy, long_waves, prestretch}},
    {"lattice: b, nearest", [](Subject &s) { bond(s.material.nearest).b *= wrong; }, of_moduli},
    {"lattice: s, nearest", [](Subject &s) { s.material.nearest.area_factor *= wrong; }, of_moduli},
    {"lattice: a, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).a *= wrong; }, of_moduli},
    {"lattice: b, next-nearest", [](Subject &s) { bond(s.material.next_nearest.value()).b *= wrong; }, of_moduli},
    {"lattice: s, next-nearest",
     [](Subject &s) { s.material.next_nearest->area_factor *= wrong; },
     {{"energy of waves", {""}, own_energy}, gradient_alpha, {"hole", {"stress amplitude", "reactions"}}}},
    {"lattice: density",
     [](Subject &s) { s.material.density *= wrong; },
     {{"energy", {"c_S at F = I, Cauchy-Born", "c_L at F = I, Cauchy-Born"}}}},
    {"lattice's runs: density",
     [](Subject &) {},
     {{"wave-speeds", {"long-wave speed, S, lattice run against a, b, s and rho alone"}}},
     [](lattice::Material material)
     {
       material.density *= wrong;
       return material;
     }},
    {"lattice's runs: dashpots",
     [](Subject &) {},
     {{"damped waves", {"decay, lattice and finite elements each against its theory"}}},
     [](lattice::Material material)
     {
       material.nearest.viscosity *= wrong;
       material.next_nearest->viscosity *= wrong;
       return material;
     }},
    {"continuum: weights, Cauchy-Born",
     [](Subject &s) { s.cauchy_born = faults::scaled<continuum::CauchyBorn>(s.cauchy_born, wrong); },
     {{"energy", {"mu at F = I, lattice and Cauchy-Born against a, b and s alone"}},
      {"wave-speeds", {"gradient continuum against Bloch"}},
      gradient_alpha,
      {"prestretch", {"traction on the top edge, Cauchy-Born"}},
      {"hole", {"energy"}}}},
    {"continuum: d^2 in place of the Voronoi cell of a site",
     [](Subject &s) { s.cauchy_born = faults::scaled<continuum::CauchyBorn>(s.cauchy_born, std::sqrt(0.75)); },
     {{"energy", {"energy density, Cauchy-Born", "first Piola stress, Cauchy-Born"}}}},
    {"continuum: weights, network",
     [](Subject &s) { s.network = faults::scaled<continuum::IsotropicNetwork>(s.cauchy_born, wrong); },
     {{"energy", {"network"}, {}, true},
      {"wave-speeds", {"network with gradient energy against the lattice's mean over rotations"}, own_waves},
      {"intrinsic-length", {"network in all directions against the lattice's mean over directions"}},
      {"prestretch",
       {{", network", 3}, {"", 3}, "traction on the top edge, network against the lattice's mean over rotations"}},
      {"hole", {"network: stress amplitude", "network: energy"}}}},
    {"continuum: weights, network, too small",
     [](Subject &s) { s.network = faults::scaled<continuum::IsotropicNetwork>(s.cauchy_born, 0.99); },
     {{"energy", {"network"}, {}, true}}},
    {"continuum: gradient energy",
     [](Subject &s)
     { s.lattice_gradient = std::make_shared<faults::Combination>(wrong, s.lattice_gradient, 0., s.lattice_gradient); },
     {gradient_alpha}},
    {"continuum: sign of k^4", faults::turn_sign_of_fourth_order, of_gradient},
    {"continuum: sign of the network's gradient energy",
     [](Subject &s)
     { s.network_gradient = std::make_shared<faults::Combination>(-1., s.network_gradient, 0., s.network_gradient); },
     {of_gradient[0], of_gradient[2]}},
    {"continuum: l_d",
     [](Subject &s) { s.lengths.lattice *= wrong; },
     {{"energy of waves", {"excess of the gradient continuum's energy over l_d^2 k^2"}},
      {"wave-speeds", {"gradient continuum against Bloch"}},
      {"intrinsic-length", {"intrinsic length l_d"}}}},
    {"continuum: l_d of nearest neighbours alone", [](Subject &s) { s.lengths.lattice = s.spacing / std::sqrt(12.); },
     of_gradient},
    {"continuum: isotropic length",
     [](Subject &s) { s.lengths.isotropic_inertia *= wrong; },
     {{"intrinsic-length", {"isotropic"}, own_alpha}}},
    {"Mooney-Rivlin: c1", mooney_rivlin(&Constants::c1), of_mooney_rivlin},
    {"Mooney-Rivlin: c2", mooney_rivlin(&Constants::c2), of_mooney_rivlin},
    {"Mooney-Rivlin: kappa", mooney_rivlin(&Constants::kappa), of_mooney_rivlin},
    {"Mooney-Rivlin: not elliptic",
     [](Subject &s) { s.mooney_rivlin->smallest_acoustic_eigenvalue *= -1e-3; },
     {{"energy", {"slowest"}, {}, true}}},
    third(
      "lattice: s, third-nearest", [](Subject &s) { s.material.third_nearest->area_factor *= wrong; }, of_third_shell),
    third(
      "lattice: no third-nearest bonds", [](Subject &s) { s.material.third_nearest.reset(); }, of_third_shell),
    third("continuum: a direction of third-nearest bonds missing",
          continuum_bonds([](auto &bonds) { bonds.pop_back(); }), of_third_shell),
    third("continuum: sqrt3 d in place of 2 d in the weights of third-nearest bonds",
          continuum_bonds(
            [](auto &bonds)
            {
              for (std::size_t i = 6; i < bonds.size(); ++i)
                bonds[i].fibre.weight *= std::sqrt(3.) / 2.;
            }),
          of_third_shell),
    third("continuum: sqrt3 d in place of 2 d in the gradient energy of third-nearest bonds",
          continuum_bonds(
            [](auto &bonds)
            {
              for (std::size_t i = 6; i < bonds.size(); ++i)
                bonds[i].length *= std::sqrt(3.) / 2.;
            }),
          {{"intrinsic-length", {"gradient continuum against closed form"}}}),
  };
}

using FaultMatrix = testing::TestWithParam<PlantedFault>;
INSTANTIATE_TEST_SUITE_P(Claims, FaultMatrix, testing::ValuesIn(all_faults()));

// The rubber of the paper; laws are fitted once.
const Subject &right_subject(bool has_third_shell)
{
  static const Subject two = subject(subjects::weakly_damped_case()),
                       three = subject(subjects::with_third_shell(subjects::weakly_damped_case()));
  return has_third_shell ? three : two;
}

TEST_P(FaultMatrix, FailsTheRowsThatSeeIt)
{
  Subject subject = right_subject(GetParam().has_third_shell);
  GetParam().plant(subject);
  for (const Rows &rows : GetParam().rows)
  {
    SCOPED_TRACE(rows.claim);
    const Results results = check(rows.claim, subject, GetParam().of_runs);
    EXPECT_EQ(results.verdict(), Verdict::fails);
    for (const Failing &failing : rows.fail)
    {
      const std::size_t found = faults::failing(results, failing.text);
      EXPECT_TRUE(failing.n == 0 ? found > 0 : found == failing.n) << found << " fail: " << failing.text;
    }
    for (const std::string &text : rows.hold)
      EXPECT_EQ(faults::failing(results, text), 0u) << text;
    if (rows.no_others)
      for (const Result &row : results.rows())
        if (row.verdict() != Verdict::reported)
        {
          EXPECT_EQ(row.verdict() == Verdict::fails, row.quantity.find(rows.fail[0].text) != std::string::npos)
            << row.quantity;
        }
  }
}

// What a crack may use besides: contact and absorbing ends, either integrator, and damped waves
// (theory-continuum.md, eqs. (C.41) and (C.62)).
TEST(Surroundings, AreThoseOfTheirClosedForms)
{
  for (const auto integrator :
       {input::Case::Integrator::velocity_verlet, input::Case::Integrator::runge_kutta_chebyshev})
  {
    input::Case input = subjects::weakly_damped_case();
    input.integrator = integrator;
    const Subject subject = bridge::subject(input);
    const Results right = contact_rows(subject, input);
    EXPECT_TRUE(right.all_hold()) << right.verdict_text(3);
    const Results stiffer = contact_rows(subject, input, [](lattice::ContactLaw &law) { law.stiffness *= wrong; }),
                  damped = contact_rows(subject, input, [](lattice::ContactLaw &law) { law.viscosity *= wrong; });
    EXPECT_EQ(faults::failing(stiffer, "restitution"), 1u) << stiffer.rows()[0].error.value_or(-1.);
    EXPECT_EQ(faults::failing(damped, "restitution"), 1u) << damped.rows()[0].error.value_or(-1.);
    if (integrator == input::Case::Integrator::velocity_verlet)
      continue; // its damped waves: verify_test.py
    WaveSpeedsOptions options = parts::waves({}, {subject.deformation});
    options.integrator = integrator;
    const ClaimOutcome waves = wave_speeds_claim(subject, options);
    EXPECT_TRUE(waves.results.all_hold()) << waves.results.verdict_text(6);
    // Theories of ten longer waves and the wave that runs, of both polarisations.
    EXPECT_EQ(waves.tables.at("attenuation").rows().size(), 11u * 2u);
  }
}

} // namespace fault_matrix_test
