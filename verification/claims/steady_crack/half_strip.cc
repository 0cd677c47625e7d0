#include "verification/claims/steady_crack/half_strip.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>

namespace latcon::claims
{
namespace
{

using Complex = HalfStrip::Complex;
using Eigen::Matrix2cd;
using Eigen::Vector2cd;
using Eigen::Vector2d;

const Vector2d along(1., 0.);
const Vector2d right(0.5, std::sqrt(3.) / 2.); // up and to the right
const Vector2d left(-0.5, std::sqrt(3.) / 2.); // up and to the left

} // namespace

double shear_speed()
{
  return std::sqrt(3. / 8.);
}

HalfStrip::HalfStrip(const CrackStrip &strip, double speed) : strip_(strip), speed_(speed)
{
  if (strip.free_rows < 1 || !(strip.viscosity > 0.) || !(speed > 0.))
    throw std::invalid_argument("a steady crack needs a free row on each side, viscosity and speed above zero");
}

// Displacements of the rows under the forces of the bonds across the crack, by elimination from the held row up.
struct HalfStrip::Rows
{
  Complex half_step;            // exp(-i omega / (2 v)): half a spacing to the right
  Vector2cd across;             // elongation of a bond across the crack for a displacement of row 0
  std::vector<Vector2cd> moved; // of rows 0 ... N - 1
};

HalfStrip::Rows HalfStrip::rows(double omega) const
{
  const Complex half_step = std::polar(1., -0.5 * omega / speed_);
  const Complex kappa = stiffness(omega);
  const Matrix2cd right_right = (right * right.transpose()).cast<Complex>();
  const Matrix2cd left_left = (left * left.transpose()).cast<Complex>();
  const Matrix2cd from_above = kappa * (right_right * half_step + left_left * std::conj(half_step));
  const Matrix2cd from_below = kappa * (right_right * std::conj(half_step) + left_left * half_step);
  const Matrix2cd one_side = kappa * (right_right + left_left);
  const double cosine = std::cos(omega / speed_);
  const Matrix2cd row =
    kappa * (2. - 2. * cosine) * (along * along.transpose()).cast<Complex>() - omega * omega * Matrix2cd::Identity();

  // pivots[j] is the stiffness of row j with all rows below it free to follow.
  const std::size_t n = strip_.free_rows;
  std::vector<Matrix2cd> pivots(n);
  for (std::size_t j = n; j-- > 0;)
  {
    pivots[j] = row + one_side;
    if (j > 0)
      pivots[j] += one_side; // the crack leaves row 0 without bonds above
    if (j + 1 < n)
      pivots[j] -= from_below * pivots[j + 1].inverse() * from_above;
  }

  // The upper crack face is the mirror image (u_x, -u_y) of the lower one. A bond that goes up and to the left has the
  // elongation of one to the right, half a spacing's time earlier; the force on a site of row 0 is that of both.
  Rows result{half_step, {}, std::vector<Vector2cd>(n)};
  const Vector2cd mirrored(right.x(), -right.y());
  result.across = half_step * mirrored - right.cast<Complex>();
  const Vector2cd force = right.cast<Complex>() + left.cast<Complex>() * std::conj(half_step);
  result.moved[0] = pivots[0].inverse() * force;
  for (std::size_t j = 1; j < n; ++j)
    result.moved[j] = pivots[j].inverse() * (from_above * result.moved[j - 1]);
  return result;
}

Complex HalfStrip::compliance(double omega) const
{
  const Rows r = rows(omega);
  return -(r.across.transpose() * r.moved[0])(0);
}

std::vector<HalfStrip::Layer> HalfStrip::elongations(double omega) const
{
  const Rows r = rows(omega);
  const std::size_t n = strip_.free_rows;
  const Complex step = r.half_step * r.half_step - 1.;
  const auto component = [](const Vector2d &direction, const Vector2cd &w)
  { return direction.x() * w.x() + direction.y() * w.y(); };

  std::vector<Layer> layers(n + 1);
  const Complex across = (r.across.transpose() * r.moved[0])(0);
  layers[0] = {across, across * std::conj(r.half_step), step * r.moved[0].x()};
  for (std::size_t j = 1; j <= n; ++j)
  {
    const Vector2cd below = j < n ? r.moved[j] : Vector2cd(Vector2cd::Zero());
    layers[j] = {component(right, r.half_step * r.moved[j - 1] - below),
                 component(left, std::conj(r.half_step) * r.moved[j - 1] - below), step * below.x()};
  }
  return layers;
}

} // namespace latcon::claims
