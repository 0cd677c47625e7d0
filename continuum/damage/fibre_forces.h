#pragma once

#include "continuum/damage/row_bands.h"
#include "continuum/fibres.h"
#include "continuum/viscosity.h"

#include <array>
#include <vector>

namespace latcon::continuum
{
/// Nodal values of a vector field on a grid, one array per component.
using GridVector = std::array<std::vector<double>, 2>;

/// Fibre or dashpot, or both, in one reference direction.
struct DampedFibre
{
  double X, Y;    ///< unit vector [-]
  double a, b, e; ///< weight times constants of RodPotential and LinearPotential [Pa]
  double eta;     ///< weight times viscosity [Pa s]
};

/// Returns fibres that span all directions like those of IsotropicNetwork, as `n` >= 6 equally spaced ones for each
/// family: the error is ((p - q) / (p + q))^n at principal stretches p > q.
std::vector<FibreFamily> in_all_directions(const std::vector<FibreFamily> &families, unsigned int n);
/// Returns dashpots in all directions; see above.
std::vector<FibreDashpot> in_all_directions(const std::vector<FibreDashpot> &dashpots, unsigned int n);

/// Nodal forces, energies and dissipation of bilinear elements (2 x 2 Gauss points) of a grid, for CauchyBorn and
/// FibreViscosity with the deformation gradient F = F_0 + Grad u (theory-continuum.md, eqs. (C.11), (C.41);
/// theory-damage.md, eq. (C.71)).
///
/// Unlike CauchyBorn, a fibre shorter than min_stretch keeps the force it has there, and a cell may be inverted: both
/// happen in cells that are broken. In cells with a factor above sound_factor they are errors.
///
/// Ranks and their threads share the rows of cells; results do not depend on the numbers of either. All ranks have all
/// arguments and all results.
class FibreForces
{
public:
  /// Creates the forces of fibres and dashpots; `dashpots` may be empty. Throws InvalidMaterial as CauchyBorn and
  /// FibreViscosity do, and InvalidInput for custom potentials, which are not supported.
  FibreForces(const NodeGrid &grid, const std::vector<FibreFamily> &families, const std::vector<FibreDashpot> &dashpots,
              const dealii::Tensor<2, 2> &loading, MPI_Comm communicator = MPI_COMM_SELF);

  /// Computes the forces -sum over cells of g_c d(E_c)/du - viscous ones [N/m] for displacement u [m], velocity v [m/s]
  /// and factors g_c. Returns the dissipated power [W/m]. Collective.
  double forces(const GridVector &u, const GridVector &v, const std::vector<double> &factors, GridVector &force) const;

  /// Computes the energies E_c [J/m] of the undegraded cells. Throws NonPhysicalState, with the position, if a cell
  /// with g_c > sound_factor is inverted or has a fibre shorter than min_stretch. Collective; all ranks throw, or none.
  void energies(const GridVector &u, const std::vector<double> &factors, std::vector<double> &cell_energies) const;

  /// Returns an upper bound [1/s] of the eigenvalues of the viscous forces over the mass, for cells of `density`
  /// [kg/m^3] and any deformation and damage, eq. (C.72).
  double viscous_rate(double density) const;

  /// Returns an upper bound [1/s] of the angular frequencies of the elastic cells with elastic_conductivity(), for any
  /// damage.
  double elastic_frequency(double density) const;

  /// Returns the tensor D of eq. (C.72), entries XX, XY, YY [Pa s].
  std::array<double, 3> viscous_conductivity() const;
  /// Returns the corresponding bound of the stiffness against Grad u [Pa] at F_0, or, if that is more, of fibres that
  /// have shortened to relaxed_stretch, as a crack lets them.
  std::array<double, 3> elastic_conductivity() const;

  const NodeGrid &grid() const { return grid_; }

  static constexpr double min_stretch = 0.25;
  static constexpr double sound_factor = 0.5;
  /// Stretch of fibres across a sheet that relaxes behind a crack while it is held along the crack: rubber fibres at
  /// the stretches of the standard sheet reach 0.77.
  static constexpr double relaxed_stretch = 0.75;
  /// Fewer cells are visited by one thread: synchronisation would cost more than other threads save.
  static constexpr std::size_t min_cells_for_threads = 5000;

private:
  template <bool is_force>
  struct Row;
  template <bool is_force>
  void visit(const Row<is_force> &row) const;
  double largest_eigenvalue(const std::array<double, 3> &conductivity) const;
  DampedFibre &fibre_along(const dealii::Tensor<1, 2> &direction);

  NodeGrid grid_;
  RowBands bands_;
  dealii::Tensor<2, 2> loading_;
  std::vector<DampedFibre> fibres_;
};
} // namespace latcon::continuum
