#include "lattice/site_fields.h"

#include <cmath>

#include <Eigen/LU>

namespace latcon::lattice
{
namespace
{

// Overstress of a bond as of the last update of its memory [Pa]. @param step over no time
double overstress(const MemoryStep &step, const BondHistory &history, std::size_t place, std::size_t kind)
{
  auto variables = history.variables_of(place, kind);
  std::array<double, max_history_variables> dissipation{};
  const double stretch = history.kinds[kind].stretch[place];
  return advance(step, stretch, stretch, variables.data(), dissipation.data());
}

} // namespace

SiteEvaluator::SiteEvaluator(const TriangularLattice &lattice, const Material &material)
  : lattice_(lattice), material_(material)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (const Shell *shell = material_.in_shell(number))
      at_rest_[number] = memory_step(shell->memory, 0.);
}

SiteValues SiteEvaluator::at(const State &state, std::size_t place) const
{
  SiteValues values;
  // Normal equations of the fit of F: F (sum R R^T) = sum r R^T.
  Eigen::Matrix2d reference_moment = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d mixed_moment = Eigen::Matrix2d::Zero();
  for_each_bond_of_site(state, lattice_, place,
                        [&](const Bond &bond)
                        {
                          const auto [near, kind, far] = bond;
                          const Shell &shell = *material_.shell(lattice_, kind);
                          const Eigen::Vector2d r(state.x[far] - state.x[near], state.y[far] - state.y[near]);
                          const Eigen::Vector2d rate(state.vx[far] - state.vx[near], state.vy[far] - state.vy[near]);
                          const double length = r.norm(), ratio = lattice_.length_ratio(near, kind);
                          const Eigen::Vector2d direction = r / length, R = lattice_.bond_vector(bond);
                          const double rest_length = lattice_.rest_length(kind) / ratio, stretch = length / rest_length;
                          const double section =
                            state.stiffness.of(near, kind) * ratio * cross_section(shell, lattice_, kind);
                          double axial =
                            section * (force(shell.law, stretch) + shell.viscosity * rate.dot(direction) / rest_length);
                          if (state.history.remembers(kind))
                            axial += section * overstress(at_rest_[lattice_.shell(kind)], state.history, near, kind);
                          ++values.bonds;
                          values.strain_energy_density += 0.5 * section * rest_length * energy(shell.law, stretch);
                          values.first_piola_stress += 0.5 * axial * direction * R.transpose();
                          reference_moment += R * R.transpose();
                          mixed_moment += r * R.transpose();
                        });

  const double area = lattice_.site_area();
  values.strain_energy_density /= area;
  values.first_piola_stress /= area;
  if (values.bonds + state.lost_bonds[place] > 0)
    values.damage = static_cast<double>(state.lost_bonds[place]) / (values.bonds + state.lost_bonds[place]);

  // Bonds along one line leave the moment singular; d^4 is the scale of its determinant.
  const double d2 = lattice_.spacing() * lattice_.spacing();
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
  const SiteEvaluator evaluator(lattice, material);
  for (std::size_t row = 0; row < lattice.rows(); ++row)
    for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
      fields[lattice.index(row, column)] = evaluator.at(state, lattice.index(row, column));
  return fields;
}

} // namespace latcon::lattice
