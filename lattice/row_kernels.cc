#include "lattice/row_kernels.h"

#include <algorithm>
#include <cmath>
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

#include "lattice/bond_geometry.inc"

} // namespace latcon::lattice::kernels::HWY_NAMESPACE

#include "lattice/bonds/formulas_for_vectors.inc"

namespace latcon::lattice::kernels::HWY_NAMESPACE
{

// The consecutive sites of one vector: near ends of bonds of the first two shells.
struct Sites
{
  Sites(const RowOfBonds &row, std::size_t site)
    : first(site), x(load(row.x + site)), y(load(row.y + site)), states(load_states(row.kinds[0].states + site))
  {
  }
  auto present(std::size_t kind) const { return mask_of_bit(states, BondStates::bit(kind)); }

  std::size_t first;
  Lanes x, y;
  hn::Vec<Bits> states;
};

// Lengths and inverse lengths of the bonds that start at these sites, both 0 for an absent one: it has no direction,
// hence no force. Root and quotient take as long as all the rest, in units of the processor that do nothing
// else: they are begun one vector of sites ahead of their use, so that the rest goes on meanwhile.
struct Lengths
{
  alignas(64) double length[2 * n_kinds_per_shell][block];
  alignas(64) double inverse[2 * n_kinds_per_shell][block];
};

template <std::size_t n_kinds>
HWY_INLINE void find_lengths(const RowOfBonds &row, std::size_t site, Lengths &lengths)
{
  const Sites near(row, site);
  HWY_UNROLL(6)
  for (std::size_t kind = 0; kind < n_kinds; ++kind)
  {
    const std::size_t far = site + static_cast<std::size_t>(row.kinds[kind].shift);
    const Lanes dx = load(row.x + far) - near.x, dy = load(row.y + far) - near.y;
    const Lanes length = square_root(dx * dx + dy * dy);
    const auto present = near.present(kind);
    store({hn::IfThenElseZero(present, length.v)}, lengths.length[kind]);
    store({hn::IfThenElseZero(present, reciprocal(length).v)}, lengths.inverse[kind]);
  }
}

HWY_INLINE Lanes stretch_of(const BondConstants &bond, std::size_t kind, const Lengths &lengths)
{
  return (1. / bond.rest_length) * load(lengths.length[kind]);
}

// Returns whether one of the bonds is past its own limit, or has retracted.
bool any_event(const RowOfBonds &row, std::size_t site, const Lengths &lengths)
{
  auto events = hn::FirstN(D(), 0);
  for (std::size_t kind = 0; kind < row.n_kinds; ++kind)
  {
    const BondsOfKind &bonds = row.kinds[kind];
    const Lanes stretch = stretch_of(bonds.constants, kind, lengths);
    events = hn::Or(events, are_events(row, bonds, site, stretch, [](Lanes limit) { return limit; }));
  }
  return !hn::AllFalse(D(), events);
}

// Quick test whether one of several bonds may be past a limit.
template <bool watches_retraction>
struct Extremes
{
  Lanes longest;  // stretch
  Lanes shortest; // stretch beyond that of retraction; negative for absent bonds as well

  HWY_INLINE void add(Lanes stretch, double retraction)
  {
    longest.v = hn::Max(longest.v, stretch.v);
    if constexpr (watches_retraction)
      shortest.v = hn::Min(shortest.v, (stretch - retraction).v);
  }
  HWY_INLINE bool may_be_events(double first_limit) const
  {
    auto events = hn::Gt(longest.v, lanes(first_limit).v);
    if constexpr (watches_retraction)
      events = hn::Or(events, hn::Lt(shortest.v, lanes(0.).v));
    return !hn::AllFalse(D(), events);
  }
};

// Forces of the bonds of a kind.
template <std::size_t kind, class Law, class Monitor>
HWY_INLINE void bonds_of_kind(const Law &law, const BondConstants &bond, const RowOfBonds &row, const Sites &near,
                              Lanes vx, Lanes vy, const Lengths &lengths, Lanes &power, Lanes &shortness,
                              Monitor &extremes)
{
  const std::size_t far = near.first + static_cast<std::size_t>(row.kinds[kind].shift);
  const Lanes inverse = load(lengths.inverse[kind]);
  const Lanes nx = (load(row.x + far) - near.x) * inverse, ny = (load(row.y + far) - near.y) * inverse;
  const Lanes rate = (load(row.vx + far) - vx) * nx + (load(row.vy + far) - vy) * ny;
  const Lanes stretch = stretch_of(bond, kind, lengths);
  const Lanes viscous = bond.damping * rate;
  const Lanes inverse_stretch = bond.rest_length * inverse;
  const Lanes axial = bond.cross_section * force(law, stretch, inverse_stretch) + viscous;
  store(axial * nx, row.kinds[kind].force[0] + near.first);
  store(axial * ny, row.kinds[kind].force[1] + near.first);
  power = power + viscous * rate;
  // It is 0 for absent bonds.
  if constexpr (Law::stiffens_when_short)
    shortness.v = hn::Max(shortness.v, inverse_stretch.v);
  extremes.add(stretch, row.kinds[kind].retraction_stretch);
}

struct NoBonds
{
};

template <bool watches_retraction, class Nearest, class NextNearest>
// cppcheck-suppress passedByValue ; copies, which no store can change
RowSums bonds_of_laws(const Nearest nearest, const NextNearest next_nearest, const RowOfBonds &given)
{
  constexpr bool has_next_nearest = !std::is_same_v<NextNearest, NoBonds>;
  constexpr std::size_t n_kinds = has_next_nearest ? 2 * n_kinds_per_shell : n_kinds_per_shell;
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
  Lanes power[block];
  for (Lanes &sum : power)
    sum = lanes(0.);
  Lanes shortness = lanes(0.);
  bool has_events = false;
  const std::size_t end = (row.n + block - 1) / block * block;
  Lengths lengths[2];
  find_lengths<n_kinds>(row, 0, lengths[0]);
  std::size_t turn = 0;
  for (std::size_t site = 0; site < end; site += width())
  {
    // Beyond the last site the first is done again, for nothing.
    find_lengths<n_kinds>(row, site + width() < end ? site + width() : 0, lengths[1 - turn]);
    if (site % block == 0)
      for (std::size_t i = 0; i < n_ahead; ++i)
        hwy::Prefetch(ahead[i] + site);
    const Sites near(row, site);
    const Lanes vx = load(row.vx + site), vy = load(row.vy + site);
    Lanes &sum = power[site % block / width()];
    const Lengths &here = lengths[turn];
    if (HWY_UNLIKELY(keeps_lengths))
      for (std::size_t kind = 0; kind < n_kinds; ++kind)
      {
        store(load(here.length[kind]), kinds[kind].lengths[0] + site);
        store(load(here.inverse[kind]), kinds[kind].lengths[1] + site);
      }
    Extremes<watches_retraction> extremes{lanes(0.), lanes(1e30)};
    bonds_of_kind<0>(nearest, first, row, near, vx, vy, here, sum, shortness, extremes);
    bonds_of_kind<1>(nearest, first, row, near, vx, vy, here, sum, shortness, extremes);
    bonds_of_kind<2>(nearest, first, row, near, vx, vy, here, sum, shortness, extremes);
    if constexpr (has_next_nearest)
    {
      bonds_of_kind<3>(next_nearest, second, row, near, vx, vy, here, sum, shortness, extremes);
      bonds_of_kind<4>(next_nearest, second, row, near, vx, vy, here, sum, shortness, extremes);
      bonds_of_kind<5>(next_nearest, second, row, near, vx, vy, here, sum, shortness, extremes);
    }
    // Few bonds are near a limit, so whose it is can be asked then.
    if (HWY_UNLIKELY(!has_events && extremes.may_be_events(first_limit)))
      has_events = any_event(given, site, here);
    turn = 1 - turn;
  }
  alignas(64) double sums[block];
  for (std::size_t part = 0; part < block / width(); ++part)
    store(power[part], sums + part * width());
  double total = 0.;
  for (const double sum : sums)
    total += sum;
  return {total, has_events, !hn::AllFalse(D(), hn::Gt(shortness.v, lanes(row.shortness_limit).v))};
}

RowSums BondsOfRow(const BondLaws &laws, const RowOfBonds &row)
{
  const auto of_laws = [&](const auto &nearest, const auto &next_nearest)
  {
    return row.kinds[0].retraction_stretch > 0. ? bonds_of_laws<true>(nearest, next_nearest, row)
                                                : bonds_of_laws<false>(nearest, next_nearest, row);
  };
  const auto of_nearest = [&](const auto &nearest)
  {
    if (row.n_kinds == n_kinds_per_shell)
      return of_laws(nearest, NoBonds());
    return std::visit([&](const auto &next_nearest) { return of_laws(nearest, next_nearest); }, laws[1]);
  };
  return std::visit(of_nearest, laws[0]);
}

template <std::size_t n_kinds>
HWY_INLINE void gather(std::size_t n, const std::array<const double *, n_bond_kinds> &start,
                       const std::array<const double *, n_bond_kinds> &end, double *total)
{
  for (std::size_t i = 0; i < n; i += width())
  {
    Lanes s[n_kinds], e[n_kinds];
    for (std::size_t kind = 0; kind < n_kinds; ++kind)
    {
      s[kind] = load(start[kind] + i);
      e[kind] = load(end[kind] + i);
    }
    store(sum_of_bonds<n_kinds == n_bond_kinds>(s, e), total + i);
  }
}

void GatherRow(std::size_t n, std::size_t n_kinds, const std::array<const double *, n_bond_kinds> &start,
               const std::array<const double *, n_bond_kinds> &end, double *total)
{
  if (n_kinds == n_bond_kinds)
    gather<n_bond_kinds>(n, start, end, total);
  else
    gather<2 * n_kinds_per_shell>(n, start, end, total);
}

void Drift(double h, std::size_t n, const double *acceleration, double *velocity, double *position, double *predicted)
{
  for (std::size_t i = 0; i < n; i += width())
  {
    const Lanes kick = (0.5 * h) * load(acceleration + i);
    const Lanes halfway = load(velocity + i) + kick;
    store(halfway, velocity + i);
    store(load(position + i) + h * halfway, position + i);
    store(halfway + kick, predicted + i);
  }
}

void Accelerate(std::size_t n, const double *force, const double *inverse_mass, double *acceleration)
{
  for (std::size_t i = 0; i < n; i += width())
    store(load(force + i) * load(inverse_mass + i), acceleration + i);
}

void Kick(double duration, std::size_t n, const double *force, const double *inverse_mass, double *acceleration,
          double *velocity)
{
  for (std::size_t i = 0; i < n; i += width())
  {
    const Lanes a = load(force + i) * load(inverse_mass + i);
    store(a, acceleration + i);
    store(load(velocity + i) + duration * a, velocity + i);
  }
}

void FirstStage(double duration, std::size_t n, const double *acceleration, double *position, double *velocity,
                double *start_position, double *start_velocity, double *previous_position, double *previous_velocity)
{
  for (std::size_t i = 0; i < n; i += width())
  {
    const Lanes x = load(position + i), v = load(velocity + i);
    store(x, start_position + i);
    store(x, previous_position + i);
    store(v, start_velocity + i);
    store(v, previous_velocity + i);
    store(x + duration * v, position + i);
    store(v + duration * load(acceleration + i), velocity + i);
  }
}

// Written in differences from the start, so that what stands still or flies straight does so to the last bit.
void NextStage(const ChebyshevStages::Stage &stage, double h, std::size_t n, const double *force,
               const double *inverse_mass, const double *start_acceleration, const double *start_position,
               const double *start_velocity, const double *position, const double *velocity, double *previous_position,
               double *previous_velocity)
{
  const double mu = stage.mu, nu = stage.nu, now = h * stage.now, start = h * stage.start;
  for (std::size_t i = 0; i < n; i += width())
  {
    const Lanes x = load(start_position + i), v = load(start_velocity + i), last_v = load(velocity + i);
    store(x + (mu * (load(position + i) - x) + nu * (load(previous_position + i) - x)) + (now * last_v + start * v),
          previous_position + i);
    store(v + (mu * (last_v - v) + nu * (load(previous_velocity + i) - v)) +
            (now * (load(force + i) * load(inverse_mass + i)) + start * load(start_acceleration + i)),
          previous_velocity + i);
  }
}

const char *InstructionSet()
{
  return hwy::TargetName(HWY_TARGET);
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(BondsOfRow);
HWY_EXPORT(GatherRow);
HWY_EXPORT(Drift);
HWY_EXPORT(Accelerate);
HWY_EXPORT(Kick);
HWY_EXPORT(FirstStage);
HWY_EXPORT(NextStage);
HWY_EXPORT(InstructionSet);

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

RowSums bonds_of_row(const BondLaws &laws, const RowOfBonds &row)
{
  return HWY_DYNAMIC_DISPATCH(BondsOfRow)(laws, row);
}

void gather_row(std::size_t n, std::size_t n_kinds, const std::array<const double *, n_bond_kinds> &start,
                const std::array<const double *, n_bond_kinds> &end, double *total)
{
  HWY_DYNAMIC_DISPATCH(GatherRow)(n, n_kinds, start, end, total);
}

void drift(double h, std::size_t n, const double *acceleration, double *velocity, double *position, double *predicted)
{
  HWY_DYNAMIC_DISPATCH(Drift)(h, n, acceleration, velocity, position, predicted);
}

void accelerate(std::size_t n, const double *force, const double *inverse_mass, double *acceleration)
{
  HWY_DYNAMIC_DISPATCH(Accelerate)(n, force, inverse_mass, acceleration);
}

void kick(double duration, std::size_t n, const double *force, const double *inverse_mass, double *acceleration,
          double *velocity)
{
  HWY_DYNAMIC_DISPATCH(Kick)(duration, n, force, inverse_mass, acceleration, velocity);
}

void first_stage(double duration, std::size_t n, const double *acceleration, double *position, double *velocity,
                 double *start_position, double *start_velocity, double *previous_position, double *previous_velocity)
{
  HWY_DYNAMIC_DISPATCH(FirstStage)
  (duration, n, acceleration, position, velocity, start_position, start_velocity, previous_position, previous_velocity);
}

void next_stage(const ChebyshevStages::Stage &stage, double h, std::size_t n, const double *force,
                const double *inverse_mass, const double *start_acceleration, const double *start_position,
                const double *start_velocity, const double *position, const double *velocity, double *previous_position,
                double *previous_velocity)
{
  HWY_DYNAMIC_DISPATCH(NextStage)
  (stage, h, n, force, inverse_mass, start_acceleration, start_position, start_velocity, position, velocity,
   previous_position, previous_velocity);
}

std::vector<std::string> instruction_sets()
{
  std::vector<std::string> names;
  for (const std::int64_t target : targets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

void limit_instruction_sets()
{
  (void)targets();
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

std::string instruction_set()
{
  return HWY_DYNAMIC_DISPATCH(InstructionSet)();
}

} // namespace latcon::lattice::kernels
#endif
