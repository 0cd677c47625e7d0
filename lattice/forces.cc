#include "lattice/forces.h"

#include <algorithm>

#include <omp.h>

namespace latcon::lattice
{
namespace
{

// Those of shells that the sheet lacks are unused.
kernels::BondLaws laws_of(const Material &material)
{
  const auto law = [&](std::size_t number)
  { return material.in_shell(number) != nullptr ? material.in_shell(number)->law : material.nearest.law; };
  return {{law(0), law(1), law(2)}};
}

// Returns whether bonds have factors of their own.
bool has_factors(const State &state)
{
  return !state.stiffness.empty() || !state.strength.empty();
}

} // namespace

Forces::Forces(const RowPartition &band, const Material &material)
  : band_(band), lattice_(band.lattice()), laws_(laws_of(material)), n_kinds_(material.n_kinds(lattice_)),
    reach_(static_cast<std::ptrdiff_t>(lattice_.reach())),
    columns_repeat_(lattice_.is_occupied(lattice_.index(0, 0) - 1)), row_viscous_power_(lattice_.rows(), 0.),
    row_mechanism_power_(material.n_mechanisms(), Field(lattice_.rows(), 0.)), row_events_(lattice_.rows(), 0),
    row_short_bonds_(lattice_.rows(), 0)
{
  kernels::limit_instruction_sets();
  for (std::size_t number = 0; number < n_shells; ++number)
    if (const Shell *shell = material.in_shell(number))
    {
      has_shell_[number] = true;
      memories_[number] = shell->memory;
      first_mechanism_[number] = material.first_mechanism(number);
    }
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    constants_.emplace_back();
    if (const Shell *shell = material.shell(lattice_, kind))
    {
      const double rest_length = lattice_.rest_length(kind), section = cross_section(*shell, lattice_, kind);
      constants_.back() = {rest_length, section, section * shell->viscosity / rest_length};
    }
  }
  set_elapsed(0.);
  for (std::size_t number = 0; number < n_shells; ++number)
    if (has_shell(number))
      mechanism_gives_energy_.insert(mechanism_gives_energy_.end(), n_mechanisms(memories_[number]),
                                     lattice::dissipates_energy(memory_steps_[number]));
}

void Forces::set_elapsed(double duration)
{
  for (std::size_t shell = 0; shell < memories_.size(); ++shell)
    memory_steps_[shell] = memory_step(memories_[shell], duration);
}

void Forces::update_memory(State &state)
{
  if (state.history.empty())
    return;
  Scratch scratch(lattice_, n_kinds_);
  for (const std::size_t row : BondHistory::rows(band_))
    update_memory({state, state.vx, state.vy, &state.history}, row, scratch);
  set_elapsed(0.);
}

// Only updates the memory of the bonds that start in a row.
void Forces::update_memory(const Motion &motion, std::size_t row, Scratch &scratch) const
{
  bonds_of_kinds(motion.state, row, scratch.kinds);
  scratch.mechanism_power.assign(row_mechanism_power_.size(), 0.);
  const kernels::RowOfBonds sites = sites_of_row(motion, row);
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    scratch.kinds[kind].force = {{scratch.fx.data(), scratch.fy.data()}};
    add_overstress(motion, row, sites, scratch.kinds[kind], kind, scratch.mechanism_power);
  }
}

// Adds the overstress of the bonds of a kind that start in row `from` to what their law gives.
void Forces::add_overstress(const Motion &motion, std::size_t from, const kernels::RowOfBonds &row,
                            const kernels::BondsOfKind &bonds, std::size_t kind,
                            std::vector<double> &mechanism_power) const
{
  const BondHistory &history = motion.state.history;
  if (!history.remembers(kind))
    return;
  const std::size_t shell = lattice_.shell(kind), first = lattice_.index(from, 0);
  double *const power = &mechanism_power[first_mechanism_[shell]];
  if (motion.history != nullptr)
    kernels::add_overstress(memory_steps_[shell], row, bonds,
                            kernels::remembered_from<double *>(motion.history->kinds[kind], first), power);
  else
    kernels::add_overstress(memory_steps_[shell], row, bonds,
                            kernels::remembered_from<const double *>(history.kinds[kind], first), power);
}

void Forces::evaluate(const State &state, const Field &vx, const Field &vy, const RowCallbacks &work)
{
  const Rows own = band_.rows();
  const bool threads = (own.end - own.begin) * lattice_.stride() >= min_places_for_threads;
  const std::size_t n_scratch = threads ? static_cast<std::size_t>(omp_get_max_threads()) : 1;
  while (scratch_.size() < n_scratch)
  {
    scratch_.emplace_back(lattice_, n_kinds_);
    if (!row_mechanism_power_.empty() && lattice_.is_triangular())
      scratch_.back().lengths.resize(4 * n_kinds_per_shell * lattice_.stride());
  }
  BondHistory *const history = state.history.empty() ? nullptr : work.history;
#pragma omp parallel if (threads)
  {
    const auto first = static_cast<std::ptrdiff_t>(own.begin);
    const std::ptrdiff_t rows = static_cast<std::ptrdiff_t>(own.end) - first;
    const std::ptrdiff_t n = omp_get_num_threads(), i = omp_get_thread_num();
    const std::ptrdiff_t begin = first + rows * i / n, end = first + rows * (i + 1) / n;
    // The rows that the threads next to this one look at, before anyone does.
    if (work.pre_force)
      for (std::ptrdiff_t row = begin; row < end; ++row)
        if (row < begin + reach_ || row >= end - reach_)
          work.pre_force(static_cast<std::size_t>(row));
#pragma omp barrier
    Scratch &scratch = scratch_[static_cast<std::size_t>(i)];
    evaluate_rows({state, vx, vy, history}, begin, end, scratch, work);
    if (history != nullptr)
    {
      // The rows whose bonds the thread above computed too, and those below the band.
#pragma omp barrier
      for (std::ptrdiff_t row = std::max(begin, end - reach_); row < end; ++row)
        update_memory({state, vx, vy, history}, static_cast<std::size_t>(row), scratch);
      for (std::ptrdiff_t below = first - reach_; i == 0 && below < first; ++below)
        if (const auto row = lattice_.row(below); row && (*row < own.begin || *row >= own.end))
          update_memory({state, vx, vy, history}, *row, scratch);
    }
  }
  if (history != nullptr)
    set_elapsed(0.);
}

void Forces::add_mechanisms(const std::vector<double> &mechanisms, double &power) const
{
  for (std::size_t m = 0; m < mechanisms.size(); ++m)
    if (!mechanism_gives_energy_[m])
      power += mechanisms[m];
}

double Forces::viscous_power() const
{
  // Summed row after row, whatever thread did which.
  double sum = 0.;
  for (const double power : row_viscous_power_)
    sum += power;
  return sum;
}

void Forces::evaluate_rows(const Motion &updating, std::ptrdiff_t begin, std::ptrdiff_t end, Scratch &scratch,
                           const RowCallbacks &work)
{
  if (begin == end)
    return;
  const Motion motion{updating.state, updating.vx, updating.vy};
  scratch.ahead.clear();
  scratch.sums.clear();
  for (std::ptrdiff_t row = begin - reach_; row < begin; ++row)
    bonds_from_below(motion, row, begin, scratch);
  for (std::ptrdiff_t row = begin; row < end; ++row)
  {
    const auto index = static_cast<std::size_t>(row);
    // As far up as bonds of this row reach, and where this has not been done for the thread next to it.
    if (work.pre_force && row + 2 * reach_ < end)
      work.pre_force(index + lattice_.reach());
    scratch.ahead.clear();
    if (work.fields != nullptr && row + 2 * reach_ + 1 < end)
      for (const Field *field : *work.fields)
        scratch.ahead.push_back(&(*field)[lattice_.index(index + lattice_.reach() + 1, 0)]);
    const Motion &of_row = row < end - reach_ ? updating : motion;
    const kernels::RowSums sums = lattice_.is_triangular() ? bonds_of_row(of_row, index, row, scratch)
                                                           : scatter_row(of_row, index, row, begin, scratch);
    row_viscous_power_[index] = sums.viscous_power;
    for (std::size_t m = 0; m < row_mechanism_power_.size(); ++m)
      row_mechanism_power_[m][index] = scratch.mechanism_power[m];
    row_events_[index] = sums.has_events ? 1 : 0;
    row_short_bonds_[index] = sums.has_short_bonds ? 1 : 0;
    if (lattice_.is_triangular())
    {
      gather_row(row, scratch);
      work.post_force(index, scratch.fx.data(), scratch.fy.data());
      continue;
    }
    // What bonds across a periodic edge do to images of sites is done to the sites.
    const auto columns = static_cast<std::ptrdiff_t>(lattice_.columns());
    if (columns_repeat_)
      for (double *const sum : {scratch.sums.at(row, 0), scratch.sums.at(row, 1)})
        for (std::ptrdiff_t c = 0; c < static_cast<std::ptrdiff_t>(lattice_.column_reach()); ++c)
        {
          sum[c] += sum[columns + c];
          sum[columns - 1 - c] += sum[-1 - c];
        }
    work.post_force(index, scratch.sums.at(row, 0), scratch.sums.at(row, 1));
    scratch.sums.clear(row);
  }
}

void Forces::bonds_from_below(const Motion &motion, std::ptrdiff_t row, std::ptrdiff_t begin, Scratch &scratch) const
{
  const auto from = lattice_.row(row);
  if (!lattice_.is_triangular())
  {
    if (from)
      scatter_row(motion, *from, row, begin, scratch);
  }
  else if (from)
    bonds_of_row(motion, *from, row, scratch);
  else
    for (std::size_t kind = 0; kind < n_kinds_; ++kind)
      for (double *component : scratch.bonds.at(row, kind))
        std::fill_n(component - TriangularLattice::row_alignment, lattice_.stride(), 0.);
}

void Forces::bonds_of_kinds(const State &state, std::size_t row, std::vector<kernels::BondsOfKind> &kinds) const
{
  const std::size_t near = lattice_.index(row, 0);
  const auto from = [near](const BondFactors &factors, std::size_t kind)
  { return factors.kinds.empty() || factors.kinds[kind].empty() ? nullptr : factors.kinds[kind].data() + near; };
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    // One by one: a whole that is copied would wait for its parts.
    kernels::BondsOfKind &bonds = kinds[kind];
    bonds.constants = constants_[kind];
    bonds.shift = static_cast<std::ptrdiff_t>(lattice_.shift(kind, row));
    bonds.states = state.bonds.words(kind) + near;
    bonds.present = BondStates::bit(kind);
    bonds.toughened = BondStates::toughened_bit(kind);
    bonds.retraction_stretch = retraction_stretch_.empty() ? 0. : retraction_stretch_[kind];
    bonds.lengths = {};
    bonds.stiffness = from(state.stiffness, kind);
    bonds.strength = from(state.strength, kind);
    bonds.length_ratio = lattice_.scattered() != nullptr ? &lattice_.scattered()->length_ratios[kind][near] : nullptr;
  }
}

kernels::RowOfBonds Forces::sites_of_row(const Motion &motion, std::size_t row) const
{
  const std::size_t near = lattice_.index(row, 0);
  const State &state = motion.state;
  return {lattice_.columns(), &state.x[near],         &state.y[near],          &motion.vx[near],
          &motion.vy[near],   state.breaking_stretch, state.toughened_stretch, shortness_limit_};
}

kernels::RowOfBonds Forces::row_of_bonds(const Motion &motion, std::size_t row,
                                         std::vector<kernels::BondsOfKind> &kinds) const
{
  kinds.resize(n_kinds_);
  bonds_of_kinds(motion.state, row, kinds);
  kernels::RowOfBonds bonds = sites_of_row(motion, row);
  bonds.kinds = kinds.data();
  bonds.n_kinds = n_kinds_;
  return bonds;
}

bool Forces::row_has_events_ahead(const State &state, std::size_t row, double ahead) const
{
  std::vector<kernels::BondsOfKind> kinds;
  return kernels::any_event_ahead(row_of_bonds({state, state.vx, state.vy}, row, kinds), ahead);
}

bool Forces::row_has_short_bonds_ahead(const State &state, const Field &vx, const Field &vy, std::size_t row,
                                       double ahead, double stretch) const
{
  std::vector<kernels::BondsOfKind> kinds;
  return row_has_short_bonds(row) &&
         kernels::any_short_ahead(row_of_bonds({state, vx, vy}, row, kinds), ahead, stretch);
}

// The bonds of row `from` as those of `row`: the same, or below the edge of a periodic sheet.
kernels::RowSums Forces::bonds_of_row(const Motion &motion, std::size_t from, std::ptrdiff_t row,
                                      Scratch &scratch) const
{
  std::vector<kernels::BondsOfKind> &kinds = scratch.kinds;
  bonds_of_kinds(motion.state, from, kinds);
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
    kinds[kind].force = scratch.bonds.at(row, kind);
  kernels::RowOfBonds bonds = sites_of_row(motion, from);
  bonds.ahead = scratch.ahead.data();
  bonds.n_ahead = scratch.ahead.size();
  kernels::RowSums sums;
  std::size_t shell = 0;
  if (!has_factors(motion.state))
  {
    // The first two at once.
    bonds.kinds = kinds.data();
    bonds.n_kinds = (has_shell(1) ? 2 : 1) * n_kinds_per_shell;
    for (std::size_t kind = 0; kind < bonds.n_kinds && !scratch.lengths.empty(); ++kind)
      kinds[kind].lengths = {
        {&scratch.lengths[2 * kind * lattice_.stride()], &scratch.lengths[(2 * kind + 1) * lattice_.stride()]}};
    sums = kernels::bonds_of_row(laws_, bonds);
    shell = 2;
  }
  for (; shell < n_shells; ++shell)
    if (has_shell(shell))
    {
      bonds.kinds = &kinds[shell * n_kinds_per_shell];
      bonds.n_kinds = n_kinds_per_shell;
      kernels::bonds_of_stencil(laws_[shell], bonds, sums);
    }
  if (!row_mechanism_power_.empty())
  {
    scratch.mechanism_power.assign(row_mechanism_power_.size(), 0.);
    for (std::size_t kind = 0; kind < n_kinds_; ++kind)
      add_overstress(motion, from, bonds, kinds[kind], kind, scratch.mechanism_power);
    add_mechanisms(scratch.mechanism_power, sums.viscous_power);
  }
  // A site gathers from the places around it, so bonds that start beyond a periodic edge must be there.
  const std::size_t columns = lattice_.columns();
  if (columns_repeat_)
    for (std::size_t kind = 0; kind < n_kinds_; ++kind)
      for (double *component : kinds[kind].force)
      {
        std::copy_n(component, 2, component + columns);
        std::copy_n(component + columns - 2, 2, component - 2);
      }
  return sums;
}

// The bonds of row `from` as those of `row`, added to the sums of rows from `begin` on.
kernels::RowSums Forces::scatter_row(const Motion &motion, std::size_t from, std::ptrdiff_t row, std::ptrdiff_t begin,
                                     Scratch &scratch) const
{
  bonds_of_kinds(motion.state, from, scratch.kinds);
  scratch.mechanism_power.assign(row_mechanism_power_.size(), 0.);
  kernels::RowOfBonds sites = sites_of_row(motion, from);
  sites.n_kinds = 1;
  kernels::RowSums sums;
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    const std::ptrdiff_t rows = lattice_.rows_across(kind);
    if (row + rows < begin || !has_shell(lattice_.shell(kind)))
      continue;
    kernels::BondsOfKind &bonds = scratch.kinds[kind];
    bonds.force = {{scratch.fx.data(), scratch.fy.data()}};
    sites.kinds = &bonds;
    kernels::bonds_of_stencil(laws_[lattice_.shell(kind)], sites, sums);
    add_overstress(motion, from, sites, bonds, kind, scratch.mechanism_power);
    const std::ptrdiff_t columns = bonds.shift - rows * static_cast<std::ptrdiff_t>(lattice_.stride());
    for (std::size_t component = 0; component < 2; ++component)
      kernels::scatter(sites.n, bonds.force[component], row >= begin ? scratch.sums.at(row, component) : nullptr,
                       scratch.sums.at(row + rows, component) + columns);
  }
  add_mechanisms(scratch.mechanism_power, sums.viscous_power);
  return sums;
}

void Forces::gather_row(std::ptrdiff_t row, Scratch &scratch) const
{
  std::array<std::array<const double *, n_bond_kinds>, 2> start{}, end{};
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    const std::ptrdiff_t rows = lattice_.rows_across(kind);
    // From the place of the same column where a bond starts to the one where it ends.
    const auto columns = static_cast<std::ptrdiff_t>(lattice_.shift(kind, static_cast<std::size_t>(row + rows)) -
                                                     static_cast<std::size_t>(rows) * lattice_.stride());
    const std::array<double *, 2> starting = scratch.bonds.at(row, kind), ending = scratch.bonds.at(row - rows, kind);
    for (std::size_t component = 0; component < 2; ++component)
    {
      start[component][kind] = starting[component];
      end[component][kind] = ending[component] - columns;
    }
  }
  kernels::gather_row(lattice_.columns(), n_kinds_, start[0], end[0], scratch.fx.data());
  kernels::gather_row(lattice_.columns(), n_kinds_, start[1], end[1], scratch.fy.data());
}

void Forces::evaluate(const State &state, const Field &vx, const Field &vy)
{
  fx_.resize(lattice_.n_places());
  fy_.resize(lattice_.n_places());
  const auto keep = [this](std::size_t row, const double *fx, const double *fy)
  {
    std::copy_n(fx, lattice_.columns(), &fx_[lattice_.index(row, 0)]);
    std::copy_n(fy, lattice_.columns(), &fy_[lattice_.index(row, 0)]);
  };
  evaluate(state, vx, vy, {{}, nullptr, std::ref(keep)});
}

} // namespace latcon::lattice
