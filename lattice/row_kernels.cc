#include "lattice/row_kernels.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/row_kernels.cc"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace latcon::lattice::kernels::HWY_NAMESPACE
{

#include "lattice/lanes.inc"

#include "lattice/site_loops.inc"

// Lengths and inverse lengths of the bonds that start at these sites, both 0 for an absent one: it has no direction,
// hence no force. Root and quotient take as long as all the rest, in units of the processor that do nothing
// else: they are begun one vector of sites ahead of their use, so that the rest goes on meanwhile.
struct Lengths
{
  alignas(64) double length[2 * n_kinds_per_shell][block];
  alignas(64) double inverse[2 * n_kinds_per_shell][block];
};

// The difference of a field between the ends of bonds. @tparam has_factors whether bonds may have a length_ratio
template <bool has_factors>
HWY_INLINE Lanes difference(const BondsOfKind &bonds, const double *of_sites, std::size_t site, Lanes near)
{
  const Lanes apart = load(of_sites + site + static_cast<std::size_t>(bonds.shift)) - near;
  if constexpr (has_factors)
    return load_factors(bonds.length_ratio, site) * apart;
  else
    return apart;
}

template <std::size_t n_kinds, bool has_factors>
HWY_INLINE void find_lengths(const RowOfBonds &row, std::size_t site, Lengths &lengths)
{
  const Lanes x = load(row.x + site), y = load(row.y + site);
  const auto states = load_states(row.kinds[0].states + site);
  HWY_UNROLL(6)
  for (std::size_t kind = 0; kind < n_kinds; ++kind)
  {
    const BondsOfKind &bonds = row.kinds[kind];
    const Lanes dx = difference<has_factors>(bonds, row.x, site, x),
                dy = difference<has_factors>(bonds, row.y, site, y);
    const Lanes length = square_root(dx * dx + dy * dy);
    const auto present = mask_of_bit(states, bonds.present);
    store(where(present, length), lengths.length[kind]);
    store(where(present, reciprocal(length)), lengths.inverse[kind]);
  }
}

HWY_INLINE Lanes stretch_of(const BondConstants &bond, const double *length)
{
  return (1. / bond.rest_length) * load(length);
}

// Returns whether one of the bonds is past its own limit, or has retracted.
bool any_event(const RowOfBonds &row, std::size_t site, const Lengths &lengths)
{
  auto events = hn::FirstN(D(), 0);
  for (std::size_t kind = 0; kind < row.n_kinds; ++kind)
  {
    const BondsOfKind &bonds = row.kinds[kind];
    const Lanes stretch = stretch_of(bonds.constants, lengths.length[kind]);
    events = hn::Or(events, are_events(row, bonds, site, stretch, [](Lanes limit) { return limit; }));
  }
  return !hn::AllFalse(D(), events);
}

// Adds partial sums, whose order does not depend on the width of a vector.
HWY_INLINE double add(double total, const Lanes *parts)
{
  alignas(64) double sums[block];
  for (std::size_t part = 0; part < block / width(); ++part)
    store(parts[part], sums + part * width());
  for (const double sum : sums)
    total += sum;
  return total;
}

// Sums and extremes over bonds so far.
struct Running
{
  Lanes power, shortness, longest; // viscous power, largest inverse stretch, largest stretch
};

// Forces of the bonds of a kind.
template <bool has_factors, class Law>
HWY_INLINE void bonds_of_kind(const Law &law, const BondConstants &bond, const RowOfBonds &row,
                              const BondsOfKind &bonds, std::size_t site, Lanes x, Lanes y, Lanes vx, Lanes vy,
                              const double *length, const double *inverse_length, Running &so_far)
{
  const std::size_t far = site + static_cast<std::size_t>(bonds.shift);
  const Lanes inverse = load(inverse_length);
  Lanes nx = difference<has_factors>(bonds, row.x, site, x) * inverse,
        ny = difference<has_factors>(bonds, row.y, site, y) * inverse;
  if constexpr (has_factors)
  {
    nx = load_factors(bonds.length_ratio, site) * nx;
    ny = load_factors(bonds.length_ratio, site) * ny;
  }
  const Lanes rate = (load(row.vx + far) - vx) * nx + (load(row.vy + far) - vy) * ny;
  const Lanes stretch = stretch_of(bond, length);
  const Lanes viscous = bond.damping * rate;
  const Lanes inverse_stretch = bond.rest_length * inverse;
  Lanes axial = bond.cross_section * force(law, stretch, inverse_stretch) + viscous, power = viscous * rate;
  if constexpr (has_factors)
  {
    const Lanes factor = load_factors(bonds.stiffness, site);
    axial = factor * axial;
    power = factor * power;
  }
  store(axial * nx, bonds.force[0] + site);
  store(axial * ny, bonds.force[1] + site);
  so_far.power = so_far.power + power;
  // It is 0 for absent bonds.
  if constexpr (Law::stiffens_when_short)
    so_far.shortness.v = hn::Max(so_far.shortness.v, inverse_stretch.v);
  so_far.longest.v = hn::Max(so_far.longest.v, stretch.v);
}

// @tparam n_kinds one, those of a shell, or of two shells, of which the second has the second law
template <std::size_t n_kinds, bool has_factors, class Law, class SecondLaw>
// cppcheck-suppress passedByValue ; copies, which no store can change
void bonds_of_laws(const Law law, const SecondLaw second_law, const RowOfBonds &given, RowSums &sums)
{
  constexpr std::size_t n_first = std::min(n_kinds, n_kinds_per_shell);
  // Copies, which no store can change, as their addresses stay here.
  std::array<BondsOfKind, n_kinds> kinds;
  std::copy_n(given.kinds, n_kinds, kinds.begin());
  RowOfBonds row = given;
  row.kinds = kinds.data();
  const BondConstants first = kinds[0].constants, second = kinds[n_kinds - 1].constants;
  const double *const *const ahead = row.ahead;
  const std::size_t n_ahead = row.n_ahead;
  const double first_limit = std::min(row.breaking_stretch, row.toughened_stretch);
  const bool keeps_lengths = kinds[0].lengths[0] != nullptr;
  const bool asks_each = kinds[0].strength != nullptr || kinds[0].retraction_stretch > 0.;
  Lanes power[block];
  for (Lanes &sum : power)
    sum = lanes(0.);
  Lanes shortness = lanes(0.);
  bool has_events = false;
  const std::size_t end = (row.n + block - 1) / block * block;
  Lengths lengths[2];
  find_lengths<n_kinds, has_factors>(row, 0, lengths[0]);
  std::size_t turn = 0;
  for (std::size_t site = 0; site < end; site += width())
  {
    // Beyond the last site the first is done again, for nothing.
    find_lengths<n_kinds, has_factors>(row, site + width() < end ? site + width() : 0, lengths[1 - turn]);
    if (site % block == 0)
      for (std::size_t i = 0; i < n_ahead; ++i)
        hwy::Prefetch(ahead[i] + site);
    const Lanes x = load(row.x + site), y = load(row.y + site), vx = load(row.vx + site), vy = load(row.vy + site);
    const Lengths &here = lengths[turn];
    if (HWY_UNLIKELY(keeps_lengths))
      for (std::size_t kind = 0; kind < n_kinds; ++kind)
      {
        store(load(here.length[kind]), kinds[kind].lengths[0] + site);
        store(load(here.inverse[kind]), kinds[kind].lengths[1] + site);
      }
    Lanes &sum = power[site % block / width()];
    Running so_far{sum, shortness, lanes(0.)};
    HWY_UNROLL(3)
    for (std::size_t kind = 0; kind < n_first; ++kind)
      bonds_of_kind<has_factors>(law, first, row, kinds[kind], site, x, y, vx, vy, here.length[kind],
                                 here.inverse[kind], so_far);
    if constexpr (n_kinds > n_first)
    {
      HWY_UNROLL(3)
      for (std::size_t kind = n_first; kind < n_kinds; ++kind)
        bonds_of_kind<has_factors>(second_law, second, row, kinds[kind], site, x, y, vx, vy, here.length[kind],
                                   here.inverse[kind], so_far);
    }
    sum = so_far.power;
    shortness = so_far.shortness;
    // Few bonds are near a limit that all have, so whose it is can be asked then.
    if (HWY_UNLIKELY(!has_events && (asks_each || !hn::AllFalse(D(), hn::Gt(so_far.longest.v, lanes(first_limit).v)))))
      has_events = any_event(given, site, here);
    turn = 1 - turn;
  }
  sums.viscous_power = add(sums.viscous_power, power);
  sums.has_events = sums.has_events || has_events;
  sums.has_short_bonds = sums.has_short_bonds || !hn::AllFalse(D(), hn::Gt(shortness.v, lanes(row.shortness_limit).v));
}

void bonds_of_row(const BondLaw &law, const BondLaw &second_law, const RowOfBonds &row, RowSums &sums)
{
  const auto of_law = [&](const auto &first)
  {
    if (row.n_kinds == 1)
      bonds_of_laws<1, true>(first, first, row, sums);
    else if (row.kinds->stiffness != nullptr || row.kinds->strength != nullptr)
      bonds_of_laws<n_kinds_per_shell, true>(first, first, row, sums);
    else if (row.n_kinds == n_kinds_per_shell)
      bonds_of_laws<n_kinds_per_shell, false>(first, first, row, sums);
    else
      std::visit([&](const auto &second) { bonds_of_laws<2 * n_kinds_per_shell, false>(first, second, row, sums); },
                 second_law);
  };
  std::visit(of_law, law);
}

// @tparam n_branches of a Maxwell memory, so that their variables stay in registers; 0: any number
template <std::size_t n_branches, class Step>
// cppcheck-suppress passedByValue ; copies, which no store can change
void overstress_of_step(Step step, const RowOfBonds row, const BondsOfKind bonds, const RememberedRow remembered,
                        double *power)
{
  if constexpr (n_branches > 0)
    step.n = n_branches;
  constexpr std::size_t n_sums = n_branches > 0 ? n_branches : max_history_variables;
  Lanes sums[n_sums][block];
  for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
    for (Lanes &sum : sums[m])
      sum = lanes(0.);
  const double section = bonds.constants.cross_section, volume = section * bonds.constants.rest_length;
  double *const fx = bonds.force[0], *const fy = bonds.force[1];
  const std::size_t end = (row.n + block - 1) / block * block;
  for (std::size_t site = 0; site < end; site += width())
  {
    const auto present = mask_of_bit(load_states(bonds.states + site), bonds.present);
    const Lanes ratio = load_factors(bonds.length_ratio, site), inverse = load(bonds.lengths[1] + site);
    const Lanes nx = ratio * (difference<true>(bonds, row.x, site, load(row.x + site)) * inverse),
                ny = ratio * (difference<true>(bonds, row.y, site, load(row.y + site)) * inverse);
    const Lanes stretch = stretch_of(bonds.constants, bonds.lengths[0] + site);
    Lanes variables[n_sums], dissipation[n_sums];
    for (std::size_t v = 0; v < step.n; ++v)
      variables[v] = load(remembered.variable[v] + site);
    const Lanes stress = advance(step, load(remembered.stretch + site), stretch, variables, dissipation);
    if (remembered.new_stretch != nullptr)
    {
      for (std::size_t v = 0; v < step.n; ++v)
        store(where(present, variables[v]), remembered.new_variable[v] + site);
      store(stretch, remembered.new_stretch + site);
    }
    const Lanes factor = load_factors(bonds.stiffness, site);
    const Lanes axial = factor * (section * where(present, stress));
    store(load(fx + site) + axial * nx, fx + site);
    store(load(fy + site) + axial * ny, fy + site);
    for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
    {
      Lanes &sum = sums[m][site % block / width()];
      sum = sum + where(present, factor * dissipation[m]);
    }
  }
  for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
    power[m] += volume * add(0., sums[m]);
}

void add_overstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                    const RememberedRow &remembered, double *power)
{
  const auto of_step = [&](const auto &of_kind)
  {
    using Step = std::decay_t<decltype(of_kind)>;
    if constexpr (std::is_same_v<Step, MaxwellMemory::Step>)
    {
      if (of_kind.n == 1)
        return overstress_of_step<1>(of_kind, row, bonds, remembered, power);
      if (of_kind.n == 2)
        return overstress_of_step<2>(of_kind, row, bonds, remembered, power);
      if (of_kind.n == 3)
        return overstress_of_step<3>(of_kind, row, bonds, remembered, power);
    }
    if constexpr (!std::is_same_v<Step, NoMemory::Step>)
      overstress_of_step<0>(of_kind, row, bonds, remembered, power);
  };
  std::visit(of_step, step);
}

// Whether test(bonds of a kind, first site, vectors between the ends of bonds, their rates) holds for a bond of a row.
template <class Test>
HWY_INLINE bool any_bond(const RowOfBonds &row, const Test &test)
{
  auto found = hn::FirstN(D(), 0);
  for (std::size_t site = 0; site < row.n; site += width())
  {
    const Lanes x = load(row.x + site), y = load(row.y + site), vx = load(row.vx + site), vy = load(row.vy + site);
    for (std::size_t kind = 0; kind < row.n_kinds; ++kind)
    {
      const BondsOfKind &bonds = row.kinds[kind];
      found = hn::Or(found,
                     test(bonds, site, difference<true>(bonds, row.x, site, x), difference<true>(bonds, row.y, site, y),
                          difference<true>(bonds, row.vx, site, vx), difference<true>(bonds, row.vy, site, vy)));
    }
  }
  return !hn::AllFalse(D(), found);
}

bool any_event_ahead(const RowOfBonds &row, double ahead)
{
  return any_bond(row,
                  [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
                  {
                    const double l = bonds.constants.rest_length;
                    return are_events(row, bonds, site, squared_length_after(ahead, dx, dy, dvx, dvy),
                                      [l](Lanes stretch) { return (l * stretch) * (l * stretch); });
                  });
}

bool any_short_ahead(const RowOfBonds &row, double ahead, double stretch)
{
  return any_bond(row,
                  [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
                  {
                    // length + ahead min(product, 0) / length <= short length, without root or quotient.
                    const Lanes square = dx * dx + dy * dy, product = dx * dvx + dy * dvy;
                    const Lanes then_by_now = square + ahead * Lanes{hn::Min(product.v, lanes(0.).v)};
                    const double length = stretch * bonds.constants.rest_length;
                    const auto is_short = hn::Or(hn::Le(then_by_now.v, lanes(0.).v),
                                                 hn::Le((then_by_now * then_by_now).v, (length * length * square).v));
                    return hn::And(mask_of_bit(load_states(bonds.states + site), bonds.present), is_short);
                  });
}

const Loops &LoopsOfTarget()
{
  static const Loops loops{hwy::TargetName(HWY_TARGET),
                           bonds_of_row,
                           add_overstress,
                           gather_row,
                           scatter,
                           any_event_ahead,
                           any_short_ahead,
                           drift,
                           kick,
                           first_stage,
                           next_stage};
  return loops;
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(LoopsOfTarget);

namespace
{

// Each of a set of targets; better ones have lower bits.
std::vector<std::int64_t> split(std::int64_t targets)
{
  std::vector<std::int64_t> each;
  for (; targets != 0; targets &= targets - 1)
    each.push_back(targets & -targets);
  return each;
}

// Instruction sets that this processor has and for which the loops were compiled, up to the one that the environment
// names.
std::int64_t allowed_targets()
{
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  const char *const best = std::getenv("LATCON_INSTRUCTION_SET");
  if (best == nullptr)
    return all;
  std::string names;
  for (const std::int64_t target : split(all))
  {
    if (std::strcmp(hwy::TargetName(target), best) == 0)
    {
      const std::int64_t allowed = all & -target;
      hwy::SetSupportedTargetsForTest(allowed);
      hwy::GetChosenTarget().Update(allowed);
      return allowed;
    }
    names += std::string(names.empty() ? "" : ", ") + hwy::TargetName(target);
  }
  throw std::invalid_argument("environment variable LATCON_INSTRUCTION_SET: `" + std::string(best) +
                              "` is none of the instruction sets on this machine: " + names);
}

const std::vector<std::int64_t> &targets()
{
  static const std::vector<std::int64_t> allowed = split(allowed_targets());
  return allowed;
}

} // namespace

std::vector<std::string> instruction_sets()
{
  std::vector<std::string> names;
  for (const std::int64_t target : targets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_instruction_set(const std::string &name)
{
  for (const std::int64_t target : targets())
    if (hwy::TargetName(target) == name)
    {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      return;
    }
  throw std::invalid_argument("there is no instruction set " + name + " here");
}

const Loops &loops()
{
  return HWY_DYNAMIC_DISPATCH(LoopsOfTarget)();
}

} // namespace latcon::lattice::kernels
#endif
