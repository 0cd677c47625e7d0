#pragma once

#include <vector>

namespace latcon::continuum
{
/// Stages of the damped Runge-Kutta-Chebyshev method of second order for equations whose stiffness is viscous
/// (theory-damage.md, eqs. (C.72), (C.73)):
///   Y_1 = Y_0 + first h F_0,
///   Y_j = (1 - mu - nu) Y_0 + mu Y_{j-1} + nu Y_{j-2} + h (now F_{j-1} + start F_0),   j = 2 ... s.
/// Y_s is the state after the step h. Written independently of the stepper of the lattice, with which it is compared.
class ViscousStages
{
public:
  /// Coefficients of stage j >= 2 [-].
  struct Stage
  {
    double mu, nu;
    double now, start;
  };

  /// Creates the method with `n` >= 2 stages. Throws InvalidInput for fewer.
  explicit ViscousStages(unsigned int n);

  double first() const { return first_; }
  const std::vector<Stage> &stages() const { return stages_; }

  /// Returns beta(n) [-]: a step h is stable for real eigenvalues from -beta/h to 0.
  static double real_limit(unsigned int n);

  /// Returns the smallest n with real_limit(n) >= `limit` [-]. Throws InvalidInput unless `limit` is finite and not
  /// negative, and if more than max_stages are necessary.
  static unsigned int required(double limit);

  /// Returns the smallest n >= required(`limit`) with which no wave grows either, whose eigenvalues z [-] satisfy
  /// z^2 + limit q z + wave^2 q = 0 or, with a quarter of the damping, z^2 + limit q z / 4 + wave^2 q = 0, for 0 < q <=
  /// 1 (theory-damage.md, "Stable steps"). Throws InvalidInput if there is none below required(`limit`) + 10: more
  /// stages would not help.
  static unsigned int required(double limit, double wave);

  static constexpr unsigned int max_stages = 500;

private:
  bool damps(double rate, double wave) const;

  double first_;
  std::vector<Stage> stages_;
};
} // namespace latcon::continuum
