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
#include <vector>

namespace latcon::continuum
{
class SinglePrecisionMatrix;

/// State of the sheet at one reference point.
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
/// (theory-continuum.md, eq. (C.28)) with its first and second derivatives by the nodal displacements. The displacement
/// is continuous across faces and its gradient is not, so a gradient law adds interior-penalty terms on the faces;
/// without a gradient law there are no face terms. A sheet has no state: functions take the nodal displacement u [m]
/// with ghost entries (Sheet::make_ghosted), and the load factor [-], which multiplies all prescribed values.
///
/// All functions are collective. If the state is non-physical at a quadrature point of any rank, every rank throws
/// NonPhysicalState.
class Sheet
{
public:
  using Vector = dealii::TrilinosWrappers::MPI::Vector;
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;
  using Mesh = dealii::parallel::distributed::Triangulation<2>;

  /// Creates a sheet with elements of `degree` p >= 1, or p >= 2 with a gradient law. `mesh` and the laws must outlive
  /// the sheet. Throws InvalidInput for a degree out of range, a boundary id that the mesh does not have, a field
  /// without exactly two components, and a condition that requires a gradient law if there is none.
  Sheet(const Mesh &mesh, const Constitution &constitution, unsigned int degree,
        BoundaryConditions conditions = BoundaryConditions());

  /// Renumbers the unknowns after a change of the mesh. Existing vectors become invalid.
  void distribute();

  /// Prescribes displacements anew after faces of the mesh got other boundary ids.
  void apply_conditions();

  /// Returns E [J/m], summed over all ranks, without the potential of dead loads.
  double energy(const Vector &u, double load_factor = 1.) const;

  /// Computes r_i = dE/du_i [N/m] for every degree of freedom, constrained ones included (theory-continuum.md, eq.
  /// (C.16), with a gradient law of (C.28)). `magnitude` is the sum of the absolute values of the terms of r [N/m],
  /// which bounds its round-off. Returns E as energy() does, at no additional cost.
  double residual(const Vector &u, Vector &r, Vector &magnitude, double load_factor = 1.) const;

  /// Computes K_ij = d2E/du_i du_j [N/m^2] (theory-continuum.md, eq. (C.17), with a gradient law of (C.28)),
  /// condensed by `constraints`. If `lift` g [m] is given, also computes the product K g [N/m] of the uncondensed
  /// matrix. @tparam AnyMatrix Matrix or SinglePrecisionMatrix
  template <class AnyMatrix>
  void tangent(const Vector &u, const dealii::AffineConstraints<double> &constraints, AnyMatrix &K,
               double load_factor = 1., const Vector *lift = nullptr, Vector *stiffness_times_lift = nullptr) const;

  /// Returns the nodal forces [N/m] of the dead loads at load factor 1: tractions, double tractions, body force.
  Vector loads() const;

  /// Returns the prescribed nodal displacements [m] at load factor 1, zero at free nodes, without ghost entries. At a
  /// node with conflicting conditions the first condition in the list applies.
  Vector lift() const;

  /// Adds to M: M_ab = integral of density [kg/m^3] * (phi_a phi_b + inertia_length^2 [m^2] Grad phi_a . Grad phi_b) dX
  /// [kg/m per thickness], the consistent mass with micro-inertia, condensed by `constraints`.
  /// @tparam AnyMatrix Matrix or SinglePrecisionMatrix
  template <class AnyMatrix>
  void add_mass(double density, double inertia_length, const dealii::AffineConstraints<double> &constraints,
                AnyMatrix &M) const;

  /// Initialises `matrix` with the sparsity that tangent() needs, or only add_mass(), and zero entries.
  void make_matrix(const dealii::AffineConstraints<double> &constraints, Matrix &matrix, bool is_mass = false) const;

  /// Returns the states at reference points [m]. Every rank passes the same points and gets all states. On a cell
  /// boundary, F and G are means over the adjacent cells, independent of the partition. Throws InvalidInput if a
  /// point is outside the mesh by more than 1e-8 of a cell, or not finite.
  std::vector<PointState> evaluate(const Vector &u, const std::vector<dealii::Point<2>> &points) const;

  /// Returns the same without stresses and energy density, of any field with F = I + Grad u.
  std::vector<PointState> gradients(const Vector &u, const std::vector<dealii::Point<2>> &points) const;

  /// Returns the range of det F over all quadrature points. Does not throw for det F <= 0.
  DeterminantRange determinant_range(const Vector &u) const;

  /// Calls `visit(dof, i, X)` for each displacement unknown that this rank owns, with its component i (0 or 1) and the
  /// reference position X [m] of its node. Iterates over cells, so it visits a node once per owned cell that contains
  /// it.
  void for_each_owned_dof(
    const std::function<void(dealii::types::global_dof_index, unsigned int, const dealii::Point<2> &)> &visit) const;

  /// Returns a zero vector without ghost entries, to write to.
  Vector make_owned() const { return Vector(owned_, communicator()); }
  /// Returns a zero vector with ghost entries, to read from.
  Vector make_ghosted() const { return Vector(owned_, relevant_, communicator()); }
  Vector with_ghosts(const Vector &x) const;    ///< returns a copy with ghost entries
  Vector without_ghosts(const Vector &x) const; ///< returns a copy without ghost entries

  const Mesh &mesh() const { return mesh_; }
  double smallest_cell() const { return smallest_cell_; } ///< h, shortest distance of two corners of a cell [m]
  const Constitution &constitution() const { return constitution_; }
  const BoundaryConditions &conditions() const { return conditions_; }
  const dealii::FESystem<2> &element() const { return element_; }
  const dealii::DoFHandler<2> &dof_handler() const { return dof_handler_; }
  const dealii::MappingQ<2> &mapping() const { return mapping_; }
  /// Closed constraints of every relevant unknown at hanging nodes and periodic edges, as known to the owner of the
  /// unknown. A relevant unknown may depend on one that is not relevant, so each rank must be able to write to all rows
  /// of get_local_lines() of a condensed matrix.
  const dealii::AffineConstraints<double> &conformity_constraints() const { return conformity_constraints_; }
  /// The same together with zero for unknowns whose displacement is prescribed.
  const dealii::AffineConstraints<double> &homogeneous_constraints() const { return homogeneous_constraints_; }
  /// Returns whether the displacement of a relevant unknown is prescribed.
  bool is_prescribed(const dealii::types::global_dof_index i) const
  {
    return homogeneous_constraints_.is_constrained(i) && !conformity_constraints_.is_constrained(i);
  }
  /// Returns true if there is a gradient energy, and hence face terms.
  bool has_gradient() const { return constitution_.has_gradient(); }
  /// Returns the penalty [Pa m] gamma p (p + 1) / h times the normal stiffness of the gradient law on a face of a cell
  /// that extends h = `extent` [m] normal to it, eq. (C.28).
  double penalty(double extent) const;
  const dealii::IndexSet &owned() const { return owned_; }
  const dealii::IndexSet &relevant() const { return relevant_; }
  unsigned int degree() const { return degree_; }
  MPI_Comm communicator() const { return mesh_.get_communicator(); }

private:
  void check_input() const;

  const Mesh &mesh_;
  double smallest_cell_ = 0.;
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
  dealii::AffineConstraints<double> homogeneous_constraints_;
};
} // namespace latcon::continuum
