#include "continuum/rate_forces.h"

#include "continuum/errors.h"
#include "continuum/single_precision_matrix.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

using namespace dealii;

namespace latcon::continuum
{
RateForces::RateForces(const Sheet &sheet, const Viscosity *viscosity, const FibreMemory *memory)
  : sheet_(sheet), viscosity_(viscosity), gradient_viscosity_(viscosity != nullptr ? viscosity->gradient() : nullptr)
{
  for (; memory != nullptr; memory = memory->gradient())
    memory_.push_back(memory);
  if (has_gradient() && !sheet.has_gradient())
    throw InvalidInput("a viscosity or Maxwell branches with a gradient part need a sheet with a gradient law");
}

RateForces RateForces::on(const Sheet &sheet) const
{
  return RateForces(sheet, viscosity_, memory_.empty() ? nullptr : memory_[0]);
}

std::vector<FibreMemory::Step> RateForces::steps(const double duration) const
{
  std::vector<FibreMemory::Step> all;
  for (const FibreMemory *law : memory_)
    all.push_back(law->step(duration));
  return all;
}

// Returns the history of one point after `step`.
RateForces::PointHistory RateForces::after(const FibreMemory::Step &step, const std::size_t part,
                                           const CellPoint &point) const
{
  const FibreMemory &law = *memory_[part];
  const double *before = &history_[part].overstress[point.number * law.n_variables()];
  PointHistory state{{before, before + law.n_variables()}, std::vector<double>(law.n_strains())};
  law.strains(point.u, state.strain.data());
  law.advance(step, &history_[part].strain[point.number * law.n_strains()], state.strain.data(),
              state.overstress.data());
  return state;
}

// Returns the forces after `duration`.
PointForces RateForces::at(const double duration, const Order order, const Vector &v,
                           const double rate_by_displacement) const
{
  const auto density = [=, steps = steps(duration)](const Viscosity *viscosity, const std::size_t part)
  {
    return [=](const CellPoint &point, PointIntegrand &d)
    {
      if (viscosity != nullptr)
        viscosity->at(point.X).add_density(point.u, point.v, order, rate_by_displacement, d);
      if (part < memory_.size() && order != Order::value)
        memory_[part]->add_density(steps[part], point.u, after(steps[part], part, point).overstress.data(), order, d);
    };
  };
  PointForces forces;
  forces.is_symmetric = viscosity_ == nullptr;
  forces.velocity = viscosity_ == nullptr ? nullptr : &v;
  forces.local = density(viscosity_, 0);
  if (has_gradient())
    forces.gradient = density(gradient_viscosity_, 1);
  return forces;
}

// Calls visit(part, law, point) at all points of the branches.
template <class Visit>
void RateForces::for_each_point(const Vector &u, const Visit &visit) const
{
  PointForces forces;
  forces.local = [&](const CellPoint &point, PointIntegrand &) { visit(0, *memory_[0], point); };
  if (memory_.size() > 1)
    forces.gradient = [&](const CellPoint &point, PointIntegrand &) { visit(1, *memory_[1], point); };
  if (!memory_.empty())
    integral(sheet_, u, forces);
}

// Returns the strains at u, and overstresses of zero.
RateForces::History RateForces::strains(const Vector &u) const
{
  History history;
  for_each_point(u,
                 [&](const std::size_t part, const FibreMemory &law, const CellPoint &point)
                 {
                   auto &[overstress, strain] = history[part];
                   overstress.resize(overstress.size() + law.n_variables());
                   strain.resize(strain.size() + law.n_strains());
                   law.strains(point.u, &strain[strain.size() - law.n_strains()]);
                 });
  return history;
}

// Returns the number of variables of a part in each locally owned cell.
std::vector<std::size_t> RateForces::n_variables_of_cells(const std::size_t part, const Vector &u) const
{
  std::vector<std::size_t> numbers(sheet_.mesh().n_locally_owned_active_cells());
  const std::size_t n_points = QGauss<2>(sheet_.degree() + 1).size();
  for_each_point(u, [&](const std::size_t of_part, const FibreMemory &law, const CellPoint &point)
                 { numbers[point.number_in_cell / n_points] += of_part == part ? law.n_variables() : 0; });
  return numbers;
}

void RateForces::start(const Vector &u, const std::vector<Vector> &relaxed)
{
  if (!memory_.empty() && !relaxed.empty() && relaxed.size() != n_branches())
    throw InvalidInput("there are " + std::to_string(n_branches()) + " branches, but " +
                       std::to_string(relaxed.size()) + " displacements in which they are relaxed");
  history_ = strains(u);
  for (std::size_t number = 0; number < relaxed.size(); ++number)
  {
    const History before = strains(relaxed[number]);
    for (std::size_t part = 0; part < memory_.size(); ++part)
    {
      const FibreMemory &law = *memory_[part];
      auto &[overstress, strain] = history_[part];
      for (std::size_t point = 0; point < strain.size() / law.n_strains(); ++point)
        law.set_sudden(number, &before[part].strain[point * law.n_strains()], &strain[point * law.n_strains()],
                       &overstress[point * law.n_variables()]);
    }
  }
}

void RateForces::add_forces(const double duration, const Vector &u, const Vector &v, Vector &forces,
                            Vector *magnitude) const
{
  if (is_present())
    continuum::add_forces(sheet_, u, at(duration, Order::first, v), forces, magnitude);
}

template <class AnyMatrix>
void RateForces::add_tangent(const double duration, const Vector &u, const Vector &v, const double rate_by_displacement,
                             const AffineConstraints<double> &constraints, AnyMatrix &matrix) const
{
  if (is_present())
    continuum::add_tangent(sheet_, u, at(duration, Order::second, v, rate_by_displacement), constraints, matrix);
}

template void RateForces::add_tangent(double, const Vector &, const Vector &, double, const AffineConstraints<double> &,
                                      Sheet::Matrix &) const;
template void RateForces::add_tangent(double, const Vector &, const Vector &, double, const AffineConstraints<double> &,
                                      SinglePrecisionMatrix &) const;

void RateForces::add_stresses(const Vector &u, const Vector &v, std::vector<Tensor<2, 2>> &stresses) const
{
  if (is_present())
    continuum::add_stresses(sheet_, u, at(0., Order::first, v), stresses);
}

double RateForces::dissipation(const Vector &u, const Vector &v) const
{
  return viscosity_ == nullptr ? 0. : integral(sheet_, u, at(0., Order::value, v));
}

RateForces::History RateForces::advanced(const double duration, const Vector &u,
                                         std::vector<BranchEnergy> &energies) const
{
  History next;
  if (memory_.empty())
    return next;
  const std::size_t n = n_branches();
  std::vector<double> sums(2 * n, 0.); // stored, dissipated
  std::vector<double> density(2 * n);
  const std::vector<FibreMemory::Step> steps = this->steps(duration);
  for_each_point(u,
                 [&](const std::size_t part, const FibreMemory &law, const CellPoint &point)
                 {
                   const PointHistory state = after(steps[part], part, point);
                   density.assign(2 * n, 0.);
                   law.add_stored(state.overstress.data(), density.data());
                   law.add_dissipated(steps[part], &history_[part].strain[point.number * law.n_strains()],
                                      state.strain.data(), &history_[part].overstress[point.number * law.n_variables()],
                                      density.data() + n);
                   for (std::size_t i = 0; i < 2 * n; ++i)
                     sums[i] += density[i] * point.JxW;
                   auto &[overstress, strain] = next[part];
                   overstress.insert(overstress.end(), state.overstress.begin(), state.overstress.end());
                   strain.insert(strain.end(), state.strain.begin(), state.strain.end());
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
} // namespace latcon::continuum
