#include "lattice/site_fields.h"

#include <Eigen/LU>

#include "support/dense.h"

namespace latcon::lattice
{

SiteValues site_values(const State &state, const TriangularLattice &lattice, const Material &material,
                       std::size_t place)
{
  SiteValues values;
  // Normal equations of the fit of F: F (sum R R^T) = sum r R^T.
  Eigen::Matrix2d reference_moment = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d mixed_moment = Eigen::Matrix2d::Zero();
  for_each_bond_of_site(state, lattice, place,
                        [&](const Bond &bond)
                        {
                          const auto [near, kind, far] = bond;
                          const Shell &shell = *material.shell(lattice, kind);
                          const Eigen::Vector2d r = state.position.difference(near, far);
                          const Eigen::Vector2d rate = state.velocity.difference(near, far);
                          const double length = r.norm(), ratio = lattice.length_ratio(near, kind);
                          const Eigen::Vector2d direction = r / length, R = lattice.bond_vector(bond);
                          const double rest_length = lattice.rest_length(kind) / ratio, stretch = length / rest_length;
                          const double section =
                            state.stiffness.of(near, kind) * ratio * cross_section(shell, lattice, kind);
                          double axial =
                            section * (force(shell.law, stretch) + shell.viscosity * rate.dot(direction) / rest_length);
                          if (state.history.remembers(kind))
                          {
                            // As of the last update.
                            auto variables = state.history.variables_of(near, kind);
                            std::array<double, max_history_variables> dissipation{};
                            const double then = state.history.kinds[kind].stretch[near];
                            axial += section * advance(shell.memory, then, then, variables.data(), dissipation.data());
                          }
                          ++values.bonds;
                          values.strain_energy_density += 0.5 * section * rest_length * energy(shell.law, stretch);
                          values.first_piola_stress += 0.5 * axial * direction * R.transpose();
                          reference_moment += R * R.transpose();
                          mixed_moment += r * R.transpose();
                        });

  const double area = lattice.site_area();
  values.strain_energy_density /= area;
  values.first_piola_stress /= area;
  if (values.bonds + state.lost_bonds[place] > 0)
    values.damage = static_cast<double>(state.lost_bonds[place]) / (values.bonds + state.lost_bonds[place]);

  // Bonds along one line leave the moment singular; d^4 is the scale of its determinant.
  const double d2 = lattice.spacing() * lattice.spacing();
  if (!(reference_moment.determinant() > 1e-6 * d2 * d2))
    return values;
  const Eigen::Matrix2d F = mixed_moment * reference_moment.inverse();
  values.deformation_gradient = F;
  if (F.determinant() > 0.)
    values.cauchy_stress = values.first_piola_stress * F.transpose() / F.determinant();
  return values;
}

std::vector<SiteValues> site_fields(const State &state, const TriangularLattice &lattice, const Material &material)
{
  std::vector<SiteValues> fields(lattice.n_places());
  for (const std::size_t place : lattice.sites())
    fields[place] = site_values(state, lattice, material, place);
  return fields;
}

std::optional<StrainGradientFit::Weights> StrainGradientFit::weights(unsigned int bonds) const
{
  std::vector<std::size_t> neighbours;
  for (std::size_t n = 0; n < n_neighbours; ++n)
    if ((bonds >> n & 1u) != 0)
      neighbours.push_back(n);
  constexpr Eigen::Index unknowns = 5; // F_x, F_y, G_xx, G_xy, G_yy of one component, in units of d
  const auto n_equations = static_cast<Eigen::Index>(neighbours.size());
  if (n_equations < unknowns)
    return std::nullopt;
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
    return std::nullopt;
  Weights weights = Weights::Zero();
  for (Eigen::Index i = 0; i < n_equations; ++i)
    weights.col(static_cast<Eigen::Index>(neighbours[static_cast<std::size_t>(i)])) =
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
                          positions.row(static_cast<Eigen::Index>(n)) = sign * state.position.difference(near, far);
                        });
  const auto [found, is_new] = weights_.try_emplace(bonds);
  if (is_new)
    found->second = weights(bonds);
  if (!found->second)
    return std::nullopt;
  const Eigen::Matrix<double, 3, 2> G = *found->second * positions;
  StrainGradient gradient;
  gradient.x << G(0, 0), G(1, 0), G(1, 0), G(2, 0);
  gradient.y << G(0, 1), G(1, 1), G(1, 1), G(2, 1);
  return gradient;
}

} // namespace latcon::lattice
