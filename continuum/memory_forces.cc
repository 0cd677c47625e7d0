#include "continuum/memory_forces.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/stress_integrals.h"

#include <deal.II/base/mpi.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Calls work(points, F) for every locally owned cell; u has ghost entries. Local.
template <typename Work>
void for_each_cell(const Sheet &sheet, const Sheet::Vector &u, const Work &work)
{
  stress_integrals::for_each_cell<1>(sheet, {&u},
                                     [&](auto &points)
                                     {
                                       stress_integrals::add_identity(points.gradients[0]);
                                       work(points, points.gradients[0]);
                                     });
}

// Adds the tangent to `matrix`; overstress(point, F) returns the overstresses at the point of that number.
template <typename Overstress>
void add_tangent_of(const Sheet &sheet, const FibreMemory &law, const FibreMemory::Step &step, const Sheet::Vector &u,
                    const AffineConstraints<double> &constraints, Sheet::Matrix &matrix, const Overstress &overstress)
{
  const DeferredException guarded(
    [&]
    {
      const unsigned int n = sheet.element().n_dofs_per_cell();
      FullMatrix<double> local(n, n);
      for_each_cell(sheet, u,
                    [&](const auto &points, const auto &F)
                    {
                      local = 0.;
                      for (unsigned int q = 0; q < F.size(); ++q)
                        stress_integrals::add_stiffness(
                          points.values, q, law.tangent(step, F[q], overstress(points.cell * F.size() + q, F[q])),
                          local);
                      constraints.distribute_local_to_global(local, points.dofs, matrix);
                    });
    });
  matrix.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
}
} // namespace

// Computes the overstresses at one quadrature point after `step`.
void MemoryForces::advance(const FibreMemory::Step &step, const std::size_t point, const Tensor<2, 2> &F,
                           AtPoint &state) const
{
  const std::size_t n = law_->n_variables();
  state.stretch.resize(law_->families().size());
  law_->stretches(F, state.stretch.data());
  state.overstress.assign(history_.overstress.begin() + point * n, history_.overstress.begin() + (point + 1) * n);
  law_->advance(step, stretch_before(point), state.stretch.data(), state.overstress.data());
}

const double *MemoryForces::stretch_before(const std::size_t point) const
{
  return history_.stretch.data() + point * law_->families().size();
}

std::size_t MemoryForces::n_points_per_cell() const
{
  return QGauss<2>(sheet_.degree() + 1).size();
}

void MemoryForces::start(const Vector &u, const std::vector<Vector> &relaxed)
{
  if (law_ == nullptr)
    return;
  if (!relaxed.empty() && relaxed.size() != law_->n_numbers())
    throw InvalidInput("there are " + std::to_string(law_->n_numbers()) + " branches, but " +
                       std::to_string(relaxed.size()) + " displacements in which they are relaxed");
  const auto stretches = [&](const Vector &displacement)
  {
    std::vector<double> all;
    run_collectively(sheet_.communicator(),
                     [&]
                     {
                       std::vector<double> l(law_->families().size());
                       for_each_cell(sheet_, displacement,
                                     [&](const auto &, const auto &F)
                                     {
                                       for (const Tensor<2, 2> &at_point : F)
                                       {
                                         law_->stretches(at_point, l.data());
                                         all.insert(all.end(), l.begin(), l.end());
                                       }
                                     });
                     });
    return all;
  };
  history_.stretch = stretches(u);
  const std::size_t n_families = law_->families().size();
  const std::size_t n_points = history_.stretch.size() / n_families;
  history_.overstress.assign(n_points * law_->n_variables(), 0.);
  for (std::size_t number = 0; number < relaxed.size(); ++number)
  {
    const std::vector<double> before = stretches(relaxed[number]);
    std::size_t variable = 0;
    for (std::size_t point = 0; point < n_points; ++point)
      for (std::size_t family = 0; family < n_families; ++family)
      {
        const MaxwellFibres &fibres = law_->families()[family];
        const std::size_t at = point * n_families + family;
        for (std::size_t i = 0; i < fibres.branches.size(); ++i, ++variable)
          if (fibres.first_number + i == number)
            history_.overstress[variable] = fibres.branches[i].modulus * (history_.stretch[at] - before[at]);
      }
  }
}

void MemoryForces::add_forces(const double duration, const Vector &u, Vector &forces, Vector *magnitude) const
{
  if (law_ == nullptr)
    return;
  const DeferredException guarded(
    [&]
    {
      const FibreMemory::Step step = law_->step(duration);
      dealii::Vector<double> local(sheet_.element().n_dofs_per_cell());
      dealii::Vector<double> local_magnitude(local.size());
      AtPoint state;
      for_each_cell(sheet_, u,
                    [&](const auto &points, const auto &F)
                    {
                      local = 0.;
                      local_magnitude = 0.;
                      for (unsigned int q = 0; q < F.size(); ++q)
                      {
                        advance(step, points.cell * F.size() + q, F[q], state);
                        stress_integrals::add_stress(points.values, q, law_->stress(F[q], state.overstress.data()),
                                                     local, local_magnitude);
                      }
                      sheet_.conformity_constraints().distribute_local_to_global(local, points.dofs, forces);
                      if (magnitude != nullptr)
                        sheet_.conformity_constraints().distribute_local_to_global(local_magnitude, points.dofs,
                                                                                   *magnitude);
                    });
    });
  forces.compress(VectorOperation::add);
  if (magnitude != nullptr)
    magnitude->compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());
}

void MemoryForces::add_stresses(const Vector &u, std::vector<Tensor<2, 2>> &stresses) const
{
  if (law_ == nullptr)
    return;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     for_each_cell(sheet_, u,
                                   [&](const auto &points, const auto &F)
                                   {
                                     for (unsigned int q = 0; q < F.size(); ++q)
                                     {
                                       const std::size_t point = points.cell * F.size() + q;
                                       stresses[point] +=
                                         law_->stress(F[q], &history_.overstress[point * law_->n_variables()]);
                                     }
                                   });
                   });
}

void MemoryForces::add_tangent(const double duration, const Vector &u, const AffineConstraints<double> &constraints,
                               Sheet::Matrix &matrix) const
{
  if (law_ == nullptr)
    return;
  const FibreMemory::Step step = law_->step(duration);
  AtPoint state;
  add_tangent_of(sheet_, *law_, step, u, constraints, matrix,
                 [&](const std::size_t point, const Tensor<2, 2> &F)
                 {
                   advance(step, point, F, state);
                   return state.overstress.data();
                 });
}

void MemoryForces::add_relaxed_tangent(const Sheet &sheet, const FibreMemory *law, const double duration,
                                       const Vector &u, const AffineConstraints<double> &constraints,
                                       Sheet::Matrix &matrix)
{
  if (law == nullptr)
    return;
  const std::vector<double> relaxed(law->n_variables(), 0.);
  add_tangent_of(sheet, *law, law->step(duration), u, constraints, matrix,
                 [&](std::size_t, const Tensor<2, 2> &) { return relaxed.data(); });
}

MemoryForces::History MemoryForces::advanced(const double duration, const Vector &u,
                                             std::vector<BranchEnergy> &energies) const
{
  History next;
  if (law_ == nullptr)
    return next;
  const std::size_t n = law_->n_numbers();
  std::vector<double> sums(2 * n, 0.); // stored, dissipated
  run_collectively(
    sheet_.communicator(),
    [&]
    {
      const FibreMemory::Step step = law_->step(duration);
      AtPoint state;
      std::vector<double> density(2 * n);
      next.overstress.reserve(history_.overstress.size());
      next.stretch.reserve(history_.stretch.size());
      for_each_cell(sheet_, u,
                    [&](const auto &points, const auto &F)
                    {
                      for (unsigned int q = 0; q < F.size(); ++q)
                      {
                        const std::size_t point = points.cell * F.size() + q;
                        advance(step, point, F[q], state);
                        density.assign(2 * n, 0.);
                        law_->add_stored(state.overstress.data(), density.data());
                        law_->add_dissipated(step, stretch_before(point), state.stretch.data(),
                                             history_.overstress.data() + point * law_->n_variables(),
                                             density.data() + n);
                        for (std::size_t i = 0; i < 2 * n; ++i)
                          sums[i] += density[i] * points.values.JxW(q);
                        next.overstress.insert(next.overstress.end(), state.overstress.begin(), state.overstress.end());
                        next.stretch.insert(next.stretch.end(), state.stretch.begin(), state.stretch.end());
                      }
                    });
    });
  dealii::Utilities::MPI::sum(sums, sheet_.communicator(), sums);
  energies.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    energies[i].stored = sums[i];
    energies[i].dissipated += sums[n + i];
  }
  return next;
}

std::vector<BranchEnergy> MemoryForces::stored(const Vector &u) const
{
  std::vector<BranchEnergy> energies;
  advanced(0., u, energies);
  return energies;
}
} // namespace latcon::continuum
