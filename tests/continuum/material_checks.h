#pragma once

// Moduli of isotropic laws.

#include "continuum/errors.h"
#include "sheets.h"

#include <gtest/gtest.h>

#include <limits>

namespace material_checks
{
using namespace sheets;

inline const double epsilon = std::numeric_limits<double>::epsilon();

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
