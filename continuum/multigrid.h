#pragma once

#include "continuum/homogeneous_constraints.h"
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

/// Assembles a tangent [N/m^2] of a sheet at the nodal vector `u` [m] (with ghost entries), condensed by `constraints`,
/// into K, which may be in either precision. Throws NonPhysicalState on every rank if the state is non-physical.
class Assembler
{
public:
  Assembler() = default;
  /// From a function with a generic parameter for K.
  template <class Function>
  Assembler(const Function &function) : double_(function), single_(function)
  {
  }
  void operator()(const Sheet &sheet, const Sheet::Vector &u, const dealii::AffineConstraints<double> &constraints,
                  Sheet::Matrix &K) const
  {
    double_(sheet, u, constraints, K);
  }
  void operator()(const Sheet &sheet, const Sheet::Vector &u, const dealii::AffineConstraints<double> &constraints,
                  SinglePrecisionMatrix &K) const
  {
    single_(sheet, u, constraints, K);
  }

private:
  template <class AnyMatrix>
  using Function =
    std::function<void(const Sheet &, const Sheet::Vector &, const dealii::AffineConstraints<double> &, AnyMatrix &)>;

  Function<Sheet::Matrix> double_;
  Function<SinglePrecisionMatrix> single_;
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
  /// multigrid, and its mesh must not change. `held` are the components with prescribed displacement. A level of at
  /// most `coarsest_size` unknowns is solved directly, as is a mesh that cannot be coarsened further.
  Multigrid(const Sheet &fine, const DirichletBoundaries &held, dealii::types::global_dof_index coarsest_size);
  ~Multigrid();
  Multigrid(const Multigrid &) = delete;
  Multigrid &operator=(const Multigrid &) = delete;

  /// Assembles the tangents of the coarser levels at the state `u` [m] (with ghost entries); where the finest level is
  /// the coarsest, its own. If the interpolated state is non-physical on a level, it is halved repeatedly and finally
  /// set to zero, which makes the preconditioner less effective without affecting the solution. Throws
  /// LinearSolverFailed if the coarsest tangent is singular.
  void update(const Sheet::Vector &u, const Assembler &assemble);

  /// Sets the tangent of the finest level, condensed by constraints(), which must outlive its use. Has no effect where
  /// the finest level is the coarsest.
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

  /// Returns the constraints of the finest mesh: hanging nodes, and prescribed degrees of freedom at zero.
  const dealii::AffineConstraints<double> &constraints() const;

  /// Statistics of a level, for reports and tests.
  struct LevelFacts
  {
    dealii::types::global_dof_index n_unknowns;
    double state_factor;             ///< fraction of the interpolated state at which the tangent was assembled [-]
    unsigned int n_replaced_patches; ///< patches whose block was not positive definite
  };
  /// Returns the statistics of the last update() and set_finest(), from the coarsest to the finest level.
  std::vector<LevelFacts> levels() const;

private:
  struct Level;

  void set_tangent(unsigned int level, const SinglePrecisionMatrix &K);
  void cycle(unsigned int level, Vector &z, const Vector &r) const;

  std::vector<std::unique_ptr<Level>> levels_; // from the coarsest to the finest
  std::unique_ptr<DirectSolver> coarsest_;
};
} // namespace latcon::continuum
