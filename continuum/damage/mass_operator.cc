#include "continuum/damage/mass_operator.h"

#include "continuum/errors.h"

#include <algorithm>
#include <cmath>

namespace latcon::continuum
{
namespace
{
// Integrals of Grad phi_a . Grad phi_b over a cell: of a corner with itself and those along X, along Y and across.
struct Laplacian
{
  double self, along_x, along_y, across;
};

Laplacian laplacian(const NodeGrid &grid)
{
  const double ratio = grid.size_y / grid.size_x;
  return {(ratio + 1. / ratio) / 3., (-2. * ratio + 1. / ratio) / 6., (ratio - 2. / ratio) / 6.,
          -(ratio + 1. / ratio) / 6.};
}
} // namespace

MassOperator::MassOperator(const NodeGrid &grid, const double density, const double length,
                           const std::array<std::vector<char>, 2> &held, MPI_Comm communicator)
  : grid_(grid), bands_(grid, communicator), density_(density), length_(length), held_(held)
{
  if (!(length >= 0. && std::isfinite(length)))
    throw InvalidInput("the micro-inertia length must be finite and not negative");
  const Laplacian K = laplacian(grid);
  // Modes of a cell: those linear in X, linear in Y, and X Y.
  const double eigenvalue =
    std::max({K.self - K.along_x + K.along_y - K.across, K.self + K.along_x - K.along_y - K.across,
              K.self - K.along_x - K.along_y + K.across});
  largest_ = 1. + length * length * eigenvalue / (0.25 * grid.area());
  if (length > 0.)
  {
    // The error is at most 1 / T_n((largest + 1) / (largest - 1)) = 1 / cosh(n z).
    const double z = std::acosh((largest_ + 1.) / (largest_ - 1.));
    const double n = std::ceil(std::acosh(1. / tolerance) / z);
    if (!(n <= 1000.))
      throw InvalidInput("the cells are too small for the micro-inertia length");
    n_iterations_ = static_cast<unsigned int>(n);
  }
  update(std::vector<double>(grid.n_cells(), 1.));
}

void MassOperator::update(const std::vector<double> &factors)
{
  const std::size_t columns = grid_.columns();
  lumped_.assign(grid_.n_nodes(), 0.);
  if (length_ > 0.)
    for (std::vector<double> *entries : {&centre_, &right_, &above_, &above_right_, &above_left_})
      entries->assign(grid_.n_nodes(), 0.);
  const Laplacian K = laplacian(grid_);
  for (std::size_t j = 0; j < grid_.cells_y; ++j)
    for (std::size_t i = 0; i < grid_.cells_x; ++i)
    {
      const double g = factors[j * grid_.cells_x + i];
      const double share = 0.25 * density_ * grid_.area() * g;
      const std::size_t a = j * columns + i;
      for (const std::size_t b : {a, a + 1, a + columns, a + columns + 1})
        lumped_[b] += share;
      if (length_ > 0.)
      {
        const double gradient = density_ * length_ * length_ * g;
        for (const std::size_t b : {a, a + 1, a + columns, a + columns + 1})
          centre_[b] += gradient * K.self;
        right_[a] += gradient * K.along_x;
        right_[a + columns] += gradient * K.along_x;
        above_[a] += gradient * K.along_y;
        above_[a + 1] += gradient * K.along_y;
        above_right_[a] += gradient * K.across;
        above_left_[a + 1] += gradient * K.across;
      }
    }
  for (const unsigned int d : {0u, 1u})
  {
    inverse_[d].resize(lumped_.size());
    for (std::size_t a = 0; a < lumped_.size(); ++a)
      inverse_[d][a] = held_[d][a] ? 0. : 1. / lumped_[a];
  }
}

void MassOperator::multiply(const std::vector<double> &v, std::vector<double> &result) const
{
  result.resize(v.size());
  if (length_ == 0.)
  {
    for (std::size_t a = 0; a < v.size(); ++a)
      result[a] = lumped_[a] * v[a];
    return;
  }
  multiply_rows(0, grid_.rows(), v, result);
}

// Computes the rows [begin, end) of nodes.
void MassOperator::multiply_rows(const std::size_t begin, const std::size_t end, const std::vector<double> &v,
                                 std::vector<double> &result) const
{
  const auto columns = static_cast<std::ptrdiff_t>(grid_.columns()), rows = static_cast<std::ptrdiff_t>(grid_.rows());
#pragma omp parallel for schedule(static) if (grid_.n_cells() >= FibreForces::min_cells_for_threads)
  for (std::ptrdiff_t j = static_cast<std::ptrdiff_t>(begin); j < static_cast<std::ptrdiff_t>(end); ++j)
  {
    const std::ptrdiff_t first = j * columns, last = first + columns;
    double *to = result.data();
    const double *x = v.data();
    for (std::ptrdiff_t a = first; a < last; ++a)
      to[a] = (lumped_[a] + centre_[a]) * x[a];
    for (std::ptrdiff_t a = first; a < last - 1; ++a)
      to[a] += right_[a] * x[a + 1];
    for (std::ptrdiff_t a = first + 1; a < last; ++a)
      to[a] += right_[a - 1] * x[a - 1];
    if (j + 1 < rows)
    {
      for (std::ptrdiff_t a = first; a < last; ++a)
        to[a] += above_[a] * x[a + columns];
      for (std::ptrdiff_t a = first; a < last - 1; ++a)
        to[a] += above_right_[a] * x[a + columns + 1];
      for (std::ptrdiff_t a = first + 1; a < last; ++a)
        to[a] += above_left_[a] * x[a + columns - 1];
    }
    if (j > 0)
    {
      const std::ptrdiff_t below = columns;
      for (std::ptrdiff_t a = first; a < last; ++a)
        to[a] += above_[a - below] * x[a - below];
      for (std::ptrdiff_t a = first + 1; a < last; ++a)
        to[a] += above_right_[a - below - 1] * x[a - below - 1];
      for (std::ptrdiff_t a = first; a < last - 1; ++a)
        to[a] += above_left_[a - below + 1] * x[a - below + 1];
    }
  }
}

void MassOperator::solve(GridVector &forces) const
{
  const bool is_parallel = grid_.n_cells() >= FibreForces::min_cells_for_threads;
  if (length_ == 0.)
  {
    for (const unsigned int d : {0u, 1u})
    {
#pragma omp parallel for schedule(static) if (is_parallel)
      for (std::size_t a = 0; a < lumped_.size(); ++a)
        forces[d][a] = held_[d][a] ? 0. : forces[d][a] / lumped_[a];
    }
    return;
  }
  // Chebyshev iteration for D^-1 M x = D^-1 f, D the lumped masses, on the own rows and as many beside them as there
  // are iterations, each of which spoils the outermost rows: no messages within the iteration.
  const std::size_t n = lumped_.size(), reach = n_iterations_, own = bands_.begin();
  const std::size_t begin = own > reach ? own - reach : 0, end = std::min(bands_.end() + reach, grid_.rows());
  const std::size_t first = begin * grid_.columns(), last = end * grid_.columns();
  const double middle = 0.5 * (largest_ + 1.), half = 0.5 * (largest_ - 1.);
  std::vector<double> x(n), change(n), product(n);
  for (const unsigned int d : {0u, 1u})
  {
    std::vector<double> &residual = forces[d];
    const std::vector<double> &inverse = inverse_[d];
#pragma omp parallel for simd schedule(static) if (parallel : is_parallel)
    for (std::size_t a = first; a < last; ++a)
    {
      residual[a] *= inverse[a];
      x[a] = change[a] = residual[a] / middle;
    }
    double rho = half / middle;
    for (unsigned int k = 1; k < n_iterations_; ++k)
    {
      multiply_rows(begin, end, change, product);
      const double next = 1. / (2. * middle / half - rho);
      const double keep = next * rho, add = 2. * next / half;
#pragma omp parallel for simd schedule(static) if (parallel : is_parallel)
      for (std::size_t a = first; a < last; ++a)
      {
        residual[a] -= inverse[a] * product[a];
        change[a] = keep * change[a] + add * residual[a];
        x[a] += change[a];
      }
      rho = next;
    }
    bands_.gather_nodes(x);
    residual = x;
  }
}

double MassOperator::kinetic_energy(const GridVector &v) const
{
  double sum = 0.;
  if (length_ == 0.)
  {
    for (std::size_t a = 0; a < lumped_.size(); ++a)
      sum += 0.5 * lumped_[a] * (v[0][a] * v[0][a] + v[1][a] * v[1][a]);
    return sum;
  }
  std::vector<double> product;
  for (const std::vector<double> &component : v)
  {
    multiply(component, product);
    for (std::size_t a = 0; a < product.size(); ++a)
      sum += 0.5 * component[a] * product[a];
  }
  return sum;
}
} // namespace latcon::continuum
