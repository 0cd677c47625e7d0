#pragma once

#include <complex>
#include <vector>

namespace latcon::lattice
{

/// The stages of a Runge-Kutta-Chebyshev method of second order (theory.md, eqs. (L.17) to (L.20)):
///   Y_1 = Y_0 + first h F_0,
///   Y_j = Y_0 + mu (Y_{j-1} - Y_0) + nu (Y_{j-2} - Y_0) + h (now F_{j-1} + start F_0),   j = 2 ... s.
/// Y_s is the state at the end of the step.
class ChebyshevStages
{
public:
  /// Coefficients of one stage.
  struct Stage
  {
    double mu, nu;
    double now, start; ///< weights of F_{j-1} and of F_0
    double elapsed;    ///< time of Y_{j-1} after the start of the step, over h
  };

  /// @param stages s, number of force evaluations a step, >= 2
  /// @throws std::invalid_argument for fewer
  explicit ChebyshevStages(unsigned int stages);

  double first() const { return first_; }
  const std::vector<Stage> &stages() const { return stages_; } ///< j = 2 ... s

  /// beta (theory.md, eq. (L.20)): with y' = lambda y a step is stable for all z = h lambda from -beta to 0.
  double real_limit() const { return real_limit_; }

  /// R(z): a step multiplies the solution of y' = lambda y by R(h lambda).
  std::complex<double> amplification(std::complex<double> z) const;

  /// Smallest number of stages whose real_limit() is at least `limit`.
  static unsigned int needed(double limit);

private:
  double first_;
  double real_limit_;
  std::vector<Stage> stages_;
};

} // namespace latcon::lattice
