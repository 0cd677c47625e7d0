#pragma once

// Manufactured solution at finite strain. Its body force, tractions and double tractions are computed by automatic
// differentiation of the energies in their defining form, in space and by F and Grad F, without code under test.

#include "energies.h"

namespace manufactured
{
using namespace energies;

// Number with its gradient and second derivatives in space, and energy with its derivatives by F and G.
using InSpace = Sacado::Fad::SFad<Sacado::Fad::SFad<double, 2>, 2>;
using Energy = Sacado::Fad::SFad<InSpace, n_variables>;

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

/// Forces of the solution at a point: per volume and, for a normal N, on an edge.
class Forces
{
public:
  using EnergyFunction = std::function<Energy(const Variables<Energy> &)>;

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
    Variables<Energy> v;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        const unsigned int of_F = variable(i, J);
        v[of_F] = Energy(n_variables, of_F, InSpace(solution_.first(i, J, x) + (i == J ? 1. : 0.)));
        for (unsigned int K = 0; K <= J; ++K)
          v[variable(i, J, K)] = Energy(n_variables, variable(i, J, K), solution_.second(i, J, K, x));
      }
    const Energy W = energy_(v);
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int J = 0; J < 2; ++J)
      {
        P_[i][J] = W.dx(variable(i, J));
        for (unsigned int K = 0; K < 2; ++K)
          Q_[i][J][K] = (J == K ? 1. : 0.5) * W.dx(variable(i, J, K)); // one variable for G_i12 and G_i21
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
