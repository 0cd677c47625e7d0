#include "verification/bridge/plane_waves.h"

#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/lattice/sheets.h"
#include "tests/verification/claims/subjects.h"
#include "verification/claims/states.h"

namespace slowest_wave_test
{

using namespace latcon;

using namespace bridge;
using namespace claims;
using namespace input;
using namespace output;
using sheets::stretched;

double squared_speed(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(bloch_matrices(sheet, material, F, K).stiffness)
           .eigenvalues()[0] /
         K.squaredNorm();
}

// None of a thousand other waves is slower, nor one close by. theory-comparison.md, eq. (W.1).
TEST(SlowestWave, IsTheSlowestOfAll)
{
  const Case input = subjects::paper_case();
  const lattice::TriangularLattice sheet = input.lattice();
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> angle(0., M_PI), length(0.02, 4. * M_PI / 3.);
  for (const lattice::Material &material : {input.material(), subjects::nearest_only(input)})
    for (const Eigen::Matrix2d &F : {stretched(1., 1.), stretched(2.3, 2.8), stretched(0.8, 1.1), stretched(3., 0.9)})
    {
      const SlowestWave slowest = slowest_wave(sheet, material, F);
      EXPECT_NEAR(squared_speed(sheet, material, F, slowest.wave_vector), slowest.squared_speed,
                  1e-12 * std::abs(slowest.squared_speed));
      double scale = 0., smallest = slowest.squared_speed;
      for (int i = 0; i < 1000; ++i)
      {
        const double phi = angle(generator), k = length(generator) / input.spacing;
        const double found = squared_speed(sheet, material, F, {k * std::cos(phi), k * std::sin(phi)});
        scale = std::max(scale, found);
        smallest = std::min(smallest, found);
      }
      const double k = slowest.wave_vector.norm() * input.spacing,
                   phi = std::atan2(slowest.wave_vector[1], slowest.wave_vector[0]);
      for (const double turn : {-0.005, 0., 0.005}) // a fifth of the grid, which is 1.5 degrees by 0.07
        for (const double longer : {-0.014, 0., 0.014})
          if (const double to = k + longer; to >= 0.01 && to <= 4. * M_PI / 3.)
            smallest = std::min(smallest, squared_speed(sheet, material, F,
                                                        to / input.spacing *
                                                          Eigen::Vector2d(std::cos(phi + turn), std::sin(phi + turn))));
      // Steps end at 1e-6 of the grid; round-off of w^2 is that of its terms, 4 / (kd)^2 larger for the longest waves.
      EXPECT_GE(smallest, slowest.squared_speed - 1e-10 * scale);
    }
}

// A row that holds or says in which waves the sheet buckles: claims_test.cc.
TEST(StabilityRow, FailsForNeutralStability)
{
  Subject neutral = subject(subjects::paper_case());
  EXPECT_EQ(stability_row(neutral, "prestretch").verdict(), Verdict::holds);
  neutral.slowest_wave.squared_speed = 0.;
  EXPECT_EQ(stability_row(neutral, "prestretch").verdict(), Verdict::fails);
}

} // namespace slowest_wave_test
