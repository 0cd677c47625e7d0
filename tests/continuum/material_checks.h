#pragma once

// Properties of every local law: derivatives, symmetries, domain and moduli.

#include "continuum/errors.h"
#include "sheets.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

namespace material_checks
{
using namespace sheets;

inline const double epsilon = std::numeric_limits<double>::epsilon();

// Returns the least-squares slope of log(remainder) over log(h), h = 2^-4 ... 2^-10.
inline double observed_order(const std::function<double(double)> &remainder)
{
  double n = 0., x_sum = 0., y_sum = 0., xx_sum = 0., xy_sum = 0.;
  for (int k = 4; k <= 10; ++k)
  {
    const double h = std::ldexp(1., -k);
    const double x = std::log(h);
    const double y = std::log(remainder(h));
    n += 1.;
    x_sum += x;
    y_sum += y;
    xx_sum += x * x;
    xy_sum += x * y;
  }
  return (n * xy_sum - x_sum * y_sum) / (n * xx_sum - x_sum * x_sum);
}

// Checks stress against energy and tangent against stress by Taylor's theorem. The second-order remainders have the
// size of the stiffness, so an error of any derivative reduces the order to 1.
inline void expect_taylor_orders(const latcon::continuum::Material &law, const bool of_energy)
{
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> entry(-0.3, 0.3);
  for (int sample = 0; sample < 20; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator, 0.8, 3.);
    const Tensor<2, 2> G = matrix(entry(generator), entry(generator), entry(generator), entry(generator));
    const double W = law.energy(F);
    const Tensor<2, 2> P = law.first_piola_stress(F);
    const Tensor<2, 2> dP = dealii::double_contract<2, 0, 3, 1>(law.tangent(F), G);
    const double order =
      of_energy
        ? observed_order([&](const double h) { return std::abs(law.energy(F + h * G) - W - h * scalar_product(P, G)); })
        : observed_order([&](const double h) { return (law.first_piola_stress(F + h * G) - P - h * dP).norm(); });
    // A remainder of order 3 where the second derivative happens to vanish is not an error, hence no upper limit.
    EXPECT_GE(order, 1.9) << "F = " << F;
  }
}

inline void expect_objective(const latcon::continuum::Material &law)
{
  std::mt19937 generator(5);
  for (int sample = 0; sample < 50; ++sample)
  {
    const Tensor<2, 2> F = random_deformation(generator);
    const Tensor<2, 2> R = rotation(0.1 + 0.12 * sample);
    const double W = law.energy(F);
    const Tensor<2, 2> P = law.first_piola_stress(F);
    const double scale = law.tangent(F).norm() * F.norm_square();
    EXPECT_NEAR(law.energy(R * F), W, 100. * epsilon * scale);
    EXPECT_NEAR((law.first_piola_stress(R * F) - R * P).norm(), 0., 100. * epsilon * scale);
    EXPECT_NEAR(law.thickness_stretch(R * F), law.thickness_stretch(F), 100. * epsilon);
    // Angular momentum: P F^T is symmetric.
    const Tensor<2, 2> tau = P * transpose(F);
    EXPECT_NEAR(tau[0][1], tau[1][0], 100. * epsilon * scale);
  }
}

inline void expect_major_symmetry(const latcon::continuum::Material &law)
{
  std::mt19937 generator(6);
  for (int sample = 0; sample < 50; ++sample)
  {
    const Tensor<4, 2> T = law.tangent(random_deformation(generator));
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int L = 0; L < 2; ++L)
            EXPECT_NEAR(T[i][J][k][L], T[k][L][i][J], 10. * epsilon * T.norm());
  }
}

inline void expect_refusal(const latcon::continuum::Material &law)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Tensor<2, 2> &F : {matrix(1., 0., 0., -1.25), matrix(1., 2., 2., 4.), matrix(nan, 0., 0., 1.),
                                matrix(infinity, 0., 0., 1.), Tensor<2, 2>()})
  {
    EXPECT_THROW(law.energy(F), latcon::continuum::NonPhysicalState);
    EXPECT_THROW(law.first_piola_stress(F), latcon::continuum::NonPhysicalState);
    EXPECT_THROW(law.tangent(F), latcon::continuum::NonPhysicalState);
    EXPECT_THROW(law.thickness_stretch(F), latcon::continuum::NonPhysicalState);
  }
  try
  {
    law.energy(matrix(1., 0., 0., -1.25));
  }
  catch (const latcon::continuum::NonPhysicalState &failure)
  {
    EXPECT_NE(std::string(failure.what()).find("-1.25"), std::string::npos) << failure.what();
  }
}

inline void expect_isotropic_moduli(const latcon::continuum::Material &law, const double lambda, const double mu)
{
  const Tensor<2, 2> I = matrix(1., 0., 0., 1.);
  EXPECT_NEAR(law.energy(I), 0., 10. * epsilon * mu);
  EXPECT_NEAR(law.first_piola_stress(I).norm(), 0., 10. * epsilon * mu);
  EXPECT_NEAR(law.thickness_stretch(I), 1., 10. * epsilon);
  const Tensor<4, 2> T = law.tangent(I);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int L = 0; L < 2; ++L)
          EXPECT_NEAR(T[i][J][k][L], lambda * I[i][J] * I[k][L] + mu * (I[i][k] * I[J][L] + I[i][L] * I[J][k]),
                      20. * epsilon * mu)
            << i << J << k << L;
}
} // namespace material_checks
