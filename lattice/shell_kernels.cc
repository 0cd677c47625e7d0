#include "lattice/shell_kernels.h"

#include <variant>

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/shell_kernels.cc"
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

HWY_INLINE Lanes factors_of(const std::array<const double *, n_bond_kinds> &factors, std::size_t kind, std::size_t site)
{
  return factors[kind] != nullptr ? load(factors[kind] + site) : lanes(1.);
}

// Stretches beyond which the bonds of a kind break.
template <class Mask>
HWY_INLINE Lanes limits(const RowOfBonds &row, Mask toughened, std::size_t kind, std::size_t site)
{
  const Lanes common{hn::IfThenElse(toughened, lanes(row.toughened_stretch).v, lanes(row.breaking_stretch).v)};
  return common * factors_of(row.strength, kind, site);
}

template <class Law>
// cppcheck-suppress passedByValue ; copies, which no store can change
void bonds_of_law(const Law law, const SheetConstants sheet, const RowOfBonds &given, std::size_t shell, RowSums &sums)
{
  const RowOfBonds row = given; // a copy, which no store can change
  const BondConstants bond = sheet.shells[shell];
  alignas(64) double power[block] = {};
  Lanes shortness = lanes(0.);
  auto events = hn::FirstN(D(), 0);
  const std::size_t end = (row.n + block - 1) / block * block;
  for (std::size_t site = 0; site < end; site += width())
  {
    const Sites near(row, site);
    const Lanes vx = load(row.vx + site), vy = load(row.vy + site);
    double *const sum = power + site % block;
    for (std::size_t kind = shell * n_kinds_per_shell; kind < (shell + 1) * n_kinds_per_shell; ++kind)
    {
      const std::size_t far = site + static_cast<std::size_t>(row.shift[kind]);
      const auto present = near.present(kind), toughened = near.toughened(kind);
      const Lanes dx = load(row.x + far) - near.x, dy = load(row.y + far) - near.y;
      const Lanes distance = square_root(dx * dx + dy * dy);
      const Lanes length{hn::IfThenElseZero(present, distance.v)};
      const Lanes inverse{hn::IfThenElseZero(present, reciprocal(distance).v)};
      const Lanes nx = dx * inverse, ny = dy * inverse;
      const Lanes rate = (load(row.vx + far) - vx) * nx + (load(row.vy + far) - vy) * ny;
      const Lanes stretch = (1. / bond.rest_length) * length;
      const Lanes viscous = bond.damping * rate;
      const Lanes inverse_stretch = bond.rest_length * inverse;
      const Lanes factor = factors_of(row.stiffness, kind, site);
      const Lanes axial = factor * (bond.cross_section * force(law, stretch, inverse_stretch) + viscous);
      store(axial * nx, row.force[kind][0] + site);
      store(axial * ny, row.force[kind][1] + site);
      store(load(sum) + factor * (viscous * rate), sum);
      if constexpr (Law::stiffens_when_short)
        shortness.v = hn::Max(shortness.v, inverse_stretch.v);
      const auto broken = hn::Gt(stretch.v, limits(row, toughened, kind, site).v);
      const auto retracted = hn::AndNot(toughened, hn::Lt(stretch.v, lanes(sheet.retraction_stretch[kind]).v));
      events = hn::Or(events, hn::And(present, hn::Or(broken, retracted)));
    }
  }
  for (const double part : power)
    sums.viscous_power += part;
  sums.has_events = sums.has_events || !hn::AllFalse(D(), events);
  sums.has_short_bonds =
    sums.has_short_bonds || !hn::AllFalse(D(), hn::Gt(shortness.v, lanes(sheet.shortness_limit).v));
}

void BondsOfShell(const BondLaw &law, const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell,
                  RowSums &sums)
{
  std::visit([&](const auto &of_kind) { bonds_of_law(of_kind, sheet, row, shell, sums); }, law);
}

bool AnyEventAheadInShell(const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell, double ahead)
{
  auto events = hn::FirstN(D(), 0);
  const double l = sheet.shells[shell].rest_length;
  for (std::size_t site = 0; site < row.n; site += width())
  {
    const Sites near(row, site);
    const Lanes vx = load(row.vx + site), vy = load(row.vy + site);
    for (std::size_t kind = shell * n_kinds_per_shell; kind < (shell + 1) * n_kinds_per_shell; ++kind)
    {
      const std::size_t far = site + static_cast<std::size_t>(row.shift[kind]);
      const Lanes square = squared_length_after(ahead, load(row.x + far) - near.x, load(row.y + far) - near.y,
                                                load(row.vx + far) - vx, load(row.vy + far) - vy);
      const auto toughened = near.toughened(kind);
      const Lanes longest = l * limits(row, toughened, kind, site);
      const auto retracted =
        hn::AndNot(toughened, hn::Lt(square.v, lanes(squared_length(sheet.retraction_stretch[kind], l)).v));
      events = hn::Or(events, hn::And(near.present(kind), hn::Or(hn::Gt(square.v, (longest * longest).v), retracted)));
    }
  }
  return !hn::AllFalse(D(), events);
}

void AddThirdShell(std::size_t n, const std::array<const double *, n_kinds_per_shell> &start,
                   const std::array<const double *, n_kinds_per_shell> &end, double *total)
{
  for (std::size_t i = 0; i < n; i += width())
  {
    Lanes s[n_kinds_per_shell], e[n_kinds_per_shell];
    for (std::size_t kind = 0; kind < n_kinds_per_shell; ++kind)
    {
      s[kind] = load(start[kind] + i);
      e[kind] = load(end[kind] + i);
    }
    store(load(total + i) + sum_of_third_shell(s, e), total + i);
  }
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(BondsOfShell);
HWY_EXPORT(AnyEventAheadInShell);
HWY_EXPORT(AddThirdShell);

void bonds_of_shell(const BondLaw &law, const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell,
                    RowSums &sums)
{
  HWY_DYNAMIC_DISPATCH(BondsOfShell)(law, sheet, row, shell, sums);
}

bool any_event_ahead_in_shell(const SheetConstants &sheet, const RowOfBonds &row, std::size_t shell, double ahead)
{
  return HWY_DYNAMIC_DISPATCH(AnyEventAheadInShell)(sheet, row, shell, ahead);
}

void add_third_shell(std::size_t n, const std::array<const double *, n_kinds_per_shell> &start,
                     const std::array<const double *, n_kinds_per_shell> &end, double *total)
{
  HWY_DYNAMIC_DISPATCH(AddThirdShell)(n, start, end, total);
}

} // namespace latcon::lattice::kernels
#endif
