#include "lattice/stencil_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/stencil_kernels.cc"
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

template <std::size_t n_kinds, bool own_lengths, class Law>
// cppcheck-suppress passedByValue ; copies, which no store can change
void bonds_of_law(const Law law, const RowOfBonds row, RowSums &sums)
{
  std::array<BondsOfKind, n_kinds> kinds;
  std::copy_n(row.kinds, n_kinds, kinds.begin());
  const double first_limit = std::min(row.breaking_stretch, row.toughened_stretch);
  alignas(64) double power[block] = {};
  Lanes shortness = lanes(0.);
  auto events = hn::FirstN(D(), 0);
  const std::size_t end = (row.n + block - 1) / block * block;
  for (std::size_t site = 0; site < end; site += width())
  {
    const Lanes x = load(row.x + site), y = load(row.y + site), vx = load(row.vx + site), vy = load(row.vy + site);
    double *const sum = power + site % block;
    HWY_UNROLL(3)
    for (std::size_t kind = 0; kind < n_kinds; ++kind)
    {
      const BondsOfKind &bonds = kinds[kind];
      const BondConstants &bond = bonds.constants;
      const std::size_t far = site + static_cast<std::size_t>(bonds.shift);
      const auto present = mask_of_bit(load_states(bonds.states + site), bonds.present);
      Lanes dx = load(row.x + far) - x, dy = load(row.y + far) - y;
      if constexpr (own_lengths)
      {
        dx = load(bonds.length_ratio + site) * dx;
        dy = load(bonds.length_ratio + site) * dy;
      }
      const Lanes distance = square_root(dx * dx + dy * dy);
      const Lanes length{hn::IfThenElseZero(present, distance.v)};
      const Lanes inverse{hn::IfThenElseZero(present, reciprocal(distance).v)};
      Lanes nx = dx * inverse, ny = dy * inverse;
      if constexpr (own_lengths)
      {
        nx = load(bonds.length_ratio + site) * nx;
        ny = load(bonds.length_ratio + site) * ny;
      }
      const Lanes rate = (load(row.vx + far) - vx) * nx + (load(row.vy + far) - vy) * ny;
      const Lanes stretch = (1. / bond.rest_length) * length;
      const Lanes viscous = bond.damping * rate;
      const Lanes inverse_stretch = bond.rest_length * inverse;
      const Lanes factor = load_factors(bonds.stiffness, site);
      const Lanes axial = factor * (bond.cross_section * force(law, stretch, inverse_stretch) + viscous);
      store(axial * nx, bonds.force[0] + site);
      store(axial * ny, bonds.force[1] + site);
      store(load(sum) + factor * (viscous * rate), sum);
      if constexpr (Law::stiffens_when_short)
        shortness.v = hn::Max(shortness.v, inverse_stretch.v);
      // Few bonds are near a limit that all have.
      if (bonds.strength != nullptr || bonds.retraction_stretch > 0. ||
          HWY_UNLIKELY(!hn::AllFalse(D(), hn::Gt(stretch.v, lanes(first_limit).v))))
        events = hn::Or(events, are_events(row, bonds, site, stretch, [](Lanes limit) { return limit; }));
    }
  }
  for (const double part : power)
    sums.viscous_power += part;
  sums.has_events = sums.has_events || !hn::AllFalse(D(), events);
  sums.has_short_bonds = sums.has_short_bonds || !hn::AllFalse(D(), hn::Gt(shortness.v, lanes(row.shortness_limit).v));
}

void BondsOfStencil(const BondLaw &law, const RowOfBonds &row, RowSums &sums)
{
  const auto of_kinds = [&](const auto &of_law)
  {
    if (row.n_kinds == n_kinds_per_shell)
      bonds_of_law<n_kinds_per_shell, false>(of_law, row, sums);
    else if (row.kinds->length_ratio != nullptr)
      bonds_of_law<1, true>(of_law, row, sums);
    else
      bonds_of_law<1, false>(of_law, row, sums);
  };
  std::visit(of_kinds, law);
}

void Scatter(std::size_t n, const double *force, double *near, double *far)
{
  const std::size_t vectors = n / width() * width();
  if (near != nullptr)
  {
    for (std::size_t i = 0; i < vectors; i += width())
      store(load(near + i) + load(force + i), near + i);
    for (std::size_t i = vectors; i < n; ++i)
      near[i] += force[i];
  }
  for (std::size_t i = 0; i < vectors; i += width())
    store(load(far + i) - load(force + i), far + i);
  for (std::size_t i = vectors; i < n; ++i)
    far[i] -= force[i];
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
      const std::size_t far = site + static_cast<std::size_t>(bonds.shift);
      const Lanes ratio = load_factors(bonds.length_ratio, site);
      found = hn::Or(found, test(bonds, site, ratio * (load(row.x + far) - x), ratio * (load(row.y + far) - y),
                                 ratio * (load(row.vx + far) - vx), ratio * (load(row.vy + far) - vy)));
    }
  }
  return !hn::AllFalse(D(), found);
}

bool AnyEventAhead(const RowOfBonds &row, double ahead)
{
  return any_bond(row,
                  [&](const BondsOfKind &bonds, std::size_t site, Lanes dx, Lanes dy, Lanes dvx, Lanes dvy)
                  {
                    const double l = bonds.constants.rest_length;
                    return are_events(row, bonds, site, squared_length_after(ahead, dx, dy, dvx, dvy),
                                      [l](Lanes stretch) { return (l * stretch) * (l * stretch); });
                  });
}

bool AnyShortAhead(const RowOfBonds &row, double ahead, double stretch)
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

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(BondsOfStencil);
HWY_EXPORT(Scatter);
HWY_EXPORT(AnyEventAhead);
HWY_EXPORT(AnyShortAhead);

void bonds_of_stencil(const BondLaw &law, const RowOfBonds &row, RowSums &sums)
{
  HWY_DYNAMIC_DISPATCH(BondsOfStencil)(law, row, sums);
}

void scatter(std::size_t n, const double *force, double *near, double *far)
{
  HWY_DYNAMIC_DISPATCH(Scatter)(n, force, near, far);
}

bool any_event_ahead(const RowOfBonds &row, double ahead)
{
  return HWY_DYNAMIC_DISPATCH(AnyEventAhead)(row, ahead);
}

bool any_short_ahead(const RowOfBonds &row, double ahead, double stretch)
{
  return HWY_DYNAMIC_DISPATCH(AnyShortAhead)(row, ahead, stretch);
}

BondForce bond_force(const BondLaw &law, const BondConstants &bond, double factor, double dx, double dy, double dvx,
                     double dvy, double length_ratio)
{
  dx *= length_ratio;
  dy *= length_ratio;
  const double distance = std::sqrt(dx * dx + dy * dy);
  const double inverse = 1. / distance;
  const double nx = length_ratio * (dx * inverse), ny = length_ratio * (dy * inverse);
  const double rate = dvx * nx + dvy * ny;
  const double stretch = (1. / bond.rest_length) * distance;
  const double viscous = bond.damping * rate;
  const double axial =
    factor * (bond.cross_section * std::visit([&](const auto &of_kind)
                                              { return formulas::force(of_kind, stretch, bond.rest_length * inverse); },
                                              law) +
              viscous);
  return {axial * nx, axial * ny, nx, ny, stretch, factor * (viscous * rate)};
}

} // namespace latcon::lattice::kernels
#endif
