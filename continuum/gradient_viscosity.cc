#include "continuum/gradient_viscosity.h"

#include "continuum/errors.h"

#include <cmath>

using dealii::outer_product;
using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
using ByDerivatives = double[2][n_derivatives]; // [component][derivative]

// Direction of a dashpot in the state (F, Fdot).
struct DashpotMotion
{
  Tensor<1, 2> n;       // F N / |F N|
  Tensor<2, 2> turning; // dn_i/df_k = (delta_ik - n_i n_k) / |f|, f = F N
  Tensor<1, 2> spin;    // dn/dt [1/s]
  Tensor<1, 2> rate;    // df/dt [1/s]
  double stretch;       // |f|
};

DashpotMotion dashpot_motion(const Tensor<1, 2> &N, const FieldDerivatives &u, const FieldDerivatives &v)
{
  DashpotMotion motion;
  Tensor<1, 2> f = N;
  for (unsigned int i = 0; i < 2; ++i)
  {
    f[i] += u[i][0] * N[0] + u[i][1] * N[1];
    motion.rate[i] = v[i][0] * N[0] + v[i][1] * N[1];
  }
  motion.stretch = f.norm();
  motion.n = f / motion.stretch;
  motion.turning = -1. / motion.stretch * outer_product(motion.n, motion.n);
  for (unsigned int i = 0; i < 2; ++i)
    motion.turning[i][i] += 1. / motion.stretch;
  motion.spin = motion.turning * motion.rate;
  return motion;
}

// Rate e' = n . a' + e_f . f' of e = n . a, a component of the gradient of a stretch, with e_f = (dn/df) a and
// a_i = sum over c of row[c] u_i,c. It is linear in v.
class StretchGradientRate
{
public:
  StretchGradientRate(const DashpotMotion &motion, const Tensor<1, 2> &N, const ComponentDerivatives &row,
                      const FieldDerivatives &u, const FieldDerivatives &v, const bool needs_second)
    : motion_(motion), N_(N), row_(row)
  {
    Tensor<1, 2> a_rate;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = n_first; c < n_derivatives; ++c)
      {
        a_[i] += row[c] * u[i][c];
        a_rate[i] += row[c] * v[i][c];
      }
    const Tensor<1, 2> by_f = motion.turning * a_;
    value = motion.n * a_rate + by_f * motion.rate;
    fill(by_f, motion.n, by_rate);
    if (!needs_second)
      return;
    const double along = motion.n * a_;
    by_ff_ = 3. * along * outer_product(motion.n, motion.n) - outer_product(a_, motion.n) - outer_product(motion.n, a_);
    for (unsigned int i = 0; i < 2; ++i)
      by_ff_[i][i] -= along;
    by_ff_ /= motion.stretch * motion.stretch;
    fill(by_ff_ * motion.rate + motion.turning * a_rate, motion.spin, by_state);
  }

  // Derivative of by_rate[i][c] by derivative e of component k of u.
  double by_rate_by_state(const unsigned int i, const unsigned int c, const unsigned int k, const unsigned int e) const
  {
    if (c < n_first)
      return N_[c] * (e < n_first ? by_ff_[i][k] * N_[e] : motion_.turning[i][k] * row_[e]);
    return e < n_first ? row_[c] * motion_.turning[i][k] * N_[e] : 0.;
  }

  double value;           // e' [1/(m s)]
  ByDerivatives by_rate;  // by the derivatives of v, which are those of e by u
  ByDerivatives by_state; // by the derivatives of u at fixed v

private:
  void fill(const Tensor<1, 2> &by_f, const Tensor<1, 2> &by_a, ByDerivatives &all) const
  {
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int c = 0; c < n_derivatives; ++c)
        all[i][c] = c < n_first ? by_f[i] * N_[c] : by_a[i] * row_[c];
  }

  const DashpotMotion &motion_;
  const Tensor<1, 2> &N_;
  const ComponentDerivatives &row_;
  Tensor<1, 2> a_;
  Tensor<2, 2> by_ff_; // d2e/df df
};
} // namespace

GradientViscosity::GradientViscosity(const std::vector<FibreDashpot> &dashpots, const double length)
{
  for (const FibreDashpot &dashpot : dashpots)
  {
    check(dashpot);
    if (!(dashpot.length > 0. && std::isfinite(dashpot.length)))
      throw InvalidMaterial("the dashpots of a gradient viscosity need a positive and finite length");
    // At the smallest length the difference is zero up to rounding and must not become negative.
    constexpr double rounding = 1e-14;
    double along = length * length - dashpot.length * dashpot.length / 12.;
    if (std::abs(along) <= rounding * length * length)
      along = 0.;
    if (!(along >= 0.) || !std::isfinite(length))
      throw InvalidMaterial("the micro-inertia length must be at least " +
                            std::to_string(dashpot.length / std::sqrt(12.)) +
                            " m, the longest bond over sqrt(12), for the gradient viscosity to dissipate");
    const Tensor<1, 2> &N = dashpot.direction;
    const Tensor<1, 2> T({-N[1], N[0]});
    const auto term = [&](const Tensor<1, 2> &M, const double squared_length)
    {
      return Term{dashpot.weight * dashpot.viscosity * squared_length,
                  {0., 0., N[0] * M[0], N[1] * M[1], N[0] * M[1] + N[1] * M[0]}};
    };
    families_.push_back({N, {term(T, length * length), term(N, along)}});
  }
}

void GradientViscosity::add_density(const FieldDerivatives &u, const FieldDerivatives &v, const Order order,
                                    const double rate_by_displacement, PointIntegrand &d) const
{
  for (const Family &family : families_)
  {
    const DashpotMotion motion = dashpot_motion(family.direction, u, v);
    for (const Term &term : family.terms)
    {
      const StretchGradientRate e(motion, family.direction, term.row, u, v, order == Order::second);
      d.value += term.factor * e.value * e.value;
      if (order == Order::value)
        continue;
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int c = 0; c < n_derivatives; ++c)
        {
          d.first[i][c] += term.factor * e.value * e.by_rate[i][c];
          for (unsigned int k = 0; k < 2 && order == Order::second; ++k)
            for (unsigned int b = 0; b < n_derivatives; ++b)
              d.second[i][k][c][b] +=
                term.factor * (e.by_rate[i][c] * (rate_by_displacement * e.by_rate[k][b] + e.by_state[k][b]) +
                               e.value * e.by_rate_by_state(i, c, k, b));
        }
    }
  }
}

double GradientViscosity::dissipation(const Tensor<2, 2> &F, const Tensor<3, 2> &G, const Tensor<2, 2> &Fdot,
                                      const Tensor<3, 2> &Gdot) const
{
  const auto derivatives = [](const Tensor<2, 2> &first, const Tensor<3, 2> &second)
  {
    FieldDerivatives all;
    for (unsigned int i = 0; i < 2; ++i)
      all[i] = {first[i][0], first[i][1], second[i][0][0], second[i][1][1], second[i][0][1]};
    return all;
  };
  FieldDerivatives u = derivatives(F, G);
  for (unsigned int i = 0; i < 2; ++i)
    u[i][i] -= 1.;
  PointIntegrand density;
  clear(density, Order::value);
  add_density(u, derivatives(Fdot, Gdot), Order::value, 0., density);
  return density.value;
}
} // namespace latcon::continuum
