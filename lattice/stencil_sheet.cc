#include "lattice/stencil_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>
#include <omp.h>

#include "lattice/counter_hash.h"

namespace latcon::lattice
{
namespace
{

void require(bool condition, const char *message)
{
  if (!condition)
    throw std::invalid_argument(message);
}

// First and last columns (0) and rows (1) of the grid that cover a rectangle.
std::array<Eigen::Vector2i, 2> covering(const Grid &grid, const Eigen::Vector2d &origin, double length, double height)
{
  Eigen::Matrix2d cell;
  cell << grid.vector(1, 0), grid.vector(0, 1);
  Eigen::Array2d low = Eigen::Array2d::Constant(1e300), high = -low;
  for (const double X : {0., length})
    for (const double Y : {-0.5 * height, 0.5 * height})
    {
      const Eigen::Array2d corner = (cell.inverse() * (Eigen::Vector2d(X, Y) - origin)).array();
      low = low.min(corner);
      high = high.max(corner);
    }
  require(low.minCoeff() > -1e5 && high.maxCoeff() < 1e5, "a sheet has more than 1e5 points along an edge");
  return {low.floor().cast<int>(), high.floor().cast<int>() + 1};
}

} // namespace

StencilSheet::StencilSheet(const Grid &grid, const Eigen::Vector2d &origin, double length, double height,
                           const Material &material, double d, const std::vector<Ring> &rings, const Eigen::Matrix2d &F,
                           double step)
  : grid_(grid), origin_(origin), material_(material), stencil_(ring_stencil(grid, rings)),
    mass_(material.density * grid.cell_area())
{
  kernels::limit_instruction_sets();
  require(d > 0. && length > 0. && height > 0. && step >= 0.,
          "lengths of a sheet are positive, and so is its time step");
  require(material.disorder.stiffness.is_none() && material.disorder.strength.is_none() && !material.has_memory(),
          "bonds of a nonlocal continuum have neither disorder nor memory");
  int columns_reach = 0, rows_reach = 0;
  double damping = 0.;
  for (const HalfBond &bond : stencil_)
  {
    const Shell *shell = material.in_shell(bond.shell);
    require(shell != nullptr && shell->viscosity > 0., "each ring needs a shell of the material, with dashpots");
    const auto ring =
      std::find_if(rings.begin(), rings.end(), [&](const Ring &candidate) { return candidate.shell == bond.shell; });
    const double share = n_kinds_per_shell * shell->area_factor * ring->radius / d;
    const double section = share * grid.cell_area() * bond.weight / bond.rest_length;
    constants_.push_back({bond.rest_length, section, section * shell->viscosity / bond.rest_length});
    damping += 4. * constants_.back().damping / mass_;
    columns_reach = std::max(columns_reach, std::abs(bond.columns));
    rows_reach = std::max(rows_reach, bond.rows);
  }
  step_ = step > 0. ? step : resolving_step();
  stages_ = ChebyshevStages(std::max(2u, ChebyshevStages::needed(step_ * damping)));

  const auto [first, last] = covering(grid, origin, length, height);
  first_column_ = first.x() - columns_reach;
  first_row_ = first.y() - rows_reach;
  const int columns = last.x() - first_column_ + columns_reach + 2 * int(TriangularLattice::row_alignment);
  stride_ = static_cast<std::size_t>(columns);
  reach_ = static_cast<std::size_t>(rows_reach);
  n_places_ = stride_ * static_cast<std::size_t>(last.y() - first_row_ + rows_reach + 2);
  for (const HalfBond &bond : stencil_)
    shift_.push_back(bond.rows * static_cast<std::ptrdiff_t>(stride_) + bond.columns);
  for (Field *field : {&x_, &y_, &vx_, &vy_, &fx_, &fy_, &ax_, &ay_, &start_x_, &start_y_, &start_vx_, &start_vy_,
                       &previous_x_, &previous_y_, &previous_vx_, &previous_vy_, &inverse_mass_})
    *field = Field(n_places_);
  bonds_.clear(n_places_, stencil_.size());
  lost_.resize(n_places_);

  const double tolerance = 1e-9 * grid.spacing;
  std::vector<char> is_site(n_places_, 0);
  for (int row = first.y(); row <= last.y(); ++row)
  {
    const auto begin = static_cast<std::size_t>(row - first_row_) * stride_;
    Row sites{0, 0, begin};
    for (int column = first.x(); column <= last.x(); ++column)
    {
      const Eigen::Vector2d X = origin + grid.vector(column, row);
      if (X.x() < -tolerance || X.x() > length + tolerance || std::abs(X.y()) > 0.5 * height + tolerance)
        continue;
      const std::size_t place = begin + static_cast<std::size_t>(column - first_column_);
      if (sites.n() == 0)
        sites = {column, column, place};
      sites.last = column + 1;
      is_site[place] = 1;
      ++n_sites_;
      x_[place] = F.row(0).dot(X);
      y_[place] = F.row(1).dot(X);
    }
    rows_.push_back(sites);
  }
  row_power_ = Field(rows_.size());
  std::size_t n_free = 0;
  for (const Row &row : rows_)
    for (std::size_t place = row.begin; place < row.begin + row.n(); ++place)
    {
      bool whole = true;
      for (std::size_t k = 0; k < stencil_.size(); ++k)
      {
        const bool forward = is_site[bond(place, k).far] != 0;
        whole = whole && forward && is_site[place - static_cast<std::size_t>(shift_[k])] != 0;
        if (forward)
          bonds_.add(place, k);
      }
      inverse_mass_[place] = whole ? 1. / mass_ : 0.;
      n_free += whole ? 1 : 0;
    }
  require(n_free > 0, "no point of the sheet has all its bonds: it is too small");
  initial_ = energies().elastic;
  evaluate();
}

double StencilSheet::resolving_step() const
{
  double stiffness_sum = 0.;
  for (std::size_t k = 0; k < stencil_.size(); ++k)
    stiffness_sum += 4. * constants_[k].cross_section * stiffness(material_.in_shell(stencil_[k].shell)->law, 1.) /
                     (stencil_[k].rest_length * mass_);
  return 0.35 * 2. / std::sqrt(stiffness_sum);
}

std::optional<std::size_t> StencilSheet::place(int column, int row) const
{
  const std::ptrdiff_t first = first_row_ + static_cast<int>(reach_); // of rows_
  if (row < first || row - first >= static_cast<std::ptrdiff_t>(rows_.size()))
    return std::nullopt;
  const Row &sites = rows_[static_cast<std::size_t>(row - first)];
  if (column < sites.first || column >= sites.last)
    return std::nullopt;
  return sites.begin + static_cast<std::size_t>(column - sites.first);
}

Eigen::Vector2d StencilSheet::reference(std::size_t place) const
{
  return origin_ + grid_.vector(static_cast<int>(place % stride_) + first_column_,
                                static_cast<int>(place / stride_) + first_row_);
}

template <class Work>
void StencilSheet::for_each_bond_of_row(std::size_t row, const Work &work) const
{
  const Row &sites = rows_[row];
  for (std::size_t near = sites.begin; near < sites.begin + sites.n(); ++near)
    for (std::size_t k = 0; k < stencil_.size(); ++k)
      if (present(near, k))
        work(bond(near, k));
}

template <class Work>
void StencilSheet::in_threads(const Work &work) const
{
#pragma omp parallel if (n_sites_ >= min_places_for_threads)
  {
    const auto n = static_cast<std::size_t>(omp_get_num_threads()), i = static_cast<std::size_t>(omp_get_thread_num());
    work(rows_.size() * i / n, rows_.size() * (i + 1) / n);
  }
}

kernels::BondsOfKind StencilSheet::bonds_of(const Row &row, std::size_t k) const
{
  return {constants_[k], shift_[k], bonds_.words(k) + row.begin, BondStates::bit(k), BondStates::toughened_bit(k)};
}

kernels::RowOfBonds StencilSheet::sites_of(const Row &row, const kernels::BondsOfKind &bonds) const
{
  kernels::RowOfBonds sites{row.n(),         &x_[row.begin],    &y_[row.begin],    &vx_[row.begin],
                            &vy_[row.begin], breaking_stretch_, toughened_stretch_};
  sites.kinds = &bonds;
  sites.n_kinds = 1;
  return sites;
}

// Sums forces in one order at each point: bonds that start in lower rows first, then by half-bond.
void StencilSheet::evaluate()
{
  in_threads(
    [&](std::size_t begin, std::size_t end)
    {
      Field bx(stride_), by(stride_);
      for (std::size_t row = begin; row < end; ++row)
      {
        const std::size_t first = rows_[row].begin / stride_ * stride_;
        std::fill_n(&fx_[first], stride_, 0.);
        std::fill_n(&fy_[first], stride_, 0.);
      }
      for (std::size_t row = begin - std::min(begin, reach_); row < end; ++row)
      {
        const Row &sites = rows_[row];
        double power = 0.;
        for (std::size_t k = 0; k < stencil_.size(); ++k)
        {
          const std::size_t far = row + static_cast<std::size_t>(stencil_[k].rows);
          if (sites.n() == 0 || far < begin)
            continue;
          kernels::BondsOfKind bonds = bonds_of(sites, k);
          bonds.force = {{bx.data(), by.data()}};
          kernels::RowSums sums;
          kernels::bonds_of_stencil(material_.in_shell(stencil_[k].shell)->law, sites_of(sites, bonds), sums);
          power += sums.viscous_power;
          double *const near_x = &fx_[sites.begin], *const near_y = &fy_[sites.begin];
          if (row >= begin)
            for (std::size_t i = 0; i < sites.n(); ++i)
            {
              near_x[i] += bx[i];
              near_y[i] += by[i];
            }
          if (far < end)
            for (std::size_t i = 0; i < sites.n(); ++i)
            {
              near_x[static_cast<std::ptrdiff_t>(i) + shift_[k]] -= bx[i];
              near_y[static_cast<std::ptrdiff_t>(i) + shift_[k]] -= by[i];
            }
        }
        if (row >= begin)
          row_power_[row] = power;
      }
      for (std::size_t row = begin; row < end; ++row)
      {
        const std::size_t i = rows_[row].begin, n = rows_[row].n();
        kernels::accelerate(n, &fx_[i], &inverse_mass_[i], &ax_[i]);
        kernels::accelerate(n, &fy_[i], &inverse_mass_[i], &ay_[i]);
      }
    });
  power_ = 0.;
  for (const double power : row_power_)
    power_ += power;
}

void StencilSheet::add_noise(double amplitude, std::uint64_t seed)
{
  const auto uniform = [](std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-52 - 1.; };
  const std::uint64_t stream = splitmix64(seed);
  for (const Row &row : rows_)
    for (std::size_t place = row.begin; place < row.begin + row.n(); ++place)
      if (!held(place))
      {
        x_[place] += amplitude * uniform(splitmix64(stream + 2 * place));
        y_[place] += amplitude * uniform(splitmix64(stream + 2 * place + 1));
      }
  initial_ = energies().elastic + energies().kinetic;
  evaluate();
}

std::size_t StencilSheet::cut(double from, double to, double Y)
{
  std::size_t n = 0;
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for_each_bond_of_row(row,
                         [&](const Bond &bond)
                         {
                           const Eigen::Vector2d X = reference(bond.near), &R = stencil_[bond.kind].vector;
                           const double share = (Y - X.y()) / R.y(), at = X.x() + share * R.x();
                           if (!(share > 0. && share <= 1. && at >= from && at <= to))
                             return;
                           lose(bond);
                           ++n;
                         });
  for (const Row &row : rows_)
    for (std::size_t place = row.begin; place < row.begin + row.n(); ++place)
      consider_tip(place);
  toughen_behind_tip();
  evaluate();
  return n;
}

void StencilSheet::let_break(double breaking_stretch, BehindTipToughening toughening)
{
  require(breaking_stretch > 0., "the breaking stretch must be positive");
  require(toughening.distance >= 0. && toughening.factor >= 1.,
          "toughening behind the tip needs distance >= 0, factor >= 1");
  breaking_stretch_ = breaking_stretch;
  toughened_stretch_ = breaking_stretch * toughening.factor;
  toughening_distance_ = toughening.distance;
  toughened_to_ = -unbreakable;
  toughen_behind_tip();
}

double StencilSheet::stretch_of(const Bond &bond) const
{
  return (position(bond.far) - position(bond.near)).norm() / stencil_[bond.kind].rest_length;
}

double StencilSheet::bond_energy(const Bond &bond) const
{
  const HalfBond &half = stencil_[bond.kind];
  return constants_[bond.kind].cross_section * half.rest_length *
         energy(material_.in_shell(half.shell)->law, stretch_of(bond));
}

void StencilSheet::lose(const Bond &bond)
{
  broken_energy_ += bond_energy(bond);
  bonds_.remove(bond.near, bond.kind);
  ++lost_[bond.near];
  ++lost_[bond.far];
}

void StencilSheet::consider_tip(std::size_t place)
{
  if (held(place) || 4 * lost_[place] < 2 * stencil_.size())
    return;
  tip_.consider(place, reference(place));
}

void StencilSheet::toughen_behind_tip()
{
  if (!tip_.place)
    return;
  // The tip never retreats: bonds behind the last boundary are toughened already.
  const double boundary = tip_.X.x() - toughening_distance_;
  const auto shorter = [](const HalfBond &a, const HalfBond &b) { return a.rest_length < b.rest_length; };
  const double longest = std::max_element(stencil_.begin(), stencil_.end(), shorter)->rest_length;
  in_threads(
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t near = rows_[row].begin; near < rows_[row].begin + rows_[row].n(); ++near)
        {
          const double X = reference(near).x();
          if (X < toughened_to_ - longest || X > boundary + longest)
            continue;
          for (std::size_t k = 0; k < stencil_.size(); ++k)
            if (X + 0.5 * stencil_[k].vector.x() < boundary)
              bonds_.toughen(near, k);
        }
    });
  toughened_to_ = boundary;
}

void StencilSheet::break_bonds()
{
  const double ahead = 0.5 * step_;
  std::vector<char> has_events(rows_.size(), 0);
  in_threads(
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t k = 0; k < stencil_.size() && has_events[row] == 0; ++k)
          if (rows_[row].n() > 0 && kernels::any_event_ahead(sites_of(rows_[row], bonds_of(rows_[row], k)), ahead))
            has_events[row] = 1;
    });
  broken_.clear();
  for (std::size_t row = 0; row < rows_.size(); ++row)
    if (has_events[row] != 0)
      for_each_bond_of_row(row,
                           [&](const Bond &bond)
                           {
                             const auto [near, k, far] = bond;
                             const double limit = bonds_.toughened(near, k) ? toughened_stretch_ : breaking_stretch_;
                             if (squared_length_after(ahead, x_[far] - x_[near], y_[far] - y_[near],
                                                      vx_[far] - vx_[near], vy_[far] - vy_[near]) >
                                 squared_length(limit, stencil_[k].rest_length))
                               broken_.push_back({bond, time_, reference(near) + 0.5 * stencil_[k].vector,
                                                  stretch_of(bond), bond_energy(bond)});
                           });
  if (broken_.empty())
    return;
  const std::optional<std::size_t> previous = tip_.place;
  tip_.begin_step();
  for (const BrokenBond &bond : broken_)
    lose(bond);
  for (const BrokenBond &bond : broken_)
  {
    consider_tip(bond.near);
    consider_tip(bond.far);
  }
  if (tip_.place != previous)
    toughen_behind_tip();
  evaluate();
}

const std::vector<BrokenBond> &StencilSheet::step()
{
  const double power = power_;
  const auto each_row = [&](const auto &work)
  {
    in_threads(
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t row = begin; row < end; ++row)
          work(rows_[row].begin, rows_[row].n());
      });
  };
  const double first = step_ * stages_.first();
  each_row(
    [&](std::size_t i, std::size_t n)
    {
      kernels::first_stage(first, n, &ax_[i], &x_[i], &vx_[i], &start_x_[i], &start_vx_[i], &previous_x_[i],
                           &previous_vx_[i]);
      kernels::first_stage(first, n, &ay_[i], &y_[i], &vy_[i], &start_y_[i], &start_vy_[i], &previous_y_[i],
                           &previous_vy_[i]);
    });
  const Field start_ax = ax_, start_ay = ay_;
  for (const ChebyshevStages::Stage &stage : stages_.stages())
  {
    evaluate();
    each_row(
      [&](std::size_t i, std::size_t n)
      {
        kernels::next_stage(stage, step_, n, &fx_[i], &inverse_mass_[i], &start_ax[i], &start_x_[i], &start_vx_[i],
                            &x_[i], &vx_[i], &previous_x_[i], &previous_vx_[i]);
        kernels::next_stage(stage, step_, n, &fy_[i], &inverse_mass_[i], &start_ay[i], &start_y_[i], &start_vy_[i],
                            &y_[i], &vy_[i], &previous_y_[i], &previous_vy_[i]);
      });
    x_.swap(previous_x_);
    y_.swap(previous_y_);
    vx_.swap(previous_vx_);
    vy_.swap(previous_vy_);
  }
  time_ += step_;
  evaluate();
  viscous_ += 0.5 * step_ * (power + power_);
  if (!std::isfinite(power_))
    throw std::runtime_error("positions of a nonlocal sheet are no longer finite: the time step is too long");
  break_bonds();
  return broken_;
}

EnergyBalance StencilSheet::energies() const
{
  EnergyBalance balance{0., 0., viscous_, broken_energy_, 0., 0., initial_};
  for (std::size_t row = 0; row < rows_.size(); ++row)
  {
    for_each_bond_of_row(row, [&](const Bond &bond) { balance.elastic += bond_energy(bond); });
    for (std::size_t place = rows_[row].begin; place < rows_[row].begin + rows_[row].n(); ++place)
      if (!held(place))
        balance.kinetic += 0.5 * mass_ * (vx_[place] * vx_[place] + vy_[place] * vy_[place]);
  }
  return balance;
}

} // namespace latcon::lattice
