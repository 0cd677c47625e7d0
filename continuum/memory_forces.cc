#include "continuum/memory_forces.h"

#include "continuum/collective.h"
#include "continuum/element_integrals.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Forces of the overstresses that overstress(point, F) returns, those of the quadrature point of that number.
template <typename Overstress>
PointForces remembered(const FibreMemory &law, const FibreMemory::Step &step, const Order order,
                       const Overstress &overstress)
{
  PointForces forces;
  forces.is_symmetric = true;
  forces.density = [=, &law](const CellPoint &point, PointIntegrand &density)
  {
    const Tensor<2, 2> F = deformation_gradient(point.u);
    const double *q = overstress(point.number, F);
    if (order == Order::first)
      add_stress(density, law.stress(F, q));
    else
      add_tangent(density, law.tangent(step, F, q));
  };
  return forces;
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
    std::vector<double> l(law_->families().size());
    for_each_point(sheet_, displacement,
                   [&](const CellPoint &point)
                   {
                     law_->stretches(deformation_gradient(point.u), l.data());
                     all.insert(all.end(), l.begin(), l.end());
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

// Returns the forces after `duration`. The state at a point must outlive them.
PointForces MemoryForces::after(const double duration, const Order order, AtPoint &state) const
{
  const FibreMemory::Step step = law_->step(duration);
  return remembered(*law_, step, order,
                    [this, step, &state](const std::size_t point, const Tensor<2, 2> &F)
                    {
                      advance(step, point, F, state);
                      return state.overstress.data();
                    });
}

void MemoryForces::add_forces(const double duration, const Vector &u, Vector &forces, Vector *magnitude) const
{
  if (law_ == nullptr)
    return;
  AtPoint state;
  continuum::add_forces(sheet_, u, after(duration, Order::first, state), forces, magnitude);
}

void MemoryForces::add_stresses(const Vector &u, std::vector<Tensor<2, 2>> &stresses) const
{
  if (law_ == nullptr)
    return;
  const auto present = [&](const std::size_t point, const Tensor<2, 2> &)
  { return &history_.overstress[point * law_->n_variables()]; };
  continuum::add_stresses(sheet_, u, remembered(*law_, {}, Order::first, present), stresses);
}

void MemoryForces::add_tangent(const double duration, const Vector &u, const AffineConstraints<double> &constraints,
                               Sheet::Matrix &matrix) const
{
  if (law_ == nullptr)
    return;
  AtPoint state;
  continuum::add_tangent(sheet_, u, after(duration, Order::second, state), constraints, matrix);
}

void MemoryForces::add_relaxed_tangent(const Sheet &sheet, const FibreMemory *law, const double duration,
                                       const Vector &u, const AffineConstraints<double> &constraints,
                                       Sheet::Matrix &matrix)
{
  if (law == nullptr)
    return;
  const std::vector<double> relaxed(law->n_variables(), 0.);
  continuum::add_tangent(sheet, u,
                         remembered(*law, law->step(duration), Order::second,
                                    [&](std::size_t, const Tensor<2, 2> &) { return relaxed.data(); }),
                         constraints, matrix);
}

MemoryForces::History MemoryForces::advanced(const double duration, const Vector &u,
                                             std::vector<BranchEnergy> &energies) const
{
  History next;
  if (law_ == nullptr)
    return next;
  const std::size_t n = law_->n_numbers();
  std::vector<double> sums(2 * n, 0.); // stored, dissipated
  const FibreMemory::Step step = law_->step(duration);
  AtPoint state;
  std::vector<double> density(2 * n);
  next.overstress.reserve(history_.overstress.size());
  next.stretch.reserve(history_.stretch.size());
  for_each_point(sheet_, u,
                 [&](const CellPoint &point)
                 {
                   advance(step, point.number, deformation_gradient(point.u), state);
                   density.assign(2 * n, 0.);
                   law_->add_stored(state.overstress.data(), density.data());
                   law_->add_dissipated(step, stretch_before(point.number), state.stretch.data(),
                                        history_.overstress.data() + point.number * law_->n_variables(),
                                        density.data() + n);
                   for (std::size_t i = 0; i < 2 * n; ++i)
                     sums[i] += density[i] * point.JxW;
                   next.overstress.insert(next.overstress.end(), state.overstress.begin(), state.overstress.end());
                   next.stretch.insert(next.stretch.end(), state.stretch.begin(), state.stretch.end());
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
