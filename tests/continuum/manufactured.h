#pragma once

// Manufactured solution at finite strain. Its body force, tractions and double tractions are computed by automatic
// differentiation of the energies in their defining form, in space and by F and Grad F, without code under test.

#include "sheets.h"

#include <Sacado.hpp>

#include <array>
#include <cmath>

namespace manufactured
{
using dealii::Point;
using dealii::Tensor;

// Number with its gradient and second derivatives in space, and energy with its derivatives by the ten variables F_11
// F_12 F_21 F_22, G_i11 G_i22 G_i12.
using InSpace = Sacado::Fad::SFad<Sacado::Fad::SFad<double, 2>, 2>;
constexpr unsigned int n_variables = 10;
using Energy = Sacado::Fad::SFad<InSpace, n_variables>;
using Variables = std::array<Energy, n_variables>;

/// Solution u_i = (s_i - 1) X_i + a_i sin(k_i . X + phase_i): principal stretches from 0.9 to 2.0 over the unit square.
struct Solution
{
  double stretch[2] = {1.55, 1.4};
  double amplitude[2] = {0.11, 0.09};
  double wave[2][2] = {{2.9, 1.9}, {-2.1, 3.1}};
  double phase[2] = {0.3, 1.1};

  template <typename Number>
  Number argument(const unsigned int i, const std::array<Number, 2> &X) const
  {
    return wave[i][0] * X[0] + wave[i][1] * X[1] + phase[i];
  }
  template <typename Number>
  Number value(const unsigned int i, const std::array<Number, 2> &X) const
  {
    using std::sin;
    return (stretch[i] - 1.) * X[i] + amplitude[i] * sin(argument(i, X));
  }
  template <typename Number>
  Number first(const unsigned int i, const unsigned int J, const std::array<Number, 2> &X) const
  {
    using std::cos;
    return (i == J ? stretch[i] - 1. : 0.) + amplitude[i] * wave[i][J] * cos(argument(i, X));
  }
  template <typename Number>
  Number second(const unsigned int i, const unsigned int J, const unsigned int K, const std::array<Number, 2> &X) const
  {
    using std::sin;
    return -amplitude[i] * wave[i][J] * wave[i][K] * sin(argument(i, X));
  }
};

/// Energy of the rod network, bond by bond.
struct NetworkEnergy
{
  std::vector<latcon::continuum::FibreFamily> families;

  Energy operator()(const Variables &v) const
  {
    Energy W(0.);
    for (const auto &family : families)
    {
      const auto &N = family.direction;
      const auto &rod = std::get<latcon::continuum::RodPotential>(family.potential);
      const Energy x = v[0] * N[0] + v[1] * N[1];
      const Energy y = v[2] * N[0] + v[3] * N[1];
      const Energy l2 = x * x + y * y;
      const Energy l = sqrt(l2);
      W += family.weight * (rod.a * (0.5 * l2 + 1. / l - 1.5) + rod.b * (l + 0.5 / l2 - 1.5));
    }
    return W;
  }
};

/// Compressible Mooney-Rivlin in plane stress, thickness eliminated by Newton on dw/dt = 0.
struct MooneyRivlinEnergy
{
  latcon::continuum::MooneyRivlin::Constants m;

  template <typename Number>
  static Number by_thickness(const latcon::continuum::MooneyRivlin::Constants &m, const Number &f, const Number &j,
                             const Number &t)
  {
    return m.c1 * (2. * t - 2. / t) + m.c2 * (2. * t * f - 4. / t) + m.kappa * (j * t - 1.) * j;
  }

  Energy operator()(const Variables &v) const
  {
    const Energy f = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
    const Energy j = v[0] * v[3] - v[1] * v[2];
    const double f0 = f.val().val().val();
    const double j0 = j.val().val().val();
    double t0 = 1. / j0;
    for (int k = 0; k < 60; ++k)
      t0 -= by_thickness(m, f0, j0, t0) /
            (m.c1 * (2. + 2. / (t0 * t0)) + m.c2 * (2. * f0 + 4. / (t0 * t0)) + m.kappa * j0 * j0);
    // Each further Newton step makes one more derivative correct; three derivatives of the thickness are needed.
    Energy t(t0);
    for (int k = 0; k < 3; ++k)
    {
      const Energy slope = m.c1 * (2. + 2. / (t * t)) + m.c2 * (2. * f + 4. / (t * t)) + m.kappa * j * j;
      const Energy residual = by_thickness(m, f, j, t);
      t -= residual / slope;
    }
    const Energy J = j * t;
    const Energy log_J = log(J);
    return m.c1 * (f + t * t - 3. - 2. * log_J) + m.c2 * (j * j + t * t * f - 3. - 4. * log_J) +
           0.5 * m.kappa * (J - 1.) * (J - 1.);
  }
};

/// (c/2) |G|^2
struct IsotropicGradientEnergy
{
  double modulus;

  Energy operator()(const Variables &v) const
  {
    Energy W(0.);
    for (unsigned int i = 0; i < 2; ++i)
      W +=
        0.5 * modulus * (v[4 + 3 * i] * v[4 + 3 * i] + v[5 + 3 * i] * v[5 + 3 * i] + 2. * v[6 + 3 * i] * v[6 + 3 * i]);
    return W;
  }
};

/// Energy of theory-continuum.md, eq. (C.22), bond by bond.
struct LatticeGradientEnergy
{
  std::vector<latcon::continuum::BondFamily> bonds;
  double length;

  Energy operator()(const Variables &v) const
  {
    Energy W(0.);
    for (const auto &bond : bonds)
    {
      const auto &N = bond.fibre.direction;
      const auto &rod = std::get<latcon::continuum::RodPotential>(bond.fibre.potential);
      const Energy x = v[0] * N[0] + v[1] * N[1];
      const Energy y = v[2] * N[0] + v[3] * N[1];
      const Energy l2 = x * x + y * y;
      const Energy l = sqrt(l2);
      const Energy across = rod.a * (1. - 1. / (l2 * l)) + rod.b * (1. / l - 1. / (l2 * l2));
      const Energy along = rod.a * (1. + 2. / (l2 * l)) + 3. * rod.b / (l2 * l2);
      const auto h = [&](const Energy &a, const Energy &b) -> Energy
      {
        const Energy n_a = (a * x + b * y) / l;
        return along * n_a * n_a + across * (a * a + b * b - n_a * n_a);
      };
      const Energy x_1 = v[4] * N[0] + v[6] * N[1];
      const Energy x_2 = v[6] * N[0] + v[5] * N[1];
      const Energy y_1 = v[7] * N[0] + v[9] * N[1];
      const Energy y_2 = v[9] * N[0] + v[8] * N[1];
      const Energy h1 = h(x_1, y_1);
      const Energy h2 = h(x_2, y_2);
      const Energy x_nn = x_1 * N[0] + x_2 * N[1];
      const Energy y_nn = y_1 * N[0] + y_2 * N[1];
      const Energy h_nn = h(x_nn, y_nn);
      W += 0.5 * bond.fibre.weight * (length * length * (h1 + h2) - bond.length * bond.length / 12. * h_nn);
    }
    return W;
  }
};

/// Forces of the solution at a point: per volume and, for a normal N, on an edge.
class Forces
{
public:
  using EnergyFunction = std::function<Energy(const Variables &)>;

  explicit Forces(EnergyFunction energy) : energy_(std::move(energy)) {}

  /// f_i = -d/dX_J (P_iJ - dQ_iJK/dX_K)
  Tensor<1, 2> body(const Point<2> &X) const
  {
    look_at(X);
    Tensor<1, 2> f;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        f[i] -= P_[i][J].dx(J).val();
        for (unsigned int K = 0; K < 2; ++K)
          f[i] += Q_[i][J][K].dx(J).dx(K);
      }
    return f;
  }

  /// t_i = (P_iJ - dQ_iJK/dX_K) N_J - d/dT (Q_iJK T_J N_K) on a straight edge
  Tensor<1, 2> traction(const Point<2> &X, const Tensor<1, 2> &N) const
  {
    look_at(X);
    const double T[2] = {-N[1], N[0]};
    Tensor<1, 2> t;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        t[i] += P_[i][J].val().val() * N[J];
        for (unsigned int K = 0; K < 2; ++K)
        {
          t[i] -= Q_[i][J][K].dx(K).val() * N[J];
          for (unsigned int M = 0; M < 2; ++M)
            t[i] -= Q_[i][J][K].dx(M).val() * T[M] * T[J] * N[K];
        }
      }
    return t;
  }

  /// m_i = Q_iJK N_J N_K
  Tensor<1, 2> double_traction(const Point<2> &X, const Tensor<1, 2> &N) const
  {
    look_at(X);
    Tensor<1, 2> m;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          m[i] += Q_[i][J][K].val().val() * N[J] * N[K];
    return m;
  }

  const Solution &solution() const { return solution_; }

private:
  // Components are evaluated one by one, so the last point is cached.
  void look_at(const Point<2> &X) const
  {
    if (known_ && X == at_)
      return;
    at_ = X;
    known_ = true;
    std::array<InSpace, 2> x;
    for (unsigned int d = 0; d < 2; ++d)
    {
      x[d] = InSpace(2, d, Sacado::Fad::SFad<double, 2>(2, d, X[d]));
    }
    Variables v;
    for (unsigned int i = 0; i < 2; ++i)
    {
      for (unsigned int J = 0; J < 2; ++J)
        v[2 * i + J] = Energy(n_variables, 2 * i + J, InSpace(solution_.first(i, J, x) + (i == J ? 1. : 0.)));
      const unsigned int pairs[3][2] = {{0, 0}, {1, 1}, {0, 1}};
      for (unsigned int c = 0; c < 3; ++c)
        v[4 + 3 * i + c] = Energy(n_variables, 4 + 3 * i + c, solution_.second(i, pairs[c][0], pairs[c][1], x));
    }
    const Energy W = energy_(v);
    const unsigned int place[2][2] = {{0, 2}, {2, 1}};
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        P_[i][J] = W.dx(2 * i + J);
        for (unsigned int K = 0; K < 2; ++K)
          Q_[i][J][K] = (J == K ? 1. : 0.5) * W.dx(4 + 3 * i + place[J][K]); // one variable for G_i12 and G_i21
      }
  }

  EnergyFunction energy_;
  Solution solution_;
  mutable bool known_ = false;
  mutable Point<2> at_;
  mutable InSpace P_[2][2];
  mutable InSpace Q_[2][2][2];
};
} // namespace manufactured
