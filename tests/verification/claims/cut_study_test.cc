// Sheets with a hole or a notch: where their edges are, and that the comparison holds, and fails for what is wrong.
#include "verification/claims/prestretch/prestretch_claim.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"

namespace cut_study_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

constexpr lattice::Orientation orientations[] = {lattice::Orientation::rows_along_crack,
                                                 lattice::Orientation::rows_across_crack};

Subject paper_subject(lattice::Orientation orientation = lattice::Orientation::rows_along_crack)
{
  Case input = subjects::paper_case();
  input.orientation = orientation;
  return subject(input);
}

// The local law alone, of the small version.
CutStudy local_study()
{
  CutStudy study = hole_study(true);
  study.other_sizes.clear();
  return study;
}

void expect_holds(const Subject &subject, const CutStudy &study)
{
  const Results results = cut_claim(subject, study).results;
  EXPECT_TRUE(results.all_hold()) << results.verdict_text(8);
}

// With nearest neighbours the outermost row of sites, held, is the edge; with both shells the second row is held too,
// and the displacement it forces on the first free one has a boundary layer: 0.72 of a row pitch across and all of it
// along the edge, by hand from the characteristic equation of the chain.
// theory-comparison.md, eq. (H.11).
TEST(EquivalentSheet, HeldLayerIsAnEdgeAtTheDepthOfItsChain)
{
  const Case input = subjects::paper_case();
  const lattice::TriangularLattice lattice = input.lattice();
  const double p = std::sqrt(0.75) * input.spacing;
  EXPECT_NEAR(held_depth(lattice, subjects::nearest_only(input), {0., 1.}), 0., 1e-12 * p);
  const double k1 = 1.5 + 0.5 / std::sqrt(3.), k2 = 1. / std::sqrt(3.);
  const double c = -2. - k1 / k2, r = 0.5 * (c + std::sqrt(c * c - 4.));
  EXPECT_NEAR(held_depth(lattice, input.material(), {0., 1.}), 0.5 * p * ((1. + r / (1. - r)) + 1.), 1e-9 * p);
}

// theory-comparison.md, eq. (H.10).
TEST(EquivalentSheet, RimRecedesByAFixedPartOfABond)
{
  const Case input = subjects::paper_case();
  const lattice::TriangularLattice lattice = input.lattice();
  const double part = 23. / (45. * M_PI);
  EXPECT_NEAR(rim_recession(lattice, subjects::nearest_only(input)), part * input.spacing, 1e-12 * input.spacing);
  // Lengths 1 and sqrt3, weighted with volumes of bonds that are as long.
  EXPECT_NEAR(rim_recession(lattice, input.material()), part * 4. / (1. + std::sqrt(3.)) * input.spacing,
              1e-12 * input.spacing);
}

// Of the same mean at finite stretch the small-strain one is the limit; bonds across the edge gain weight with stretch.
TEST(EquivalentSheet, RimRecedesMoreWhereItIsStretched)
{
  const Case input = subjects::paper_case();
  const lattice::TriangularLattice lattice = input.lattice();
  for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
  {
    const double at_rest = rim_recession(lattice, material);
    EXPECT_NEAR(stretched_rim_recession(lattice, material, 1. + 1e-4), at_rest, 1e-4 * at_rest);
    EXPECT_NEAR(stretched_rim_recession(lattice, material, 2.5), 1.196 * at_rest, 0.002 * at_rest);
  }
}

// theory-comparison.md, eq. (H.12).
TEST(CutStudy, HoldsWithAHoleInBothOrientationsAndForBothShellSets)
{
  for (const lattice::Orientation orientation : orientations)
    expect_holds(paper_subject(orientation), local_study());
  const Case input = subjects::paper_case();
  expect_holds(subject(input, subjects::nearest_only(input)), local_study());
}

// The sheet without a cut between held edges: the force on the top edge is that of all columns, those next to a free
// edge included.
TEST(CutStudy, ForcesOnAnEdgeIncludeThoseNextToAFreeEdge)
{
  const Subject right = paper_subject();
  CutStudy study = notch_study(true);
  std::vector<double> errors;
  for (const double size : {4., 8., 16.})
  {
    const CutSheet sheet = study.sheet(right, size * right.spacing, study.states[0]);
    const CutLattice cut = relaxed_lattice(right, sheet);
    const EquivalentSheet domain = equivalent_sheet(cut.lattice, right.material, cut.state, sheet.held, sheet.cutout);
    std::string failure;
    const auto found = compare(cut, domain, {right.cauchy_born}, study.mesh, failure);
    ASSERT_TRUE(found) << failure;
    errors.push_back(found->errors.reaction_vector);
  }
  // A column that is left out has a share of the force that falls more slowly than what the edges leave.
  EXPECT_LT(errors[1], 0.75 * errors[0]);
  EXPECT_LT(errors[2], 0.75 * errors[1]);
}

// theory-comparison.md, eq. (H.17): half the way to the law of the turned lattice.
TEST(CutStudy, NetworkLiesMidwayBetweenTheLatticeAndTheTurnedOne)
{
  CutStudy study = hole_study(true);
  study.sizes = {6., 8., 10., 12.};
  study.other_sizes.clear();
  const Subject rubber = paper_subject();
  const std::vector<CutResult> results = compare_sizes(rubber, study, study.states.front());
  const auto at_largest = [&](const std::string &law) -> const CutResult &
  {
    return *std::find_if(results.begin(), results.end(),
                         [&](const CutResult &result) { return result.law == law && result.size == 12.; });
  };
  const CutResult &network = at_largest("network"), &turned = at_largest("local-turned");
  ASSERT_TRUE(network.from_local && turned.from_local);
  const double first_order = 0.5 * turned.from_local->displacement;
  EXPECT_NEAR(network.from_local->displacement, first_order, 0.2 * first_order);
  ASSERT_TRUE(network.from_middle);
  EXPECT_LT(network.from_middle->displacement, 0.2 * first_order);
}

// Positions and directions of the lattice with x and y exchanged, as a comparison would see them that mixes them up.
void exchange_axes(CutLattice &cut)
{
  for (std::size_t place = 0; place < cut.lattice.n_places(); ++place)
  {
    const Eigen::Vector2d X = cut.lattice.reference(place);
    const double ux = cut.state.position.x[place] - X.x(), uy = cut.state.position.y[place] - X.y();
    cut.state.position.x[place] = X.x() + uy;
    cut.state.position.y[place] = X.y() + ux;
    cut.fields[place].first_piola_stress = cut.fields[place].first_piola_stress.reverse().eval();
  }
  std::swap(cut.reaction_change.x(), cut.reaction_change.y());
  cut.homogeneous_P = cut.homogeneous_P.reverse().eval();
}

TEST(CutFault, FailsForAxesThatAreExchanged)
{
  CutStudy study = local_study();
  study.sizes = {6., 8., 10., 12.};
  study.spoil = exchange_axes;
  const Results results = cut_claim(paper_subject(), study).results;
  for (const char *row : {"displacement, rms", "reactions", "shape"})
    EXPECT_GE(faults::failing(results, row), 1u) << row;
}

} // namespace cut_study_test
