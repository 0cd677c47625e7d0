#pragma once

#include "continuum/sheet.h"
#include "continuum/single_precision_matrix.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace latcon::continuum
{
class DirectSolver;

/// Assembles a tangent [N/m^2] of a sheet at the nodal vector `u` [m] (with ghost entries), condensed by its
/// homogeneous_constraints(), into K. Throws NonPhysicalState on every rank if the state is non-physical.
template <class AnyMatrix>
using AssemblerOf = std::function<void(const Sheet &sheet, const Sheet::Vector &u, AnyMatrix &K)>;

/// Does so for K in either precision.
struct Assembler : AssemblerOf<Sheet::Matrix>, AssemblerOf<SinglePrecisionMatrix>
{
  Assembler() = default;
  /// From a function with a generic parameter for K.
  template <class Function>
  Assembler(const Function &function)
    : AssemblerOf<Sheet::Matrix>(function), AssemblerOf<SinglePrecisionMatrix>(function)
  {
  }
  using AssemblerOf<Sheet::Matrix>::operator();
  using AssemblerOf<SinglePrecisionMatrix>::operator();
};

/// Preconditioner for the tangent of a sheet: one V-cycle of geometric multigrid with global coarsening. Each level has
/// a Sheet on a mesh that is coarsened everywhere by one refinement, including its hanging nodes. The tangent is
/// assembled on each level at the interpolated state. The smoother is a Chebyshev polynomial over VertexPatches, and
/// the coarsest level is solved directly, in double precision.
///
/// The cycle is symmetric, and positive definite if the tangents are. Vectors vanish at constrained degrees of freedom,
/// which are those at hanging nodes and those with prescribed displacement. Results are reproducible bit for bit on the
/// same number of ranks.
///
/// All functions are collective. Every exception is thrown on every rank.
class Multigrid
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  /// Builds the parts that depend only on the mesh: levels, transfers, sparsity, patches. `fine` must outlive the
  /// multigrid, and its mesh must not change. A level of at most `coarsest_size` unknowns is solved directly, as is a
  /// mesh that cannot be coarsened further.
  Multigrid(const Sheet &fine, dealii::types::global_dof_index coarsest_size);
  ~Multigrid();
  Multigrid(const Multigrid &) = delete;
  Multigrid &operator=(const Multigrid &) = delete;

  /// Assembles the tangents of the coarser levels at the state `u` [m] (with ghost entries); where the finest level is
  /// the coarsest, its own. If the interpolated state is non-physical on a level, it is halved repeatedly and finally
  /// set to zero, which makes the preconditioner less effective without affecting the solution. Throws
  /// LinearSolverFailed if the coarsest tangent is singular.
  void update(const Sheet::Vector &u, const Assembler &assemble);

  /// Sets the tangent of the finest level, which must outlive its use. Has no effect where the finest level is the
  /// coarsest.
  void set_finest(const SinglePrecisionMatrix &K);

  /// Applies the preconditioner: computes z [m] from r [N/m], both with the layout set by initialize().
  void vmult(Vector &z, const Vector &r) const;

  /// Makes `v` a zero vector with the layout that vmult() expects.
  void initialize(Vector &v) const;
  /// Copies the owned entries of a vector without ghost entries to one of the other type.
  template <class From, class To>
  static void copy(const From &from, To &to)
  {
    std::copy(from.begin(), from.end(), to.begin());
  }

private:
  struct Level;

  void set_tangent(unsigned int level, const SinglePrecisionMatrix &K);
  void cycle(unsigned int level, Vector &z, const Vector &r) const;

  std::vector<std::unique_ptr<Level>> levels_; // from the coarsest to the finest
  std::unique_ptr<DirectSolver> coarsest_;
};
} // namespace latcon::continuum
