#pragma once

#include "continuum/single_precision_matrix.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

namespace latcon::continuum
{
/// Additive Schwarz over the stars of the vertices of a mesh: z = sum over patches p of R_p^T (R_p K R_p^T)^{-1} R_p r,
/// where R_p picks the free degrees of freedom, both components, whose shape functions vanish outside the star of a
/// vertex: on the vertex, on the lines that end there and inside the cells around it.
///
/// Near hanging nodes the star is likewise the support of the continuous bilinear hat function of the vertex: if one of
/// the lines is a side of a larger cell and is halved on the other side, both smaller cells there and the line between
/// them belong to the star. Hanging vertices have no hat function and no patch. Thus every free degree of freedom is in
/// a patch, and the largest eigenvalue is the same as on uniform meshes. The inverses are stored in single precision,
/// which is sufficient for a smoother, and applied in double precision.
///
/// The operator is symmetric positive definite on vectors that vanish at constrained degrees of freedom, and up to
/// rounding independent of the partition of the mesh. Every vector must have the layout of layout().
class VertexPatches : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using Layout = dealii::Utilities::MPI::Partitioner;

  /// Builds the list of patches. Relevant degrees of freedom that `constraints` do not constrain are free. Collective.
  VertexPatches(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints);

  /// Inverts the blocks of the condensed tangent K [N/m^2]. A block that is not numerically positive definite (at an
  /// unstable state) is replaced by the diagonal of its absolute row sums, which is positive definite and bounds the
  /// block. Collective.
  void factorise(const SinglePrecisionMatrix &K);

  /// Computes z [m] from r [N/m]. Collective.
  void vmult(Vector &z, const Vector &r) const;

  /// Layout of vectors: the owned degrees of freedom of the sheet and, as ghosts, the relevant ones and those of the
  /// patches of this rank.
  const std::shared_ptr<const Layout> &layout() const { return layout_; }

private:
  std::shared_ptr<const Layout> layout_;
  std::vector<unsigned int> dofs_;       // of all patches, one after the other, as positions in the layout
  std::vector<std::size_t> first_dof_;   // of each patch in dofs_, and the end
  std::vector<std::size_t> first_entry_; // of each patch in inverses_, and the end
  std::size_t largest_patch_ = 0;
  std::vector<float> inverses_; // of all patches: lower triangle of blocks of 4 by 4, see multiply
};
} // namespace latcon::continuum
