// Dashpots and Maxwell branches at a point, the local and the gradient part: stresses and their derivatives, compared
// with automatic differentiation, and the update of the branches, compared with closed forms.
#include "continuum/errors.h"
#include "energies.h"
#include "moving_sheets.h"
#include "support/largest_error.h"

#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

namespace rate_laws_test
{

using namespace latcon;
using namespace energies;
using namespace moving_sheets;
using namespace latcon::continuum;

constexpr double micro_length = 0.12, spacing = micro_length / 0.6; // [m]

template <class Number>
using Derivatives = std::array<std::array<Number, n_derivatives>, 2>;

// Stretch of a bond or, of the gradient part, its derivatives across and along the bond.
template <class Number>
std::vector<Number> strains(const BondFamily &bond, const bool is_gradient, const Derivatives<Number> &u)
{
  const Tensor<1, 2> &N = bond.fibre.direction;
  Number f[2], square(0.);
  for (unsigned int i = 0; i < 2; ++i)
  {
    f[i] = N[i] + u[i][0] * N[0] + u[i][1] * N[1];
    square += f[i] * f[i];
  }
  const Number l = sqrt(square);
  if (!is_gradient)
    return {l};
  std::vector<Number> gradient;
  for (const Tensor<1, 2> &M : {Tensor<1, 2>({-N[1], N[0]}), N})
  {
    Number e(0.);
    for (unsigned int i = 0; i < 2; ++i)
      e += f[i] / l * (u[i][2] * N[0] * M[0] + u[i][3] * N[1] * M[1] + u[i][4] * (N[0] * M[1] + N[1] * M[0]));
    gradient.push_back(e);
  }
  return gradient;
}

std::vector<double> weights(const BondFamily &bond, const bool is_gradient)
{
  const double c = bond.fibre.weight, l_d2 = micro_length * micro_length;
  if (!is_gradient)
    return {c};
  return {c * l_d2, c * (l_d2 - bond.length * bond.length / 12.)};
}

// Numbers of which `first` and those behind it are the variables, of n.
Derivatives<FadFad> variables(const FieldDerivatives &values, const unsigned int first, const unsigned int n)
{
  Derivatives<FadFad> all;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = 0; c < n_derivatives; ++c)
    {
      const unsigned int number = first + n_derivatives * i + c;
      all[i][c] = FadFad(n, number, Fad(n, number, values[i][c]));
    }
  return all;
}

class RateLaw : public testing::TestWithParam<bool>
{
protected:
  RateLaw()
  {
    u = field_derivatives(random_deformation(generator), random_gradient(generator, spacing));
    v = field_derivatives(identity + random_deformation(generator), random_gradient(generator, spacing));
  }

  // Compares with the first derivatives expected(number), of a variable, and the second ones expected(number, number).
  template <class Expected>
  static void expect_derivatives(const PointIntegrand &found, const Expected &expected)
  {
    // Derivatives by second derivatives are as many lengths larger. Both sides add tens of terms with several
    // roundings.
    const auto unit = [](const unsigned int c) { return c < n_first ? 1. : spacing; };
    support::LargestError first, second;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = 0; c < n_derivatives; ++c)
      {
        first.add(std::abs(found.first[i][c]) / unit(c));
        second.add(std::abs(found.second[i][i][c][c]) / (unit(c) * unit(c)));
      }
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = 0; c < n_derivatives; ++c)
      {
        const unsigned int row = n_derivatives * i + c;
        EXPECT_NEAR(found.first[i][c], expected.first(row), 100. * epsilon * first.error() * unit(c)) << i << c;
        for (unsigned int k = 0; k < 2; ++k)
          for (unsigned int b = 0; b < n_derivatives; ++b)
            EXPECT_NEAR(found.second[i][k][c][b], expected.second(row, n_derivatives * k + b),
                        100. * epsilon * second.error() * unit(c) * unit(b))
              << i << c << k << b;
      }
  }

  const bool is_gradient = GetParam();
  const std::vector<BondFamily> bonds = rubber_bonds(spacing);
  std::mt19937 generator{21};
  FieldDerivatives u, v;
};

// theory-continuum.md, eqs. (C.41), (C.42), (C.60) and (C.61).
TEST_P(RateLaw, OfDashpotsAgreesWithTheirDifferentiatedPower)
{
  constexpr double eta = 60., rate_by_displacement = 20.;
  const FibreViscosity viscosity = network_viscosity(eta, micro_length);
  const Viscosity &law = is_gradient ? *viscosity.gradient() : viscosity;
  constexpr unsigned int n = 2 * n_derivatives;
  const auto at = variables(u, 0, 2 * n), rates = variables(v, n, 2 * n);
  // The rates of strains are their derivatives along u + t v.
  using InTime = Sacado::Fad::DFad<FadFad>;
  Derivatives<InTime> moving;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int c = 0; c < n_derivatives; ++c)
    {
      moving[i][c] = InTime(1, at[i][c]);
      moving[i][c].fastAccessDx(0) = rates[i][c];
    }
  FadFad R(0.);
  for (const BondFamily &bond : bonds)
  {
    const auto e = strains(bond, is_gradient, moving);
    for (std::size_t s = 0; s < e.size(); ++s)
      R += 0.5 * eta * weights(bond, is_gradient)[s] * e[s].dx(0) * e[s].dx(0);
  }
  PointIntegrand found;
  clear(found, Order::second);
  law.add_density(u, v, Order::second, rate_by_displacement, found);
  EXPECT_NEAR(found.value, 2. * R.val().val(), 100. * epsilon * found.value);
  struct
  {
    const FadFad &R;
    double first(const unsigned int row) const { return R.dx(n + row).val(); }
    double second(const unsigned int row, const unsigned int column) const
    {
      return R.dx(n + row).dx(column) + rate_by_displacement * R.dx(n + row).dx(n + column);
    }
  } const expected{R};
  expect_derivatives(found, expected);
}

// theory-viscoelastic.md, eqs. (V.1), (V.3) and (V.9).
TEST_P(RateLaw, OfBranchesAgreesWithTheirDifferentiatedStrains)
{
  constexpr double modulus = 2e5, duration = 3e-4;
  const std::vector<double> times{2e-4, 3e-3};
  const FibreMemory memory = network_memory(modulus, times, micro_length);
  const FibreMemory &law = is_gradient ? *memory.gradient() : memory;
  std::uniform_real_distribution<double> overstress(-modulus, modulus);
  std::vector<double> q(law.n_variables()), found_strains(law.n_strains());
  law.strains(u, found_strains.data());
  // Of which the forces of the overstresses q, with their gain in the step, are the derivatives.
  const auto at = variables(u, 0, 2 * n_derivatives);
  FadFad W(0.);
  std::size_t variable = 0, strain = 0;
  for (const BondFamily &bond : bonds)
  {
    const auto e = strains(bond, is_gradient, at);
    for (std::size_t s = 0; s < e.size(); ++s)
    {
      const double now = e[s].val().val();
      EXPECT_NEAR(found_strains[strain++], now, 20. * epsilon / (is_gradient ? spacing : 1.));
      for (const double time : times)
      {
        const double gain = -modulus * std::expm1(-duration / time) * time / duration;
        q[variable] = overstress(generator);
        W += weights(bond, is_gradient)[s] * (q[variable] * e[s] + 0.5 * gain * (e[s] - now) * (e[s] - now));
        ++variable;
      }
    }
  }
  ASSERT_EQ(variable, q.size());
  PointIntegrand found;
  clear(found, Order::second);
  law.add_density(law.step(duration), u, q.data(), Order::second, found);
  struct
  {
    const FadFad &W;
    double first(const unsigned int row) const { return W.dx(row).val(); }
    double second(const unsigned int row, const unsigned int column) const { return W.dx(row).dx(column); }
  } const expected{W};
  expect_derivatives(found, expected);
}

INSTANTIATE_TEST_SUITE_P(LocalAndGradient, RateLaw, testing::Bool());

// Two families, the second of which has branches of its own.
FibreMemory mixed_branches()
{
  return FibreMemory({{Tensor<1, 2>({0.6, 0.8}), 1.1, {{2e5, 1e-3}, {1e5, 2e-2}}, 0},
                      {Tensor<1, 2>({-0.28, 0.96}), 0.4, {{3e5, 5e-3}}, 2}});
}

std::vector<double> advanced(const FibreMemory &law, const double duration, const std::vector<double> &before,
                             const std::vector<double> &now, std::vector<double> q)
{
  law.advance(law.step(duration), before.data(), now.data(), q.data());
  return q;
}

// theory.md, eq. (L.28), with each overstress on a ramp from its differential equation. Decay and gain are
// those of (V.7).
TEST(FibreMemory, FollowsARampExactly)
{
  const FibreMemory law = mixed_branches();
  const std::vector<double> before{1.2, 0.9};
  const std::vector<double> now{1.5, 0.8};
  const std::vector<double> q0{3e4, -2e4, 1e4};
  const double moduli[] = {2e5, 1e5, 3e5};
  const double times[] = {1e-3, 2e-2, 5e-3};
  for (const double h : {1e-9, 1e-4, 1e-2, 1.})
  {
    const std::vector<double> q = advanced(law, h, before, now, q0);
    for (std::size_t i = 0; i < 3; ++i)
    {
      const double rate = (i < 2 ? 0.3 : -0.1) / h;
      const double exact = q0[i] * std::exp(-h / times[i]) - moduli[i] * times[i] * rate * std::expm1(-h / times[i]);
      EXPECT_NEAR(q[i], exact, 20. * epsilon * 1e5) << h;
    }
  }
  const std::vector<double> sudden = advanced(law, 0., before, now, q0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(sudden[i], q0[i] + moduli[i] * (i < 2 ? 0.3 : -0.1), 20. * epsilon * 1e5);
}

// theory-viscoelastic.md, eqs. (V.4) and (V.5): what the branches store and dissipate is the work done on them, here
// integrated by Gauss quadrature over parts of the ramp.
TEST(FibreMemory, StoresAndDissipatesTheWorkDone)
{
  const FibreMemory law = mixed_branches();
  const std::vector<double> l0{1.2, 0.9}, l1{1.5, 0.8}, q0{7e4, -4e4, -9e4};
  for (const double h : {1e-7, 1e-5, 3e-4, 9e-4, 1.1e-3, 4e-3, 1.9e-2, 2.1e-2})
  {
    std::vector<double> dissipated(3, 0.), before(3, 0.), after(3, 0.), work(3, 0.);
    law.add_dissipated(law.step(h), l0.data(), l1.data(), q0.data(), dissipated.data());
    law.add_stored(q0.data(), before.data());
    law.add_stored(advanced(law, h, l0, l1, q0).data(), after.data());
    // 40 relaxation times at most in 400 parts: the quadrature is exact to round-off.
    const dealii::QGauss<1> points(6);
    constexpr int parts = 400;
    for (int part = 0; part < parts; ++part)
      for (unsigned int p = 0; p < points.size(); ++p)
      {
        const double share = (part + points.point(p)[0]) / parts;
        const std::vector<double> q = advanced(law, share * h, l0, {1.2 + share * 0.3, 0.9 - share * 0.1}, q0);
        for (std::size_t i = 0; i < 3; ++i)
          work[i] += points.weight(p) / parts * q[i] * (i < 2 ? 1.1 * 0.3 : 0.4 * -0.1);
      }
    for (std::size_t i = 0; i < 3; ++i)
    {
      const double scale = before[i] + after[i] + std::abs(work[i]);
      EXPECT_GE(dissipated[i], 0.);
      EXPECT_NEAR(after[i] - before[i] + dissipated[i], work[i], 3000. * epsilon * scale) << h << ", branch " << i;
    }
  }
}

// Lengths below that of the longest bond over sqrt(12) would not dissipate.
TEST(RateLaws, RefuseWhatIsNoFibreOrNoState)
{
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const FibreDashpot dashpot{Tensor<1, 2>({1., 0.}), 0.5, 0., 0.3};
  const MaxwellFibres fibres{Tensor<1, 2>({1., 0.}), 0.5, {{1e5, 1e-3}}, 0, 0.3};
  const double shortest = 0.3 / std::sqrt(12.);
  EXPECT_NO_THROW(FibreViscosity({dashpot}, shortest));
  EXPECT_NO_THROW(FibreMemory({fibres}, shortest));
  for (const double bad : {0.999 * shortest, nan})
  {
    EXPECT_THROW(FibreViscosity({dashpot}, bad), InvalidInput);
    EXPECT_THROW(FibreMemory({fibres}, bad), InvalidInput);
  }
  EXPECT_THROW(FibreViscosity({}), InvalidInput);
  EXPECT_THROW(FibreMemory({}), InvalidInput);
  const auto refused = [&](const auto &law, const auto &valid, auto &&change, const double length)
  {
    auto other = valid;
    change(other);
    EXPECT_THROW(law({other}, length), InvalidInput);
  };
  const auto viscosity = [](const std::vector<FibreDashpot> &all, const double l) { return FibreViscosity(all, l); };
  const auto memory = [](const std::vector<MaxwellFibres> &all, const double l) { return FibreMemory(all, l); };
  for (const double bad : {0., -1., nan, infinity})
  {
    refused(
      viscosity, dashpot, [&](auto &d) { d.weight = bad; }, 0.);
    refused(
      viscosity, dashpot, [&](auto &d) { d.length = bad; }, shortest);
    refused(
      viscosity, dashpot, [&](auto &d) { d.direction[1] = bad == 0. ? 1. : bad; }, 0.);
    refused(
      viscosity, dashpot, [&](auto &d) { d.viscosity = bad == 0. ? -1e-9 : bad; }, 0.);
    refused(
      memory, fibres, [&](auto &f) { f.branches[0].modulus = bad; }, 0.);
    refused(
      memory, fibres, [&](auto &f) { f.branches[0].relaxation_time = bad; }, 0.);
  }
  refused(
    memory, fibres, [](auto &f) { f.branches.clear(); }, 0.);
  refused(
    memory, fibres, [](auto &f) { f.weight = 0.; }, 0.);

  PointIntegrand density;
  clear(density, Order::value);
  double stretch = 0.;
  for (const Tensor<2, 2> &F : {matrix(1., 0., 0., -1.25), matrix(nan, 0., 0., 1.), Tensor<2, 2>()})
  {
    const FieldDerivatives u = field_derivatives(F);
    EXPECT_THROW(FibreViscosity({dashpot}).add_density(u, u, Order::value, 0., density), NonPhysicalState);
    EXPECT_THROW(FibreMemory({fibres}).strains(u, &stretch), NonPhysicalState);
  }
}

} // namespace rate_laws_test
