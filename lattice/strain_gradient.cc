#include "lattice/strain_gradient.h"

#include <vector>

#include "support/dense.h"

namespace latcon::lattice
{

const std::optional<StrainGradientFit::Weights> &StrainGradientFit::weights(unsigned int bonds)
{
  const auto [found, is_missing] = weights_.try_emplace(bonds);
  std::optional<Weights> &weights = found->second;
  if (!is_missing)
    return weights;

  std::vector<std::size_t> neighbours;
  for (std::size_t n = 0; n < n_neighbours; ++n)
    if ((bonds >> n & 1u) != 0)
      neighbours.push_back(n);
  constexpr Eigen::Index unknowns = 5; // F_x, F_y, G_xx, G_xy, G_yy of one component, in units of d
  const auto n_equations = static_cast<Eigen::Index>(neighbours.size());
  if (n_equations < unknowns)
    return weights;
  const double d = lattice_.spacing();
  Eigen::MatrixXd equations(n_equations, unknowns);
  for (Eigen::Index i = 0; i < n_equations; ++i)
  {
    const std::size_t n = neighbours[static_cast<std::size_t>(i)];
    const Eigen::Vector2d R = (n < n_kinds ? 1. : -1.) / d * lattice_.bond_vector(n % n_kinds);
    equations.row(i) << R.x(), R.y(), 0.5 * R.x() * R.x(), R.x() * R.y(), 0.5 * R.y() * R.y();
  }
  // Neighbours stand at distances of the order of d, so that a set either fixes all five well or not at all.
  const std::optional<Eigen::MatrixXd> inverse = support::left_inverse(equations, 1e-6);
  if (!inverse)
    return weights;
  weights = Weights::Zero();
  for (Eigen::Index i = 0; i < n_equations; ++i)
    weights->col(static_cast<Eigen::Index>(neighbours[static_cast<std::size_t>(i)])) =
      inverse->col(i).tail<3>() / (d * d);
  return weights;
}

std::optional<StrainGradient> StrainGradientFit::at(const State &state, std::size_t place)
{
  if (!lattice_.is_triangular())
    return std::nullopt;
  unsigned int bonds = 0;
  Eigen::Matrix<double, n_neighbours, 2> positions = Eigen::Matrix<double, n_neighbours, 2>::Zero();
  for_each_bond_of_site(state, lattice_, place,
                        [&](const Bond &bond)
                        {
                          const auto [near, kind, far] = bond;
                          if (kind >= n_kinds)
                            return;
                          const bool forward = near == place;
                          const auto n = forward ? kind : kind + n_kinds;
                          bonds |= 1u << n;
                          const double sign = forward ? 1. : -1.;
                          positions(static_cast<Eigen::Index>(n), 0) = sign * (state.x[far] - state.x[near]);
                          positions(static_cast<Eigen::Index>(n), 1) = sign * (state.y[far] - state.y[near]);
                        });
  const std::optional<Weights> &of_bonds = weights(bonds);
  if (!of_bonds)
    return std::nullopt;
  const Eigen::Matrix<double, 3, 2> G = *of_bonds * positions;
  StrainGradient gradient;
  gradient.x << G(0, 0), G(1, 0), G(1, 0), G(2, 0);
  gradient.y << G(0, 1), G(1, 1), G(1, 1), G(2, 1);
  return gradient;
}

} // namespace latcon::lattice
