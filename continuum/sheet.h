#pragma once

#include "continuum/material.h"

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <map>
#include <vector>

namespace continuum
{
/// What the sheet does at one reference point.
struct PointState
{
  dealii::Point<2> X;                ///< [m], reference
  dealii::Tensor<1, 2> displacement; ///< u_i = x_i - X_i [m]
  dealii::Tensor<2, 2> F;            ///< F_iJ = delta_iJ + du_i/dX_J [-]
  dealii::Tensor<2, 2> P;            ///< P_iJ(F) [Pa]
  double energy_density;             ///< W(F) [J/m^3], reference volume
};

/// Smallest and largest det F (in-plane) over the quadrature points.
struct DeterminantRange
{
  double smallest;
  double largest;
};

/// A sheet of one material on a mesh, discretised with continuous Lagrange elements: the functional
///   E(u) = integral of W(I + Grad u) dX    [J/m, per unit reference thickness]      (theory-continuum.md, eq. (C.15))
/// with its first and second derivatives by the nodal displacements. It holds no state: each function takes the nodal
/// vector u [m] it is to look at, with ghost entries (Sheet::make_ghosted).
///
/// All functions are collective. When the state is non-physical at a quadrature point of one rank, every rank
/// throws NonPhysicalState.
class Sheet
{
public:
  using Vector = dealii::TrilinosWrappers::MPI::Vector;
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  /// `mesh` and `law` must outlive the sheet; `degree` p >= 1 is that of the elements.
  Sheet(const dealii::parallel::distributed::Triangulation<2> &mesh, const Material &law, unsigned int degree);

  /// Sum over all ranks of E [J/m].
  double energy(const Vector &u) const;

  /// r_i = dE/du_i [N/m] for every degree of freedom, held ones too (theory-continuum.md, eq. (C.16)), and in
  /// `magnitude` the sum of the absolute values that were added up to get it [N/m], which bounds its round-off.
  void residual(const Vector &u, Vector &r, Vector &magnitude) const;

  /// K_ij = d2E/du_i du_j [N/m^2] (theory-continuum.md, eq. (C.17)), condensed by `constraints`; and in
  /// `stiffness_times_lift` the product K g [N/m] with the uncondensed matrix, for the nodal vector `lift` g [m].
  void tangent(const Vector &u, const dealii::AffineConstraints<double> &constraints, Matrix &K, const Vector &lift,
               Vector &stiffness_times_lift) const;

  /// States at reference points [m]: the same list on every rank, and the whole answer on every rank. F on a cell
  /// boundary is the mean over the cells that meet there, whatever the partition. Throws InvalidInput
  /// if a point is farther outside the mesh than 1e-8 of a cell.
  std::vector<PointState> evaluate(const Vector &u, const std::vector<dealii::Point<2>> &points) const;

  /// Range of det F over all quadrature points. Does not throw for det F <= 0.
  DeterminantRange determinant_range(const Vector &u) const;

  Vector make_owned() const;   ///< a zero vector without ghost entries, to write to
  Vector make_ghosted() const; ///< a zero vector with ghost entries, to read from

  const dealii::parallel::distributed::Triangulation<2> &mesh() const { return mesh_; }
  const Material &law() const { return law_; }
  const dealii::FESystem<2> &element() const { return element_; }
  const dealii::DoFHandler<2> &dof_handler() const { return dof_handler_; }
  const dealii::MappingQ<2> &mapping() const { return mapping_; }
  const dealii::AffineConstraints<double> &hanging_nodes() const { return hanging_nodes_; }
  const dealii::IndexSet &owned() const { return owned_; }
  const dealii::IndexSet &relevant() const { return relevant_; }
  unsigned int degree() const { return degree_; }
  MPI_Comm communicator() const { return mesh_.get_communicator(); }

private:
  using Cell = dealii::parallel::distributed::Triangulation<2>::active_cell_iterator;
  struct PointsInCell
  {
    std::vector<std::size_t> indices;          // in the list asked for
    std::vector<dealii::Point<2>> unit_points; // on the reference cell
  };

  // Own cells that hold any of the points. Local.
  std::map<Cell, PointsInCell> locate(const std::vector<dealii::Point<2>> &points) const;

  const dealii::parallel::distributed::Triangulation<2> &mesh_;
  const Material &law_;
  unsigned int degree_;
  dealii::FESystem<2> element_;
  dealii::MappingQ<2> mapping_;
  dealii::DoFHandler<2> dof_handler_;
  dealii::IndexSet owned_;
  dealii::IndexSet relevant_;
  dealii::AffineConstraints<double> hanging_nodes_;
};
} // namespace continuum
