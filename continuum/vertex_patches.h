#pragma once

#include "continuum/sheet.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

class Epetra_Map;

namespace latcon::continuum
{
/// Additive Schwarz over the stars of the vertices of a mesh: z = sum over patches p of R_p^T (R_p K R_p^T)^{-1} R_p r,
/// where R_p picks the free degrees of freedom, both components, whose shape functions vanish outside the star of a
/// vertex: on the vertex, on the lines that end there and inside the cells around it.
///
/// Around hanging nodes, too, the star is the support of the continuous bilinear hat function of the vertex: if one of
/// the lines is the side of a larger cell and halved on the other side, then both of the smaller cells there belong to
/// the star, with the line between them. Hanging vertices have no hat function and no patch. Thus every free degree of
/// freedom is in a patch, and the largest eigenvalue is the same as on uniform meshes. The inverses are kept in single
/// precision, which is enough for a smoother, and applied in double.
///
/// The operator is symmetric positive definite on vectors that vanish at constrained degrees of freedom, and the same
/// for every partition of the mesh, rounding apart. Every vector must have the layout of layout().
class VertexPatches : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using Layout = dealii::Utilities::MPI::Partitioner;

  /// Lists the patches. `constraints` tells which of the relevant degrees of freedom are free. Collective.
  VertexPatches(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints);
  ~VertexPatches();

  /// Inverts the blocks of the condensed tangent K [N/m^2]. A block that is not safely positive definite (the tangent
  /// at an unstable state) is replaced by the diagonal of its absolute row sums, which is, and which bounds it.
  /// Collective.
  void factorise(const Sheet::Matrix &K);

  /// z [m] from r [N/m]. Collective.
  void vmult(Vector &z, const Vector &r) const;

  /// Blocks on all ranks that were replaced by their row sums in the last factorisation. Collective.
  unsigned int n_replaced() const;

  /// The owned degrees of freedom of the sheet and, as ghosts, the relevant ones and those of own patches.
  const std::shared_ptr<const Layout> &layout() const { return layout_; }

private:
  std::shared_ptr<const Layout> layout_;
  std::vector<unsigned int> dofs_;       // of all patches, one after the other, as positions in the layout
  std::vector<std::size_t> first_dof_;   // of each patch in dofs_, and the end
  std::vector<std::size_t> first_entry_; // of each patch in inverses_, and the end
  std::size_t largest_patch_ = 0;
  std::vector<float> inverses_;            // of all patches: lower triangle of blocks of 4 by 4, see multiply
  std::unique_ptr<Epetra_Map> ghost_rows_; // rows of K that patches need and other ranks own
  unsigned int own_replaced_ = 0;
};
} // namespace latcon::continuum
