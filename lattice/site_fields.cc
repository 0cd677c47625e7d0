#include "lattice/site_fields.h"

#include <cmath>

#include <Eigen/LU>

namespace lattice
{

SiteFields site_fields(const State &state, const TriangularLattice &lattice, const Material &material)
{
  const std::size_t n = lattice.n_places();
  const Eigen::Matrix2d zero = Eigen::Matrix2d::Zero();
  SiteFields fields;
  fields.strain_energy_density.assign(n, 0.);
  fields.damage.assign(n, 0.);
  fields.first_piola_stress.assign(n, zero);
  fields.cauchy_stress.assign(n, zero);
  fields.deformation_gradient.assign(n, zero);

  // Normal equations of the fit of F: F (sum R R^T) = sum r R^T.
  TensorField reference_moment(n, zero);
  TensorField mixed_moment(n, zero);

  for_each_bond(state, lattice,
                [&](std::size_t near, std::size_t kind, std::size_t far)
                {
                  const Shell &shell = *material.shell(kind);
                  const double rest_length = lattice.rest_length(kind);
                  const double section = cross_section(shell, lattice);
                  const Eigen::Vector2d reference = lattice.bond_vector(kind);
                  const Eigen::Vector2d bond(state.x[far] - state.x[near], state.y[far] - state.y[near]);
                  const Eigen::Vector2d rate(state.vx[far] - state.vx[near], state.vy[far] - state.vy[near]);
                  const double bond_stretch = stretch(state, lattice, near, kind);
                  const Eigen::Vector2d direction = bond.normalized();
                  const double axial =
                    section * (force(shell.law, bond_stretch) + shell.viscosity * rate.dot(direction) / rest_length);
                  const double half_energy = 0.5 * section * rest_length * energy(shell.law, bond_stretch);
                  const Eigen::Matrix2d half_virial = 0.5 * axial * direction * reference.transpose();
                  for (const std::size_t end : {near, lattice.home(far)})
                  {
                    fields.strain_energy_density[end] += half_energy;
                    fields.first_piola_stress[end] += half_virial;
                    reference_moment[end] += reference * reference.transpose();
                    mixed_moment[end] += bond * reference.transpose();
                  }
                });

  const double area = lattice.site_area();
  for (std::size_t row = 0; row < lattice.rows(); ++row)
    for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice.index(row, column);
      unsigned int bonds = 0;
      for_each_bond_of_site(state, lattice, place, [&](std::size_t, std::size_t) { ++bonds; });
      fields.strain_energy_density[place] /= area;
      fields.first_piola_stress[place] /= area;
      if (bonds + state.lost_bonds[place] > 0)
        fields.damage[place] = static_cast<double>(state.lost_bonds[place]) / (bonds + state.lost_bonds[place]);

      Eigen::Matrix2d &F = fields.deformation_gradient[place];
      const Eigen::Matrix2d &moment = reference_moment[place];
      // Bonds along one line leave the moment singular; d^4 is the scale of its determinant.
      const double d2 = lattice.spacing() * lattice.spacing();
      const bool fixed = moment.determinant() > 1e-6 * d2 * d2;
      F = fixed ? Eigen::Matrix2d(mixed_moment[place] * moment.inverse()) : Eigen::Matrix2d::Identity();
      if (fixed && F.determinant() > 0.)
        fields.cauchy_stress[place] = fields.first_piola_stress[place] * F.transpose() / F.determinant();
    }
  return fields;
}

} // namespace lattice
