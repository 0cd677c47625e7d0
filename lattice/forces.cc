#include "lattice/forces.h"

#include <cmath>
#include <future>

#include <omp.h>

#include "support/require.h"

namespace latcon::lattice
{

Forces::Forces(const RowPartition &band, const Material &material)
  : band_(band), lattice_(band.lattice()), material_(material), n_kinds_(material.n_kinds(lattice_)),
    reach_(static_cast<std::ptrdiff_t>(lattice_.reach())),
    columns_repeat_(lattice_.is_occupied(lattice_.index(0, 0) - 1)), on_sites_(lattice_.n_places()),
    is_kept_(lattice_.rows(), false), row_sums_(lattice_.rows())
{
  kernels::instruction_sets();
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    constants_.emplace_back();
    if (const Shell *shell = material.shell(lattice_, kind))
    {
      const double rest_length = lattice_.rest_length(kind), section = cross_section(*shell, lattice_, kind);
      constants_.back() = {rest_length, section, section * shell->viscosity / rest_length};
    }
  }
  for (std::size_t number = 0; number < n_shells; ++number)
    if (const Shell *shell = material.in_shell(number))
      mechanism_gives_energy_.insert(mechanism_gives_energy_.end(), properties(shell->memory).n_mechanisms,
                                     properties(shell->memory).dissipates_energy);
}

void Forces::set_elapsed(double duration)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material_.in_shell(number))
      set_duration(shell->memory, duration);
}

void Forces::evaluate(const State &state, const VectorField &velocity, const RowFunction &post_force,
                      BondHistory *history, double lookahead, const std::function<void()> &beside)
{
  support::require(lookahead >= 0., "breaking looks ahead in time, not back");
  lookahead_ = lookahead;
  const Rows own = band_.rows();
  const bool threads = (own.end - own.begin) * lattice_.stride() >= min_places_for_threads;
  const std::size_t n_scratch = threads ? static_cast<std::size_t>(omp_get_max_threads()) : 1;
  while (scratch_.size() < n_scratch)
    scratch_.emplace_back(lattice_, n_kinds_);
  const Motion motion{state, velocity, state.history.empty() ? nullptr : history};
  const auto first = static_cast<std::ptrdiff_t>(own.begin), rows = static_cast<std::ptrdiff_t>(own.end) - first;
  const std::ptrdiff_t fewer = std::lround(fewer_rows_), least = rows > 0 ? 1 : 0;
  std::packaged_task<void()> task_beside(beside ? beside : [] {}); // keeps an exception, which cannot leave a thread
  if (band_.is_shared()) // rows may read the positions that are received in it
    task_beside();
  scratch_.back().duration = 0.; // of a thread that may not take part
  const double start = omp_get_wtime();
#pragma omp parallel if (threads)
  {
    const std::ptrdiff_t n = omp_get_num_threads(), i = omp_get_thread_num();
    const auto bound = [&](std::ptrdiff_t thread)
    { return first + (thread == 0 ? 0 : std::clamp((rows + fewer) * thread / n - fewer, least, rows)); };
    const std::ptrdiff_t begin = bound(i), end = bound(i + 1);
    Scratch &scratch = scratch_[static_cast<std::size_t>(i)];
    if (i == 0 && !band_.is_shared())
      task_beside();
    evaluate_rows(motion, begin, end, scratch, post_force);
    scratch.duration = omp_get_wtime() - start;
    if (motion.history != nullptr)
    {
      // The rows whose bonds the thread above computed too, and those below the band.
#pragma omp barrier
      for (std::ptrdiff_t row = std::max(begin, end - reach_); row < end; ++row)
        bonds_of_row(motion, static_cast<std::size_t>(row), row, row, scratch);
      for (std::ptrdiff_t below = first - reach_; i == 0 && below < first; ++below)
        if (const auto row = lattice_.row(below); row && (*row < own.begin || *row >= own.end))
          bonds_of_row(motion, *row, below, below, scratch);
    }
  }
  const auto n_all = static_cast<double>(scratch_.size()), n_rows = static_cast<double>(rows);
  // Half of what would make all end at once if all rows took the same time.
  if (const double of_first = scratch_[0].duration, of_last = scratch_.back().duration; n_all > 1. && of_last > 0.)
    fewer_rows_ = std::clamp(fewer_rows_ + n_rows / n_all * (of_first - of_last) / (of_first + of_last), -n_rows,
                             n_rows / (n_all - 1.));
  task_beside.get_future().get();
  if (motion.history != nullptr)
    set_elapsed(0.);
}

void Forces::evaluate_rows(const Motion &updating, std::ptrdiff_t begin, std::ptrdiff_t end, Scratch &scratch,
                           const RowFunction &post_force)
{
  if (begin == end)
    return;
  const Motion motion{updating.state, updating.velocity};
  scratch.sums.clear();
  for (std::ptrdiff_t row = begin - reach_; row < begin; ++row)
    if (const auto from = lattice_.row(row))
      bonds_of_row(motion, *from, row, begin, scratch);
    else
      for (LastRows &bonds : scratch.bonds)
        bonds.clear(row);
  for (std::ptrdiff_t row = begin; row < end; ++row)
  {
    const auto index = static_cast<std::size_t>(row);
    const Motion &of_row = row < end - reach_ ? updating : motion;
    row_sums_[index] = bonds_of_row(of_row, index, row, begin, scratch);
    if (lookahead_ > 0.)
      row_sums_[index].has_events =
        kernels::loops().any_event_ahead(row_of_bonds(motion, index, scratch.kinds), lookahead_);
    const OfRow on_sites = scratch.sums.at(row);
    // What bonds across a periodic edge do to images of sites is done to the sites.
    const auto columns = static_cast<std::ptrdiff_t>(lattice_.columns());
    if (lattice_.is_triangular())
      gather_row(row, scratch);
    else if (columns_repeat_)
      for (double *const sum : on_sites)
        for (std::ptrdiff_t c = 0; c < static_cast<std::ptrdiff_t>(lattice_.column_reach()); ++c)
        {
          sum[c] += sum[columns + c];
          sum[columns - 1 - c] += sum[-1 - c];
        }
    for (std::size_t axis = 0; axis < 2 && is_kept_[index]; ++axis)
      std::copy_n(on_sites[axis], lattice_.columns(), &on_sites_[axis][lattice_.index(index, 0)]);
    if (post_force)
      post_force(index, on_sites);
    if (!lattice_.is_triangular())
      scratch.sums.clear(row);
  }
}

kernels::RowOfBonds Forces::row_of_bonds(const Motion &motion, std::size_t row,
                                         std::vector<kernels::BondsOfKind> &kinds) const
{
  const std::size_t near = lattice_.index(row, 0);
  const State &state = motion.state;
  kinds.resize(n_kinds_);
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    // One by one: a whole that is copied would wait for its parts.
    kernels::BondsOfKind &bonds = kinds[kind];
    const Shell *const shell = material_.shell(lattice_, kind);
    bonds.law = shell != nullptr ? &shell->law : nullptr;
    bonds.constants = constants_[kind];
    bonds.shift = static_cast<std::ptrdiff_t>(lattice_.shift(kind, row));
    bonds.states = state.bonds.words(kind) + near;
    bonds.present = BondStates::bit(kind);
    bonds.toughened = BondStates::toughened_bit(kind);
    bonds.retraction_stretch = retraction_stretch_.empty() ? 0. : retraction_stretch_[kind];
    bonds.stiffness = state.stiffness.from(near, kind);
    bonds.strength = state.strength.from(near, kind);
    bonds.remembered = nullptr;
    bonds.length_ratio = lattice_.scattered() != nullptr ? &lattice_.scattered()->length_ratios[kind][near] : nullptr;
  }
  const auto &[x, y] = state.position;
  const auto &[vx, vy] = motion.velocity;
  return {lattice_.columns(),      &x[near],         &y[near],     &vx[near], &vy[near], state.breaking_stretch,
          state.toughened_stretch, shortness_limit_, kinds.data(), n_kinds_};
}

bool Forces::row_has_short_bonds_ahead(const State &state, const VectorField &velocity, std::size_t row, double ahead,
                                       double stretch) const
{
  std::vector<kernels::BondsOfKind> kinds;
  return row_sums(row).has_short_bonds &&
         kernels::loops().any_short_ahead(row_of_bonds({state, velocity}, row, kinds), ahead, stretch);
}

void Forces::remember(const Motion &motion, std::size_t row, std::size_t kind, double *mechanism_power,
                      Scratch &scratch) const
{
  const std::size_t near = lattice_.index(row, 0);
  const BondHistory::Kind &history = motion.state.history.kinds[kind];
  BondHistory::Kind *const updated = motion.history != nullptr ? &motion.history->kinds[kind] : nullptr;
  // In place, part by part: see row_of_bonds().
  kernels::RememberedRow &remembered = scratch.remembered[kind];
  remembered.memory = &material_.shell(lattice_, kind)->memory;
  remembered.stretch = &history.stretch[near];
  remembered.new_stretch = updated != nullptr ? &updated->stretch[near] : nullptr;
  for (std::size_t v = 0; v < history.variables.size(); ++v)
  {
    remembered.variable[v] = &history.variables[v][near];
    remembered.new_variable[v] = updated != nullptr ? &updated->variables[v][near] : nullptr;
  }
  remembered.dissipation = &mechanism_power[material_.first_mechanism(lattice_.shell(kind))];
  scratch.kinds[kind].remembered = &remembered;
}

// The bonds of row `from` as those of `row`: the same, or below the edge of a periodic sheet. Those of stencils other
// than the triangular lattice are added to the sums of rows from `begin` on.
kernels::RowSums Forces::bonds_of_row(const Motion &motion, std::size_t from, std::ptrdiff_t row, std::ptrdiff_t begin,
                                      Scratch &scratch) const
{
  const bool gathers = lattice_.is_triangular();
  const bool has_factors = !motion.state.stiffness.empty() || !motion.state.strength.empty();
  const std::size_t columns = lattice_.columns();
  std::vector<kernels::BondsOfKind> &kinds = scratch.kinds;
  kernels::RowOfBonds bonds = row_of_bonds(motion, from, kinds);
  scratch.remembered.resize(n_kinds_);
  kernels::RowSums sums{0., std::vector<double>(mechanism_gives_energy_.size())};
  for (std::size_t first = 0; first < n_kinds_; first += bonds.n_kinds)
  {
    // The first two shells of the lattice at once.
    bonds.n_kinds =
      !gathers ? 1 : (first == 0 && material_.next_nearest && !has_factors ? 2 * n_kinds_per_shell : n_kinds_per_shell);
    const std::ptrdiff_t rows = lattice_.rows_across(first);
    if (kinds[first].law == nullptr || (!gathers && row + rows < begin))
      continue;
    bonds.kinds = &kinds[first];
    for (std::size_t kind = first; kind < first + bonds.n_kinds; ++kind)
    {
      kinds[kind].force = scratch.bonds[gathers ? kind : 0].at(row);
      double *const lengths = &scratch.lengths[2 * (kind - first) * lattice_.stride()];
      kinds[kind].lengths = {lengths, lengths + lattice_.stride()};
      if (motion.state.history.remembers(kind))
        remember(motion, from, kind, sums.mechanism_power.data(), scratch);
    }
    kernels::loops().bonds_of_row(bonds, sums);
    // A site gathers from the places around it, so bonds that start beyond a periodic edge must be there.
    for (std::size_t kind = first; kind < first + bonds.n_kinds && gathers && columns_repeat_; ++kind)
      for (double *component : kinds[kind].force)
      {
        std::copy_n(component, 2, component + columns);
        std::copy_n(component + columns - 2, 2, component - 2);
      }
    const std::ptrdiff_t to = kinds[first].shift - rows * static_cast<std::ptrdiff_t>(lattice_.stride());
    for (std::size_t component = 0; component < 2 && !gathers; ++component)
      kernels::loops().scatter(columns, kinds[first].force[component],
                               row >= begin ? scratch.sums.at(row)[component] : nullptr,
                               scratch.sums.at(row + rows)[component] + to);
  }
  for (std::size_t m = 0; m < sums.mechanism_power.size(); ++m)
    if (!mechanism_gives_energy_[m])
      sums.viscous_power += sums.mechanism_power[m];
  return sums;
}

void Forces::gather_row(std::ptrdiff_t row, Scratch &scratch) const
{
  std::array<std::array<const double *, n_bond_kinds>, 2> start{}, end{};
  for (std::size_t kind = 0; kind < n_kinds_; ++kind)
  {
    const std::ptrdiff_t rows = lattice_.rows_across(kind);
    // From the place of the same column where a bond starts to the one where it ends.
    const std::ptrdiff_t columns = lattice_.columns_across(kind, static_cast<std::size_t>(row + rows));
    const std::array<double *, 2> starting = scratch.bonds[kind].at(row), ending = scratch.bonds[kind].at(row - rows);
    for (std::size_t component = 0; component < 2; ++component)
    {
      start[component][kind] = starting[component];
      end[component][kind] = ending[component] - columns;
    }
  }
  kernels::loops().gather_row(lattice_.columns(), n_kinds_, start[0], end[0], scratch.sums.at(row)[0]);
  kernels::loops().gather_row(lattice_.columns(), n_kinds_, start[1], end[1], scratch.sums.at(row)[1]);
}

void Forces::evaluate(const State &state, const VectorField &velocity)
{
  is_kept_.assign(is_kept_.size(), true);
  evaluate(state, velocity, {});
}

void Forces::evaluate_row(const State &state, const VectorField &velocity, std::size_t row,
                          const RowFunction &post_force)
{
  const auto number = static_cast<std::ptrdiff_t>(row);
  evaluate_rows({state, velocity}, number, number + 1, scratch_.front(), post_force);
}

} // namespace latcon::lattice
