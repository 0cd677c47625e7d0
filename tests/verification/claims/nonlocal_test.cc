// The claim on the nonlocal continuum, and what makes it fail (theory-comparison.md, eqs. (H.25) to (H.28)).
#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"
#include "verification/bridge/nonlocal_continuum.h"

namespace nonlocal_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace output;

TEST(Nonlocal, HoldsWithThirdNearestNeighboursAndArcs)
{
  input::Case input = subjects::paper_case();
  lattice::Material material = input.material();
  material.third_nearest = material.next_nearest;
  const Subject third = subject(input, material);
  NonlocalOptions options = parts::nonlocal_options(third);
  const lattice::Grid fine{lattice::Grid::Kind::square, input.spacing / 4.},
    own{lattice::Grid::Kind::triangular, input.spacing};
  options.stencils = {options.stencils[2], {"arcs", fine, M_PI / 9.}, {"lattice", own, 0.}};
  const Results results = nonlocal_claim(third, options);
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(5);
}

struct Fault
{
  const char *name;
  std::function<void(NonlocalOptions &)> plant;
  std::vector<const char *> rows = {""};               // that must fail
  bool needs_all_stencils = false;                     // one of the rows fails in few of them
  std::function<void(Subject &)> of_subject = nullptr; // on the other sides, or a value that is no number
};

std::ostream &operator<<(std::ostream &out, const Fault &fault)
{
  return out << fault.name;
}

const char *const moduli = "all elastic moduli";
const char *const sampled = "over the bound of harmonics, 5 random F";

const Fault planted[] = {
  {"weights of a ring 1 % off",
   [](NonlocalOptions &o)
   {
     o.planted_bonds = [](std::vector<lattice::HalfBond> &bonds)
     {
       for (lattice::HalfBond &bond : bonds)
         bond.weight *= bond.shell == 1 ? 1.01 : 1.;
     };
   },
   {moduli, "(2, 2)", sampled, "energy density of the loaded sheet", "energy of a straight cut", "order in 1/m"},
   true},
  {"radius of a ring 1 % off",
   [](NonlocalOptions &o) { o.planted_rings = [](std::vector<lattice::Ring> &rings) { rings[1].radius *= 1.01; }; },
   {moduli, "intrinsic length l", "energy of a straight cut"}},
  {"radius of a ring 1 % off, with the right weight",
   [](NonlocalOptions &o)
   {
     o.planted_rings = [](std::vector<lattice::Ring> &rings) { rings[1].radius *= 1.01; };
     o.planted_bonds = [](std::vector<lattice::HalfBond> &bonds)
     {
       for (lattice::HalfBond &bond : bonds)
         bond.weight /= bond.shell == 1 ? 1.01 : 1.;
     };
   },
   {"squared intrinsic length against that of the rings"}},
  {"fourth moments not isotropic by 1 %",
   [](NonlocalOptions &o)
   {
     o.planted_bonds = [](std::vector<lattice::HalfBond> &bonds)
     {
       for (lattice::HalfBond &bond : bonds)
         bond.weight *= 1. + 0.01 * std::cos(4. * std::atan2(bond.vector.y(), bond.vector.x()));
     };
   },
   {moduli}},
  {"a direction missing",
   [](NonlocalOptions &o)
   { o.planted_bonds = [](std::vector<lattice::HalfBond> &bonds) { bonds.erase(bonds.begin() + 3); }; },
   {moduli, "(2, 2)", sampled, "energy of a straight cut"}},
  {"tip ahead by the radius of a ring", [](NonlocalOptions &o) { o.planted_tip = 0.625e-3; }, {"tip of that cut"}},
  {"tip behind by the radius of a ring", [](NonlocalOptions &o) { o.planted_tip = -0.625e-3; }, {"tip of that cut"}},
  {"modulus of a branch 1 % off",
   [](NonlocalOptions &o)
   {
     o.planted_branches = [](lattice::Material material)
     {
       auto branches = std::get<lattice::MaxwellMemory>(material.nearest.memory).branches();
       branches.front().modulus *= 1.01;
       material.nearest.memory = lattice::MaxwellMemory(branches);
       return material;
     };
   },
   {"while Maxwell branches relax"}},
  {"weights of scattered bonds 1 % off",
   [](NonlocalOptions &o)
   {
     o.planted_factors = [](lattice::BondFactors &factors, const lattice::TriangularLattice &sheet)
     {
       for (std::size_t kind = 0; kind < factors.kinds.size(); ++kind)
         for (double &factor : factors.kinds[kind])
           factor *= sheet.shell(kind) == 1 ? 1.01 : 1.;
     };
   },
   {moduli, "(2, 2)", sampled, "points of a square grid, m = 1.5, energy density of the loaded sheet",
    "matrix of waves"},
   true},
  {"scattered bonds whose weights fall linearly",
   [](NonlocalOptions &o)
   {
     o.planted_factors = [](lattice::BondFactors &factors, const lattice::TriangularLattice &sheet)
     {
       for (std::size_t kind = 0; kind < factors.kinds.size(); ++kind)
         for (std::size_t place = 0; place < factors.kinds[kind].size(); ++place)
           if (factors.kinds[kind][place] > 0.)
             factors.kinds[kind][place] =
               1. - std::abs(sheet.rest_length(kind) / sheet.length_ratio(place, kind) - sheet.ring_radius(kind)) /
                      sheet.spacing();
     };
   },
   {moduli, "force on a point"}},
  {"network",
   {},
   {""},
   false,
   [](Subject &s) { s.network = faults::scaled<continuum::IsotropicNetwork>(s.cauchy_born, 1.01); }},
  {"lattice", {}, {""}, false, [](Subject &s) { s.material.next_nearest->area_factor *= 1.01; }},
  {"length", {}, {""}, false, [](Subject &s) { s.lengths.isotropic_inertia *= 1.01; }},
  {"shear speed", {}, {""}, false, [](Subject &s) { s.theory.shear_speed = std::nan(""); }},
  {"density", {}, {""}, false, [](Subject &s) { s.material.density = std::nan(""); }},
  {"area", {}, {""}, false, [](Subject &s) { s.material.nearest.area_factor = std::nan(""); }},
};

using NonlocalFault = testing::TestWithParam<Fault>;
INSTANTIATE_TEST_SUITE_P(FaultMatrix, NonlocalFault, testing::ValuesIn(planted));

// Energies (H.25), bounds of harmonics (H.26), lengths (H.27) and cuts (H.28).
TEST_P(NonlocalFault, EachIsCaughtByARow)
{
  static const Subject right = bridge::subject(subjects::paper_case()); // laws are fitted once
  Subject subject = right;
  if (GetParam().of_subject)
    GetParam().of_subject(subject);
  NonlocalOptions options = parts::nonlocal_options(subject);
  const std::vector<NonlocalStencil> all = options.stencils;
  if (!GetParam().needs_all_stencils) // one of each kind of points
    options.stencils = {all[0], all[5], all[6]};
  if (GetParam().plant)
    GetParam().plant(options);
  const Results results = nonlocal_claim(subject, options);
  for (const char *row : GetParam().rows)
    EXPECT_GE(faults::failing(results, row), 1u) << row;
}

TEST(Nonlocal, HasTheCutEnergiesOfFig1)
{
  input::Case input = subjects::paper_case();
  input.next_nearest.area_factor = 4. / 3.;
  const lattice::Material material = input.material();
  const double d = input.spacing;
  const lattice::Grid grid{lattice::Grid::Kind::triangular, d};
  const double on_lattice = NonlocalContinuum(lattice::triangular_stencil(grid), material, d).cut_energy(3.05),
               rings = ring_cut_energy(material, d, grid, 3.05).limit;
  // Two nearest and four next-nearest bonds per spacing; the mean of |sin| over directions is 2 / pi.
  const double psi = lattice::energy(material.nearest.law, 3.05);
  EXPECT_NEAR(on_lattice, (2. * 2. / 3. + 4. * std::sqrt(3.) * 4. / 3.) * std::sqrt(3.) / 2. * d * psi, 1e-10 * rings);
  EXPECT_NEAR(rings, 2. / M_PI * (3. * 2. / 3. + 9. * 4. / 3.) * d * psi, 1e-10 * rings);
  EXPECT_NEAR(on_lattice / rings, 1.0272, 1e-4);
}

} // namespace nonlocal_test
