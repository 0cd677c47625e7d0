#pragma once

#include "continuum/damage/fibre_forces.h"
#include "continuum/lattice_gradient.h"

namespace latcon::continuum
{
/// Gradient energy and micro-inertia of a sheet in motion with damage (theory-damage.md, eqs. (C.75) to (C.81)); waves
/// on it obey (C.82).
struct GradientSetup
{
  /// Bonds whose gradient energy it is, with weights as in FibreForces.
  std::vector<BondFamily> bonds;
  double length; ///< l_d > 0 [m]
  /// False: gradient energy without micro-inertia, which makes short waves faster. For comparison.
  bool has_micro_inertia = true;
};

/// Returns bonds in all directions, for the mean of the gradient energy over them (NetworkGradient); see
/// in_all_directions of fibres.
std::vector<BondFamily> in_all_directions(const std::vector<BondFamily> &bonds, unsigned int n);

/// Nodal forces and energies of LatticeGradient on a grid (theory-damage.md, eqs. (C.75) to (C.77)). The energy of an
/// inner node a is E^g_a = area of a cell times W_g(F_a, G_a), with first and second differences of the displacement on
/// the 3 x 3 nodes around a. Nodes on edges have none.
///
/// Bonds of one direction and one potential are merged, as in NetworkGradient. A bond shorter than
/// FibreForces::relaxed_stretch has the axial stiffness it has there: broken cells would limit the time step otherwise.
///
/// Ranks and their threads share the rows of nodes; results do not depend on the numbers of either. All ranks have all
/// arguments and all results.
class GradientForces
{
public:
  /// Throws InvalidMaterial as LatticeGradient does, where families of one direction and potential have their mean
  /// squared length, and InvalidInput for custom potentials.
  GradientForces(const NodeGrid &grid, const std::vector<BondFamily> &bonds, double length,
                 const dealii::Tensor<2, 2> &loading, MPI_Comm communicator = MPI_COMM_SELF);

  /// Adds the forces -sum over nodes of g_a d(E^g_a)/du [N/m] for displacement u [m] and nodal factors g_a [-].
  /// Collective.
  void add_forces(const GridVector &u, const std::vector<double> &factors, GridVector &force) const;

  /// Computes the energies E^g_a [J/m] of the undegraded nodes, eq. (C.75). Collective.
  void energies(const GridVector &u, std::vector<double> &node_energies) const;

  /// Term stiffness (1/2) (sum over nodes of S_b u_b)^2 of the energy of a patch of 3 x 3 nodes, row by row.
  struct PatchTerm
  {
    std::array<double, 9> S; ///< [1/m^2]
    double stiffness;        ///< [Pa m^2]
  };
  /// Returns the terms that bound the energies of a patch, for either component of u, at F_0 or with bonds that have
  /// shortened to `relaxed` [-].
  std::vector<PatchTerm> patch_terms(double relaxed) const;

  /// Bond family with its two squares of eq. (C.25).
  struct Bond
  {
    double X, Y;          ///< unit vector [-]
    double a, b, e;       ///< weight times constants of the potential [Pa]
    double across, along; ///< l_d^2 and l_d^2 - l^2/12 [m^2]
  };

private:
  template <bool is_force>
  struct Row;
  template <bool is_force>
  void visit(const Row<is_force> &row) const;

  NodeGrid grid_;
  RowBands bands_;
  dealii::Tensor<2, 2> loading_;
  std::vector<Bond> bonds_;
};
} // namespace latcon::continuum
