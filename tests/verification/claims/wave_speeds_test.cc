// Waves on the lattice, in the finite elements and in closed form.
#include <gtest/gtest.h>

#include "tests/verification/claims/subjects.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/lattice_waves.h"

namespace wave_speeds_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;

// Sums over bonds, worked out apart from the code: theory.md, eqs. (L.1) and (L.4); theory-comparison.md, eq. (W.2).
TEST(Bloch, HasTheKnownSpeedsOfTheStretchedSheet)
{
  const Case input = subjects::paper_case();
  const Eigen::Matrix2d F = input.deformation();
  const auto speeds = [&](const Eigen::Vector2d &N)
  {
    const double k = 1e-4 / input.spacing;
    const auto waves = bloch_waves(input.lattice(), input.material(), F, k * N);
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
  const double exact = bloch_waves(input.lattice(), input.material(), I, K)[0].frequency;
  const WaveContinuum local{{s.cauchy_born}, {input.density}};
  const WaveContinuum gradient{{s.cauchy_born, *s.lattice_gradient}, {input.density, s.lengths.lattice}};
  const auto error = [&](const WaveContinuum &medium)
  { return plane_waves(continuum_matrices(medium, I, K), wave_normal(I, K))[0].frequency / exact - 1.; };
  EXPECT_NEAR(error(local), 1.86e-2, 5e-5);
  EXPECT_NEAR(error(gradient), 8.0e-4, 5e-6);
}

TEST(Oscillation, FindsFrequencyAndDecayIfThereAreSuch)
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
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] += 1e-3 * std::sin(1e4 * static_cast<double>(i * i)); // as good as random
    const Oscillation noisy = fit_oscillation(values, step);
    EXPECT_NEAR(noisy.frequency, frequency, 2e-3);
  }
  std::vector<double> dies_out;
  for (int i = 0; i < 100; ++i)
    dies_out.push_back(std::exp(-0.1 * i));
  EXPECT_THROW(fit_oscillation(dies_out, 1.), std::runtime_error);
}

} // namespace wave_speeds_test
