#pragma once

#include "continuum/conditions.h"
#include "continuum/constitution.h"

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace latcon::continuum
{
/// What the sheet does at one reference point.
struct PointState
{
  dealii::Point<2> X;                ///< [m], reference
  dealii::Tensor<1, 2> displacement; ///< u_i = x_i - X_i [m]
  dealii::Tensor<2, 2> F;            ///< F_iJ = delta_iJ + du_i/dX_J [-]
  dealii::Tensor<3, 2> G;            ///< G_iJK = dF_iJ/dX_K [1/m]
  dealii::Tensor<2, 2> P;            ///< P_iJ = d(W + W_g)/dF_iJ [Pa]
  dealii::Tensor<3, 2> Q;            ///< double stress Q_iJK = dW_g/dG_iJK [Pa m]
  double energy_density;             ///< W + W_g [J/m^3], reference volume
};

/// Smallest and largest det F (in-plane) over the quadrature points.
struct DeterminantRange
{
  double smallest;
  double largest;
};

/// A sheet on a mesh, discretised with continuous Lagrange elements of degree p: the stored energy
///   E(u) = integral of W(F) + W_g(F, Grad F) dX + terms on the faces between cells    [J/m, per reference thickness]
/// (theory-continuum.md, eq. (C.28)) with its first and second derivatives by the nodal displacements. The elements are
/// continuous and their gradients are not, so a gradient law brings an interior penalty; without one the face terms are
/// absent. It holds no state: each function takes the nodal vector u [m] it is to look at, with ghost entries
/// (Sheet::make_ghosted), and the load factor [-] that multiplies what is prescribed.
///
/// All functions are collective. When the state is non-physical at a quadrature point of one rank, every rank
/// throws NonPhysicalState.
class Sheet
{
public:
  using Vector = dealii::TrilinosWrappers::MPI::Vector;
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;
  using Mesh = dealii::parallel::distributed::Triangulation<2>;

  /// `mesh` and the laws must outlive the sheet; `degree` p >= 1 is that of the elements, p >= 2 with a gradient law.
  /// Throws InvalidInput for what cannot be: a boundary that the mesh does not have, a field of other than two
  /// components, a condition that needs a gradient law and finds none.
  Sheet(const Mesh &mesh, const Constitution &constitution, unsigned int degree,
        BoundaryConditions conditions = BoundaryConditions());

  /// The same sheet on another mesh of the same domain.
  std::unique_ptr<Sheet> on(const Mesh &mesh) const;

  /// Numbers the unknowns anew, to be called when the mesh has changed. Vectors made before are no longer of use.
  void distribute();

  /// Sum over all ranks of E [J/m]. Dead loads are not in it.
  double energy(const Vector &u, double load_factor = 1.) const;

  /// r_i = dE/du_i [N/m] for every degree of freedom, held ones too (theory-continuum.md, eq. (C.29), without gradient
  /// law eq. (C.16)), and in `magnitude` the sum of the absolute values that were added up to get it [N/m], which
  /// bounds its round-off. Returns E as energy() does, at no further cost.
  double residual(const Vector &u, Vector &r, Vector &magnitude, double load_factor = 1.) const;

  /// K_ij = d2E/du_i du_j [N/m^2] (theory-continuum.md, eq. (C.30), without gradient law eq. (C.17)), condensed by
  /// `constraints`; if `lift` g [m] is given, also the product K g [N/m] with the uncondensed matrix.
  void tangent(const Vector &u, const dealii::AffineConstraints<double> &constraints, Matrix &K,
               double load_factor = 1., const Vector *lift = nullptr, Vector *stiffness_times_lift = nullptr) const;

  /// Nodal forces [N/m] of the dead loads at load factor 1: tractions, double tractions, body force.
  Vector loads() const;

  /// Nodal displacements [m] that the conditions prescribe at load factor 1, zero where nothing is held, without ghost
  /// entries. Where boundaries meet and disagree, the first in the list holds the common node.
  Vector lift() const;

  /// M_ab = integral of density [kg/m^3] * (phi_a phi_b + inertia_length^2 [m^2] Grad phi_a . Grad phi_b) dX [kg/m per
  /// thickness], condensed: consistent mass with micro-inertia.
  void mass(double density, double inertia_length, const dealii::AffineConstraints<double> &constraints,
            Matrix &M) const;

  /// Gives `matrix` the entries that `tangent` needs, all zero.
  void make_matrix(const dealii::AffineConstraints<double> &constraints, Matrix &matrix) const;

  /// States at reference points [m]: the same list on every rank, and the whole answer on every rank. F and G on a
  /// cell boundary are the mean over the cells that meet there, whatever the partition. Throws InvalidInput
  /// if a point is farther outside the mesh than 1e-8 of a cell.
  std::vector<PointState> evaluate(const Vector &u, const std::vector<dealii::Point<2>> &points) const;

  /// Range of det F over all quadrature points. Does not throw for det F <= 0.
  DeterminantRange determinant_range(const Vector &u) const;

  /// Calls `visit` with each displacement unknown that this rank owns, its component i (0 or 1), and the place X of its
  /// node [m, reference]: cell by cell, so with a node that several own cells share several times.
  void for_each_owned_dof(
    const std::function<void(dealii::types::global_dof_index, unsigned int, const dealii::Point<2> &)> &visit) const;

  Vector make_owned() const;   ///< a zero vector without ghost entries, to write to
  Vector make_ghosted() const; ///< a zero vector with ghost entries, to read from

  const Mesh &mesh() const { return mesh_; }
  const Constitution &constitution() const { return constitution_; }
  const BoundaryConditions &conditions() const { return conditions_; }
  const dealii::FESystem<2> &element() const { return element_; }
  const dealii::DoFHandler<2> &dof_handler() const { return dof_handler_; }
  const dealii::MappingQ<2> &mapping() const { return mapping_; }
  /// What makes the displacement one field: hanging nodes and periodic edges (see shared_constraints).
  const dealii::AffineConstraints<double> &conformity_constraints() const { return conformity_constraints_; }
  /// Whether there is a gradient energy, and with it face terms.
  bool has_gradient() const { return constitution_.has_gradient(); }
  /// Penalty [Pa m] on faces that are `extent` [m] of a cell away from the next: gamma p (p + 1) / h * stiffness.
  double penalty(double extent) const;
  const dealii::IndexSet &owned() const { return owned_; }
  const dealii::IndexSet &relevant() const { return relevant_; }
  unsigned int degree() const { return degree_; }
  MPI_Comm communicator() const { return mesh_.get_communicator(); }

private:
  using Cell = Mesh::active_cell_iterator;
  struct PointsInCell
  {
    std::vector<std::size_t> indices;          // in the list asked for
    std::vector<dealii::Point<2>> unit_points; // on the reference cell
  };

  void check_input() const;

  // Own cells that hold any of the points. Local.
  std::map<Cell, PointsInCell> locate(const std::vector<dealii::Point<2>> &points) const;

  const Mesh &mesh_;
  Constitution constitution_;
  BoundaryConditions conditions_;
  unsigned int degree_;
  double normal_stiffness_; // of the gradient law [Pa m^2]; 0 for none
  dealii::FESystem<2> element_;
  dealii::MappingQ<2> mapping_;
  dealii::DoFHandler<2> dof_handler_;
  dealii::IndexSet owned_;
  dealii::IndexSet relevant_;
  dealii::AffineConstraints<double> conformity_constraints_;
};
} // namespace latcon::continuum
