#include "lattice/row_kernels.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/row_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace latcon::lattice::kernels::HWY_NAMESPACE
{

#include "lattice/lanes.inc"

#include "lattice/site_loops.inc"

// The value times the factors of bonds. @tparam has_factors whether there may be any
template <bool has_factors>
HWY_INLINE Lanes scaled(const double *factors, std::size_t site, Lanes value)
{
  if constexpr (has_factors)
    return load_factors(factors, site) * value;
  else
    return value;
}

// The difference of a field between the ends of bonds.
template <bool has_factors>
HWY_INLINE Lanes difference(const BondsOfKind &bonds, const double *of_sites, std::size_t site, Lanes near)
{
  return scaled<has_factors>(bonds.length_ratio, site,
                             load(of_sites + site + static_cast<std::size_t>(bonds.shift)) - near);
}

HWY_INLINE Lanes stretch_of(const BondConstants &bond, Lanes length)
{
  return (1. / bond.rest_length) * length;
}

// Returns whether one of the bonds is past its own limit, or has retracted. @param stretches of the bonds of each kind
bool any_event(const RowOfBonds &row, std::size_t site, const Lanes *stretches)
{
  auto events = hn::FirstN(D(), 0);
  for (std::size_t kind = 0; kind < row.n_kinds; ++kind)
    events = hn::Or(events, are_events(row, row.kinds[kind], site, stretches[kind], [](Lanes limit) { return limit; }));
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

// Forces of the bonds of a kind at sites with these positions, velocities and states of bonds. @return their stretches
template <bool has_factors, class Law>
HWY_INLINE Lanes bonds_of_kind(const Law &law, const BondConstants &bond, const RowOfBonds &row,
                               const BondsOfKind &bonds, std::size_t site, Lanes x, Lanes y, Lanes vx, Lanes vy,
                               hn::Vec<Bits> states, Running &so_far)
{
  const std::size_t far = site + static_cast<std::size_t>(bonds.shift);
  const Lanes dx = difference<has_factors>(bonds, row.x, site, x), dy = difference<has_factors>(bonds, row.y, site, y);
  // Both 0 for an absent bond: it has no direction, hence no force.
  const auto present = mask_of_bit(states, bonds.present);
  const Lanes distance = hn::Sqrt(dx * dx + dy * dy), length = hn::IfThenElseZero(present, distance),
              inverse = hn::IfThenElseZero(present, lanes(1.) / distance);
  const Lanes nx = scaled<has_factors>(bonds.length_ratio, site, dx * inverse),
              ny = scaled<has_factors>(bonds.length_ratio, site, dy * inverse);
  if (HWY_UNLIKELY(bonds.remembered != nullptr))
  {
    store(length, bonds.lengths[0] + site);
    store(inverse, bonds.lengths[1] + site);
  }
  const Lanes rate = (load(row.vx + far) - vx) * nx + (load(row.vy + far) - vy) * ny;
  const Lanes stretch = stretch_of(bond, length);
  const Lanes viscous = bond.damping * rate;
  const Lanes inverse_stretch = bond.rest_length * inverse;
  const Lanes axial =
    scaled<has_factors>(bonds.stiffness, site, bond.cross_section * force(law, stretch, inverse_stretch) + viscous);
  so_far.power = so_far.power + scaled<has_factors>(bonds.stiffness, site, viscous * rate);
  store(axial * nx, bonds.force[0] + site);
  store(axial * ny, bonds.force[1] + site);
  // It is 0 for absent bonds.
  if constexpr (Law::stiffens_when_short)
    so_far.shortness = hn::Max(so_far.shortness, inverse_stretch);
  so_far.longest = hn::Max(so_far.longest, stretch);
  return stretch;
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
  const double first_limit = std::min(row.breaking_stretch, row.toughened_stretch);
  const bool asks_each = kinds[0].strength != nullptr || kinds[0].retraction_stretch > 0.;
  Lanes power[block];
  for (Lanes &sum : power)
    sum = lanes(0.);
  Lanes shortness = lanes(0.);
  bool has_events = false;
  const std::size_t end = (row.n + block - 1) / block * block;
  for (std::size_t site = 0; site < end; site += width())
  {
    const Lanes x = load(row.x + site), y = load(row.y + site), vx = load(row.vx + site), vy = load(row.vy + site);
    const hn::Vec<Bits> states = load_states(kinds[0].states + site);
    Lanes &sum = power[site % block / width()];
    Running so_far{sum, shortness, lanes(0.)};
    Lanes stretches[n_kinds];
    HWY_UNROLL(3)
    for (std::size_t kind = 0; kind < n_first; ++kind)
      stretches[kind] = bonds_of_kind<has_factors>(law, first, row, kinds[kind], site, x, y, vx, vy, states, so_far);
    if constexpr (n_kinds > n_first)
    {
      HWY_UNROLL(3)
      for (std::size_t kind = n_first; kind < n_kinds; ++kind)
        stretches[kind] =
          bonds_of_kind<has_factors>(second_law, second, row, kinds[kind], site, x, y, vx, vy, states, so_far);
    }
    sum = so_far.power;
    shortness = so_far.shortness;
    // Few bonds are near a limit that all have, so whose it is can be asked then.
    if (HWY_UNLIKELY(!has_events && (asks_each || !hn::AllFalse(D(), hn::Gt(so_far.longest, lanes(first_limit))))))
      has_events = any_event(given, site, stretches);
  }
  sums.viscous_power = add(sums.viscous_power, power);
  sums.has_events = sums.has_events || has_events;
  sums.has_short_bonds = sums.has_short_bonds || !hn::AllFalse(D(), hn::Gt(shortness, lanes(row.shortness_limit)));
}

// Adds the overstress of the bonds of a kind to their forces.
// @tparam n_known, mechanisms_known variables and mechanisms of the memory, which stay in registers; 0: any number
template <std::size_t n_known, std::size_t mechanisms_known, class Memory>
// cppcheck-suppress passedByValue ; copies, which no store can change
void add_overstress(const Memory &memory, const RowOfBonds row, const BondsOfKind bonds, const RememberedRow remembered)
{
  const std::size_t n = n_known > 0 ? n_known : memory.n_variables;
  const std::size_t n_mechanisms = n_known > 0 ? mechanisms_known : memory.n_mechanisms;
  constexpr std::size_t n_sums = n_known > 0 ? n_known : max_history_variables;
  Lanes sums[n_sums][block];
  for (std::size_t m = 0; m < n_mechanisms; ++m)
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
    const Lanes stretch = stretch_of(bonds.constants, load(bonds.lengths[0] + site));
    Lanes variables[n_sums], dissipation[n_sums];
    for (std::size_t v = 0; v < n; ++v)
      variables[v] = load(remembered.variable[v] + site);
    const Lanes stress = advance(memory, n, load(remembered.stretch + site), stretch, variables, dissipation);
    if (remembered.new_stretch != nullptr)
    {
      for (std::size_t v = 0; v < n; ++v)
        store(hn::IfThenElseZero(present, variables[v]), remembered.new_variable[v] + site);
      store(stretch, remembered.new_stretch + site);
    }
    const Lanes factor = load_factors(bonds.stiffness, site);
    const Lanes axial = factor * (section * hn::IfThenElseZero(present, stress));
    store(load(fx + site) + axial * nx, fx + site);
    store(load(fy + site) + axial * ny, fy + site);
    for (std::size_t m = 0; m < n_mechanisms; ++m)
    {
      Lanes &sum = sums[m][site % block / width()];
      sum = sum + hn::IfThenElseZero(present, factor * dissipation[m]);
    }
  }
  for (std::size_t m = 0; m < n_mechanisms; ++m)
    // cppcheck-suppress unreadVariable ; it is the caller's
    remembered.dissipation[m] += volume * add(0., sums[m]);
}

void bonds_of_row(const RowOfBonds &row, RowSums &sums)
{
  const auto of_laws = [&](const auto &first, const auto &second)
  {
    if (row.n_kinds == 1)
      bonds_of_laws<1, true>(first, first, row, sums);
    else if (row.kinds->stiffness != nullptr || row.kinds->strength != nullptr)
      bonds_of_laws<n_kinds_per_shell, true>(first, first, row, sums);
    else if (row.n_kinds == n_kinds_per_shell)
      bonds_of_laws<n_kinds_per_shell, false>(first, first, row, sums);
    else
      bonds_of_laws<2 * n_kinds_per_shell, false>(first, second, row, sums);
  };
  std::visit(of_laws, *row.kinds[0].law, *row.kinds[row.n_kinds - 1].law);
  for (std::size_t kind = 0; kind < row.n_kinds; ++kind)
  {
    const BondsOfKind &bonds = row.kinds[kind];
    if (bonds.remembered == nullptr)
      continue;
    const auto of_memory = [&](const auto &memory)
    {
      if constexpr (std::is_same_v<std::decay_t<decltype(memory)>, MaxwellMemory>)
        switch (memory.n_variables)
        {
        case 1:
          return add_overstress<1, 1>(memory, row, bonds, *bonds.remembered);
        case 2:
          return add_overstress<2, 2>(memory, row, bonds, *bonds.remembered);
        case 3:
          return add_overstress<3, 3>(memory, row, bonds, *bonds.remembered);
        }
      if constexpr (std::is_same_v<std::decay_t<decltype(memory)>, PlasticMemory>)
        return add_overstress<2, 1>(memory, row, bonds, *bonds.remembered);
      add_overstress<0, 0>(memory, row, bonds, *bonds.remembered);
    };
    std::visit(of_memory, *bonds.remembered->memory);
  }
}

// Whether test(bonds, first site, vectors between the ends of bonds, their rates) holds for a bond of a kind.
template <bool has_factors, class Test>
// cppcheck-suppress passedByValue ; copies, which stay in registers
HWY_INLINE bool any_of_kind(const RowOfBonds row, const BondsOfKind bonds, const Test &test)
{
  auto found = hn::FirstN(D(), 0);
  const auto between_ends = [&](const double *of_sites, std::size_t site)
  { return difference<has_factors>(bonds, of_sites, site, load(of_sites + site)); };
  for (std::size_t site = 0; site < row.n; site += width())
    found = hn::Or(found, test(bonds, site, between_ends(row.x, site), between_ends(row.y, site),
                               between_ends(row.vx, site), between_ends(row.vy, site)));
  return !hn::AllFalse(D(), found);
}

// The same for all bonds of a row.
template <class Test>
HWY_INLINE bool any_bond(const RowOfBonds &row, const Test &test)
{
  return std::any_of(row.kinds, row.kinds + row.n_kinds,
                     [&](const BondsOfKind &bonds) {
                       return bonds.length_ratio != nullptr ? any_of_kind<true>(row, bonds, test)
                                                            : any_of_kind<false>(row, bonds, test);
                     });
}

bool any_event_ahead(const RowOfBonds &row, double ahead)
{
  // Few bonds are near a limit that all have, a hair less for round-off, so whose it is can be asked then.
  const double first_limit = (1. - 1e-12) * std::min(row.breaking_stretch, row.toughened_stretch);
  const auto is_near = [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
  {
    return hn::And(hn::Gt(squared_length_after(ahead, dx, dy, dvx, dvy),
                          lanes(squared_length(first_limit, bonds.constants.rest_length))),
                   mask_of_bit(load_states(bonds.states + site), bonds.present));
  };
  const auto is_event = [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
  {
    const double l = bonds.constants.rest_length;
    return are_events(row, bonds, site, squared_length_after(ahead, dx, dy, dvx, dvy),
                      [l](Lanes stretch) { return squared_length(stretch, l); });
  };
  const bool asks_each = row.kinds[0].strength != nullptr || row.kinds[0].retraction_stretch > 0.;
  return (asks_each || any_bond(row, is_near)) && any_bond(row, is_event);
}

bool any_short_ahead(const RowOfBonds &row, double ahead, double stretch)
{
  return any_bond(row,
                  [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
                  {
                    const Lanes length = hn::Sqrt(dx * dx + dy * dy), rate = (dx * dvx + dy * dvy) / length;
                    const auto is_long =
                      hn::Gt(length + ahead * hn::Min(rate, lanes(0.)), lanes(stretch * bonds.constants.rest_length));
                    return hn::AndNot(is_long, mask_of_bit(load_states(bonds.states + site), bonds.present));
                  });
}

const Loops &LoopsOfTarget()
{
  static const Loops loops{hwy::TargetName(HWY_TARGET),
                           bonds_of_row,
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

void use_targets(std::int64_t targets)
{
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(targets);
}

// Instruction sets that this processor has and for which the loops were compiled, the best first: from the one on that
// the environment names.
const std::vector<std::int64_t> &targets()
{
  static const std::vector<std::int64_t> found = []
  {
    std::vector<std::int64_t> all = hwy::SupportedAndGeneratedTargets();
    const char *const best = std::getenv("LATCON_INSTRUCTION_SET");
    if (best == nullptr)
      return all;
    std::string names;
    while (!all.empty() && hwy::TargetName(all.front()) != std::string(best))
    {
      names += (names.empty() ? "" : ", ") + std::string(hwy::TargetName(all.front()));
      all.erase(all.begin());
    }
    if (all.empty())
      throw std::invalid_argument("environment variable LATCON_INSTRUCTION_SET: `" + std::string(best) +
                                  "` is none of the instruction sets on this machine: " + names);
    use_targets(hwy::SupportedTargets() & -all.front()); // better ones have lower bits
    return all;
  }();
  return found;
}

} // namespace

std::vector<std::string> instruction_sets()
{
  std::vector<std::string> names(targets().size());
  std::transform(targets().begin(), targets().end(), names.begin(), hwy::TargetName);
  return names;
}

void use_instruction_set(const std::string &wanted)
{
  for (const std::int64_t target : targets())
    if (hwy::TargetName(target) == wanted)
      return use_targets(target);
  throw std::invalid_argument("there is no instruction set " + wanted + " here");
}

const Loops &loops()
{
  return HWY_DYNAMIC_DISPATCH(LoopsOfTarget)();
}

} // namespace latcon::lattice::kernels
#endif
