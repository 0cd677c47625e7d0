#pragma once

#include "continuum/sheet.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

class Epetra_Map;

namespace continuum
{
/// Additive Schwarz over the stars of the vertices of a mesh: z = sum over patches p of R_p^T (R_p K R_p^T)^{-1} R_p r,
/// where R_p picks the free degrees of freedom on a vertex, on the lines that end there and inside the cells around it,
/// both components. At a hanging vertex the larger cell, whose side it halves, counts among the cells around it, and
/// that side among the lines. Every free degree of freedom is in at least one patch.
///
/// The operator is symmetric positive definite on vectors that vanish at constrained degrees of freedom, and the same
/// for every partition of the mesh, rounding apart. Every vector must have the layout of `layout`.
class VertexPatches : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using Layout = dealii::Utilities::MPI::Partitioner;

  /// Lists the patches. `constraints` tells which degrees of freedom are free. `layout` holds the owned degrees of
  /// freedom of the sheet and, as ghosts, the other relevant ones. Collective.
  VertexPatches(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints,
                std::shared_ptr<const Layout> layout);
  ~VertexPatches();

  /// Inverts the blocks of the condensed tangent K [N/m^2]. A block that is not safely positive definite (the tangent
  /// at an unstable state) is replaced by the diagonal of its absolute row sums, which is, and which bounds it.
  /// Collective.
  void factorise(const Sheet::Matrix &K);

  /// z [m] from r [N/m]. Collective.
  void vmult(Vector &z, const Vector &r) const;

  /// Blocks on all ranks that were replaced by their row sums in the last factorisation. Collective.
  unsigned int n_replaced() const;

private:
  void list_patches(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints);

  std::shared_ptr<const Layout> layout_;
  std::vector<unsigned int> dofs_;         // of all patches, one after the other, as positions in the layout
  std::vector<std::size_t> first_dof_;     // of each patch in dofs_, and the end
  std::vector<double> inverses_;           // of all patches: lower triangle, column by column
  std::unique_ptr<Epetra_Map> ghost_rows_; // rows of K that patches need and other ranks own
  unsigned int own_replaced_ = 0;
};
} // namespace continuum
