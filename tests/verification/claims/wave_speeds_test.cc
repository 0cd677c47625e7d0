// Waves on the lattice, in the finite elements and in closed form; and what makes the claim about them fail.
#include <gtest/gtest.h>

#include "lattice/forces.h"
#include "tests/verification/claims/faults.h"
#include "tests/verification/claims/parts.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/lattice_waves.h"

namespace wave_speeds_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;

lattice::TriangularLattice sheet_of(const Case &input)
{
  return input.lattice();
}

// Sums over bonds, worked out apart from the code: theory.md, eqs. (L.1) and (L.4); theory-comparison.md, eq. (W.2).
TEST(Bloch, HasTheKnownSpeedsOfTheStretchedSheet)
{
  const Case input = subjects::paper_case();
  const Eigen::Matrix2d F = input.deformation();
  const auto speeds = [&](const Eigen::Vector2d &N)
  {
    const double k = 1e-4 / input.spacing;
    const auto waves = bloch_waves(sheet_of(input), input.material(), F, k * N);
    return std::array<double, 2>{std::min(waves[0].frequency, waves[1].frequency) / k,
                                 std::max(waves[0].frequency, waves[1].frequency) / k};
  };
  const auto along = speeds({1., 0.}), across = speeds({0., 1.});
  EXPECT_NEAR(along[0], 19.76693, 5e-6);
  EXPECT_NEAR(along[1], 20.31142, 5e-6);
  EXPECT_NEAR(across[0], 19.00774, 5e-6);
  EXPECT_NEAR(across[1], 20.31148, 5e-6);
}

// theory-comparison.md, eqs. (W.1) to (W.3).
TEST(Bloch, HasTheKnownErrorsOfBothContinua)
{
  const Case input = subjects::paper_case();
  const Subject s = subject(input);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const Eigen::Vector2d K(0.5 / input.spacing, 0.);
  const double exact = bloch_waves(sheet_of(input), input.material(), I, K)[0].frequency;
  const WaveContinuum local{{s.cauchy_born}, {input.density}};
  const WaveContinuum gradient{{s.cauchy_born, *s.lattice_gradient}, {input.density, s.lengths.lattice}};
  const auto error = [&](const WaveContinuum &medium)
  { return plane_waves(continuum_matrices(medium, I, K), wave_normal(I, K))[0].frequency / exact - 1.; };
  EXPECT_NEAR(error(local), 1.86e-2, 5e-5);
  EXPECT_NEAR(error(gradient), 8.0e-4, 5e-6);
}

// The dynamical matrix is minus the force that the simulator finds on a site of a wave, over its mass and amplitude.
TEST(Bloch, IsTheResponseOfTheForceLoop)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
  {
    const Case input = subjects::paper_case();
    const WaveCell cell = wave_cell(input.spacing, orientation, {2, 1}, 1.2);
    Eigen::Matrix2d F;
    F << 1.6, 0.2, -0.1, 1.3;
    const lattice::Material material = input.material();
    const WaveMatrices matrices = bloch_matrices(cell.sheet, material, F, cell.K);
    const double mass = lattice::site_mass(material, cell.sheet), amplitude = 1e-6 * input.spacing;
    lattice::Forces forces(cell.sheet, material);
    const std::size_t place = cell.sheet.index(0, 0);
    const double phase = cell.K.dot(cell.sheet.reference(place));
    for (int component = 0; component < 2; ++component)
    {
      lattice::State state = lattice::homogeneous_state(cell.sheet, material, F, lattice::Edges::free);
      for (std::size_t row = 0; row < cell.sheet.rows(); ++row)
        for (std::size_t column = 0; column < cell.sheet.sites_in_row(row); ++column)
        {
          const std::size_t at = cell.sheet.index(row, column);
          const double shape = std::cos(cell.K.dot(cell.sheet.reference(at)) - phase);
          (component == 0 ? state.x : state.y)[at] += amplitude * shape;
          (component == 0 ? state.vx : state.vy)[at] = shape;
        }
      lattice::update_images(state, cell.sheet);
      const lattice::Field still(state.x.size(), 0.);
      const auto force = [&](const lattice::Field &vx, const lattice::Field &vy)
      {
        forces.evaluate(state, vx, vy);
        return Eigen::Vector2d(forces.fx()[place], forces.fy()[place]);
      };
      const Eigen::Vector2d elastic = force(still, still);
      const Eigen::Vector2d viscous = force(state.vx, state.vy) - elastic;
      // The force is linear to the relative amplitude, and rounded to some 1e-16 of bond forces, 1e6 times itself.
      EXPECT_LT((elastic / (-mass * amplitude) - matrices.stiffness.col(component)).norm(),
                1e-5 * matrices.stiffness.norm());
      EXPECT_LT((viscous / -mass - matrices.damping.col(component)).norm(), 1e-5 * matrices.damping.norm());
    }
  }
}

TEST(PlaneWaves, OfADampedSystemAreTheRootsOfItsPolynomial)
{
  WaveMatrices matrices;
  matrices.stiffness << 9e6, 1e6, 1e6, 4e6;
  matrices.damping << 600., 50., 50., 300.;
  for (const PlaneWave &wave : plane_waves(matrices, {1., 0.}))
  {
    const std::complex<double> s(-wave.decay, wave.frequency);
    const Eigen::Matrix2cd polynomial =
      s * s * Eigen::Matrix2cd::Identity() + s * matrices.damping + matrices.stiffness.cast<std::complex<double>>();
    EXPECT_LT(std::abs(polynomial(0, 0) * polynomial(1, 1) - polynomial(0, 1) * polynomial(1, 0)),
              1e-12 * matrices.stiffness.squaredNorm());
  }
  matrices.damping.setZero();
  const auto free = plane_waves(matrices, {1., 0.});
  EXPECT_GT(free[0].frequency, free[1].frequency); // the stiff direction is the one nearest to (1, 0)
  EXPECT_EQ(free[0].decay, 0.);
}

TEST(Oscillation, FindsFrequencyAndDecay)
{
  for (const double decay : {0., 0.1, 0.4})
  {
    std::vector<double> values;
    const double step = 0.02, frequency = 3.;
    for (int i = 0; i < 130; ++i)
      values.push_back(std::exp(-decay * i * step) *
                       (std::cos(frequency * i * step) + 0.05 * std::sin(frequency * i * step)));
    const Oscillation found = fit_oscillation(values, step);
    EXPECT_NEAR(found.frequency, frequency, 1e-11);
    EXPECT_NEAR(found.decay, decay, 1e-11);
    EXPECT_LT(found.residual, 1e-12);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] += 1e-3 * std::sin(1e4 * static_cast<double>(i * i)); // as good as random
    const Oscillation noisy = fit_oscillation(values, step);
    EXPECT_NEAR(noisy.frequency, frequency, 2e-3);
    EXPECT_GT(noisy.residual, 1e-4);
  }
}

TEST(Oscillation, RefusesWhatDoesNotOscillate)
{
  std::vector<double> values;
  for (int i = 0; i < 100; ++i)
    values.push_back(std::exp(-0.1 * i));
  EXPECT_THROW(fit_oscillation(values, 1.), std::runtime_error);
}

TEST(WaveCell, HoldsWholeWavelengthsNearTheLengthAskedFor)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
    for (const WaveDirection &direction : {WaveDirection{1, 0}, {0, 1}, {1, 1}, {3, 1}, {1, 2}})
      for (const double kd : {0.05, 0.3, 1., 2.})
      {
        const WaveCell cell = wave_cell(1e-3, orientation, direction, kd);
        EXPECT_NEAR(cell.K.norm() * 1e-3, kd, 0.021 * kd);
        EXPECT_LT((cell.K.normalized() - unit_vector(direction, orientation)).norm(), 1e-14);
        for (const double turns : {cell.K.x() * cell.sheet.length(), cell.K.y() * cell.sheet.height()})
          EXPECT_NEAR(turns / (2. * M_PI), std::round(turns / (2. * M_PI)), 1e-9);
      }
}

TEST(WaveDirection, HasTheAnglesThatTheClaimsName)
{
  for (const auto orientation : {lattice::Orientation::rows_along_crack, lattice::Orientation::rows_across_crack})
  {
    const auto directions = wave_directions(orientation);
    EXPECT_NEAR(angle(directions[0], orientation), 0., 1e-13);
    EXPECT_NEAR(angle(directions[1], orientation), 30., 1e-13);
    EXPECT_NEAR(angle(directions[2], orientation), 90., 1e-13);
    const double odd = std::fmod(angle(directions[3], orientation), 30.);
    EXPECT_GT(std::min(odd, 30. - odd), 5.);
  }
}

TEST(WaveSpeeds, HoldsForBothShellSetsAcrossTheCrack)
{
  faults::expect_holds(
    [](const Case &input, const Subject &subject)
    {
      const ClaimOutcome outcome = wave_speeds_claim(subject, parts::waves({faults::state_for(input, subject)}));
      EXPECT_EQ(outcome.tables.at("wave_speeds").rows().size(), 4u * 2u * 2u); // directions, kd, waves
      return outcome.results;
    });
}

// theory-comparison.md, eq. (H.9).
TEST(WaveSpeeds, HoldsForDampedWaves)
{
  const Case input = subjects::weakly_damped_case();
  const ClaimOutcome outcome = wave_speeds_claim(subject(input), parts::waves({}, {input.deformation()}));
  EXPECT_EQ(outcome.results.rows().size(), 9u);
  for (const Result &row : outcome.results.rows())
    EXPECT_EQ(row.verdict(), Verdict::holds) << row.quantity << " " << row.error.value_or(-1.);
}

} // namespace wave_speeds_test
