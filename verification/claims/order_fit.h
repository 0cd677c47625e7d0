#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/fits.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Wave numbers kd over which orders are fitted; the smallest error is well above round-off.
inline const std::vector<double> order_kd{0.05, 0.1, 0.2};
/// Wave number kd at which damped waves of finite elements are compared in all directions.
inline constexpr double largest_damped_kd = 0.4;
/// Tolerance of such an order.
inline constexpr double order_tolerance = 0.05;
/// Why that tolerance: the next order is (kd)^2 / 12 of the error.
inline constexpr const char *reason_of_order =
  "kd from 0.05 to 0.2: the next order is (kd)^2 of the error at most, which bends the line by 0.03";

/// Order p of an error that behaves as e = C h^p: slope of the least-squares line through (log h, log e).
/// @param h sizes, > 0, two different ones at least; @param errors > 0, one for each
/// @return not-a-number if an error is 0 or not finite
inline double fitted_order(const std::vector<double> &h, const std::vector<double> &errors)
{
  if (h.size() != errors.size() || h.size() < 2)
    throw std::invalid_argument("an order is fitted to two errors or more, each with its size");
  std::vector<double> log_h, log_errors;
  for (std::size_t i = 0; i < h.size(); ++i)
  {
    log_h.push_back(std::log(h[i]));
    log_errors.push_back(std::log(errors[i]));
  }
  return support::slope(log_h, log_errors);
}

/// Order of the errors of many waves, each at order_kd: order of their root mean square. A wave whose leading
/// error vanishes does not hide the order, and a single wave of lower order shows.
class CommonOrder
{
public:
  /// @param i number of the size in order_kd @param error of one wave
  void add(std::size_t i, double error) { squares_.at(i) += error * error; }
  /// Adds the relative error of a matrix, of which a slow wave is a small share. @param found, exact in one unit
  void add(std::size_t i, const Eigen::MatrixXd &found, const Eigen::MatrixXd &exact)
  {
    add(i, (found - exact).norm() / exact.norm());
  }

  /// See fitted_order.
  double order() const
  {
    std::vector<double> errors;
    for (const double square : squares_)
      errors.push_back(std::sqrt(square));
    return fitted_order(order_kd, errors);
  }

private:
  std::vector<double> squares_ = std::vector<double>(order_kd.size(), 0.);
};

/// Adds the row of an order that a continuum should have.
inline void add_order(const Rows &rows, const std::string &quantity, const CommonOrder &found, double claimed,
                      bool is_judged = true)
{
  const double order = found.order();
  rows.add(quantity, "1", of_continuum(order, claimed), std::abs(order - claimed), {order_tolerance, reason_of_order},
           is_judged);
}

} // namespace latcon::claims
