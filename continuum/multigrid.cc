#include "continuum/multigrid.h"

#include "continuum/direct_solver.h"
#include "continuum/errors.h"
#include "continuum/vertex_patches.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/multigrid/mg_transfer_global_coarsening.h>

using namespace dealii;

namespace latcon::continuum
{
struct Multigrid::Level
{
  using Smoother = PreconditionChebyshev<SinglePrecisionMatrix, Vector, VertexPatches>;

  std::shared_ptr<const Triangulation<2>> mesh; // null on the finest level, as is own_sheet
  std::unique_ptr<Sheet> own_sheet;
  const Sheet *sheet = nullptr;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
  Sheet::Matrix coarsest_tangent;
  SinglePrecisionMatrix own_tangent;              // of levels between the finest and the coarsest
  const SinglePrecisionMatrix *tangent = nullptr; // members from here on are unused on the coarsest level
  MGTwoLevelTransfer<2, Vector> to_coarser;
  std::shared_ptr<VertexPatches> patches;
  Smoother smoother;
  mutable Vector residual;
  mutable Vector coarse_residual; // and the next: vectors of the next coarser level
  mutable Vector coarse_correction;
};

namespace
{
// Bound of the eigenvalues of patches times tangent, theory-continuum.md, "Linear solver".
constexpr double largest_eigenvalue = 6.;
constexpr double smoothed_range = 6.; // largest over smallest eigenvalue that is smoothed
} // namespace

Multigrid::Multigrid(const Sheet &fine, const types::global_dof_index coarsest_size)
{
  // From the finest level down to the first level that is small enough.
  const auto meshes = MGTransferGlobalCoarseningTools::create_geometric_coarsening_sequence(
    static_cast<const Triangulation<2> &>(fine.mesh()));
  for (std::size_t n = meshes.size(); n-- > 0;)
  {
    auto level = std::make_unique<Level>();
    if (n + 1 == meshes.size())
      level->sheet = &fine;
    else
    {
      level->mesh = meshes[n];
      level->own_sheet = std::make_unique<Sheet>(dynamic_cast<const Sheet::Mesh &>(*meshes[n]), fine.constitution(),
                                                 fine.degree(), fine.conditions());
      level->sheet = level->own_sheet.get();
    }
    const Sheet &sheet = *level->sheet;
    const bool is_coarsest = n == 0 || sheet.dof_handler().n_dofs() <= coarsest_size;
    if (is_coarsest)
    {
      sheet.make_matrix(sheet.homogeneous_constraints(), level->coarsest_tangent);
      level->layout = std::make_shared<const dealii::Utilities::MPI::Partitioner>(sheet.owned(), sheet.relevant(),
                                                                                  sheet.communicator());
    }
    else
    {
      if (level->own_sheet)
        level->own_tangent.reinit(sheet, sheet.homogeneous_constraints());
      level->patches = std::make_shared<VertexPatches>(sheet, sheet.homogeneous_constraints());
      level->layout = level->patches->layout();
    }
    levels_.push_back(std::move(level));
    if (is_coarsest)
      break;
  }
  std::reverse(levels_.begin(), levels_.end());
  constexpr types::global_dof_index small = 10000; // KLU is too slow for more unknowns
  const bool is_small = levels_.front()->sheet->dof_handler().n_dofs() <= small;
  coarsest_ = std::make_unique<DirectSolver>(is_small ? DirectSolver::Library::klu : DirectSolver::Library::mumps);

  for (std::size_t l = 1; l < levels_.size(); ++l)
  {
    Level &level = *levels_[l];
    const Level &coarser = *levels_[l - 1];
    level.to_coarser.reinit_geometric_transfer(level.sheet->dof_handler(), coarser.sheet->dof_handler(),
                                               level.sheet->homogeneous_constraints(),
                                               coarser.sheet->homogeneous_constraints());
    level.to_coarser.enable_inplace_operations_if_possible(coarser.layout, level.layout);
    level.residual.reinit(level.layout);
    level.coarse_residual.reinit(coarser.layout);
    level.coarse_correction.reinit(coarser.layout);
  }
}

Multigrid::~Multigrid() = default;

void Multigrid::update(const Sheet::Vector &u, const Assembler &assemble)
{
  Vector state(levels_.back()->layout);
  copy(levels_.back()->sheet->without_ghosts(u), state);
  for (std::size_t l = levels_.size(); l-- > 0;)
  {
    Level &level = *levels_[l];
    Sheet::Vector owned = level.sheet->make_owned();
    if (level.own_sheet)
    {
      Vector coarse_state(level.layout);
      levels_[l + 1]->to_coarser.interpolate(coarse_state, state);
      copy(coarse_state, owned);
      level.sheet->conformity_constraints().distribute(owned);
      state.reinit(level.layout);
      copy(owned, state);
    }
    else if (l > 0)
      continue;
    else
      copy(state, owned);

    Sheet::Vector ghosted = level.sheet->make_ghosted();
    constexpr double smallest_factor = 0.1;
    for (double factor = 1.;; factor *= 0.5)
    {
      if (factor < smallest_factor)
        factor = 0.;
      ghosted = owned;
      ghosted *= factor;
      try
      {
        if (l == 0)
          assemble(*level.sheet, ghosted, level.coarsest_tangent);
        else
          assemble(*level.sheet, ghosted, level.own_tangent);
        break;
      }
      catch (const NonPhysicalState &)
      {
        if (factor == 0.)
          throw;
      }
    }
    if (l == 0)
      continue;
    level.own_tangent.make_symmetric();
    set_tangent(l, level.own_tangent);
  }
  coarsest_->factorise(levels_.front()->coarsest_tangent);
}

void Multigrid::set_finest(const SinglePrecisionMatrix &K)
{
  if (levels_.size() > 1)
    set_tangent(levels_.size() - 1, K);
}

void Multigrid::set_tangent(const unsigned int l, const SinglePrecisionMatrix &K)
{
  Level &level = *levels_[l];
  level.tangent = &K;
  level.patches->factorise(K);
  // Double the degree on each coarser level, at a small part of the total cost: see theory-continuum.md, "Linear
  // solver". More doublings do not reduce the iterations.
  const unsigned int degree = 2 << std::min<unsigned int>(levels_.size() - 1 - l, 4);
  Level::Smoother::AdditionalData data(degree, smoothed_range, 0, 0., largest_eigenvalue);
  data.preconditioner = level.patches;
  level.smoother.initialize(K, data);
}

void Multigrid::cycle(const unsigned int l, Vector &z, const Vector &r) const
{
  const Level &level = *levels_[l];
  if (l == 0)
  {
    coarsest_->solve(z, r);
    return;
  }
  level.smoother.vmult(z, r);
  level.tangent->vmult(level.residual, z);
  level.residual.sadd(-1., 1., r);
  level.coarse_residual = 0.;
  level.to_coarser.restrict_and_add(level.coarse_residual, level.residual);
  cycle(l - 1, level.coarse_correction, level.coarse_residual);
  level.to_coarser.prolongate_and_add(z, level.coarse_correction);
  level.smoother.step(z, r);
}

void Multigrid::vmult(Vector &z, const Vector &r) const
{
  cycle(levels_.size() - 1, z, r);
}

void Multigrid::initialize(Vector &v) const
{
  v.reinit(levels_.back()->layout);
}
} // namespace latcon::continuum
