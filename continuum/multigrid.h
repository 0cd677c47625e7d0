#pragma once

#include "continuum/homogeneous_constraints.h"
#include "continuum/sheet.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <functional>
#include <memory>
#include <vector>

namespace latcon::continuum
{
class DirectSolver;

/// How the multigrid cycle is set up.
struct MultigridSettings
{
  /// Of the Chebyshev polynomial on the finest level, before and after the coarse correction, >= 1; it doubles from
  /// level to level, up to 16 times.
  unsigned int smoothing_degree = 2;
  double smoothing_range = 6.;             ///< largest eigenvalue over the smallest that is smoothed [-], > 1
  unsigned int eigenvalue_iterations = 10; ///< of the Lanczos process that estimates the largest eigenvalue, >= 2
  /// Number of unknowns below which a level is coarse enough to be solved directly. A mesh that cannot be coarsened
  /// further is solved directly whatever its size.
  dealii::types::global_dof_index coarsest_size = 2000;
};

/// Preconditioner for the tangent of a sheet: one V-cycle of geometric multigrid. The levels are ever coarser meshes,
/// each coarsened everywhere by one refinement (global coarsening), with a sheet of their own; so a level has hanging
/// nodes where its mesh has, and no more cells than the work there needs. The tangent is assembled anew on each level
/// at the interpolated state, the smoother is a Chebyshev polynomial over VertexPatches, and the coarsest level is
/// solved directly. The cycle reads tangents in single precision (SinglePrecisionMatrix).
///
/// The cycle is symmetric, and positive definite as long as the tangents are. Vectors vanish at constrained degrees of
/// freedom: those at hanging nodes, and the held ones. Repeated runs on the same ranks give the same bits.
///
/// All functions are collective, and every exception reaches every rank.
class Multigrid
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  /// Makes the sheet of a coarser mesh, of the same law and element. The mesh outlives the sheet.
  using SheetFactory = std::function<std::unique_ptr<Sheet>(const dealii::parallel::distributed::Triangulation<2> &)>;
  /// Gives `K` the sparsity that the Assembler fills.
  using MatrixFactory =
    std::function<void(const Sheet &, const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &K)>;
  /// Puts into `K` the tangent [N/m^2] at the nodal vector `u` [m] (with ghost entries), condensed by `constraints`.
  /// Throws NonPhysicalState, on every rank, where there is none.
  using Assembler = std::function<void(const Sheet &, const Sheet::Vector &u,
                                       const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &K)>;
  /// Builds all that depends on the mesh alone: levels, transfers, sparsity, patches. `fine` must outlive the
  /// multigrid, and its mesh must not change. Throws InvalidInput for settings out of range.
  Multigrid(const Sheet &fine, const SheetFactory &make_sheet, const MatrixFactory &make_matrix,
            const DirichletBoundaries &held, const MultigridSettings &settings = MultigridSettings());
  ~Multigrid();
  Multigrid(const Multigrid &) = delete;
  Multigrid &operator=(const Multigrid &) = delete;

  /// Takes over the state `u` [m] (with ghost entries) and its tangent on the finest mesh, condensed by constraints(),
  /// of which a copy is kept. Where the interpolated state is non-physical on a coarser level, half of it is taken,
  /// then a quarter and so on, and at last zero: that makes a worse preconditioner and no error. Throws
  /// LinearSolverFailed if the coarsest tangent is singular.
  void update(const Sheet::Vector &u, const Sheet::Matrix &fine_matrix, const Assembler &assemble);

  /// z [m] from r [N/m], vectors of the layout that `initialize` gives.
  void vmult(Vector &z, const Vector &r) const;

  /// Makes `v` a zero vector of the layout that vmult takes.
  void initialize(Vector &v) const;
  /// Copies owned entries, from and to vectors without ghost entries.
  static void copy(const Sheet::Vector &from, Vector &to);
  static void copy(const Vector &from, Sheet::Vector &to);

  /// Of the finest mesh: hanging nodes, and held degrees of freedom at zero.
  const dealii::AffineConstraints<double> &constraints() const;

  /// What a level is like, for reports and tests.
  struct LevelFacts
  {
    dealii::types::global_dof_index n_unknowns;
    double largest_eigenvalue;       ///< estimate for patches times tangent [-]; 0 on the coarsest level
    double state_factor;             ///< of the interpolated state at which the tangent was assembled [-]
    unsigned int n_replaced_patches; ///< blocks that were not positive definite
  };
  /// From the coarsest to the finest, after update.
  std::vector<LevelFacts> levels() const;

private:
  struct Level;

  void cycle(unsigned int level, Vector &z, const Vector &r) const;

  MultigridSettings settings_;
  std::vector<std::unique_ptr<Level>> levels_; // from the coarsest to the finest
  std::unique_ptr<DirectSolver> coarsest_;
};
} // namespace latcon::continuum
