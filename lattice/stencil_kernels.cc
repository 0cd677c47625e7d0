#include "lattice/stencil_kernels.h"

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

HWY_INLINE auto mask_of(const std::uint64_t *words, std::uint64_t bit)
{
  return hn::RebindMask(D(), hn::TestBit(hn::LoadU(Bits(), words), hn::Set(Bits(), bit)));
}

template <class Law>
// cppcheck-suppress passedByValue ; copies, which no store can change
double forces_of_law(const Law law, const BondConstants bond, const BondsOfHalfBond row, double *fx, double *fy)
{
  alignas(64) double power[block] = {};
  for (std::size_t site = 0; site < row.n; site += width())
  {
    const std::size_t far = site + static_cast<std::size_t>(row.shift);
    const auto present = mask_of(row.present + site, row.bit);
    const Lanes dx = load(row.x + far) - load(row.x + site), dy = load(row.y + far) - load(row.y + site);
    const Lanes distance = square_root(dx * dx + dy * dy);
    const Lanes length{hn::IfThenElseZero(present, distance.v)};
    const Lanes inverse{hn::IfThenElseZero(present, reciprocal(distance).v)};
    const Lanes nx = dx * inverse, ny = dy * inverse;
    const Lanes rate =
      (load(row.vx + far) - load(row.vx + site)) * nx + (load(row.vy + far) - load(row.vy + site)) * ny;
    const Lanes viscous = bond.damping * rate;
    const Lanes axial =
      bond.cross_section * force(law, (1. / bond.rest_length) * length, bond.rest_length * inverse) + viscous;
    store(axial * nx, fx + site);
    store(axial * ny, fy + site);
    double *const sum = power + site % block;
    store(load(sum) + viscous * rate, sum);
  }
  double total = 0.;
  for (const double part : power)
    total += part;
  return total;
}

double BondsOfHalf(const BondLaw &law, const BondConstants &bond, const BondsOfHalfBond &row, double *fx, double *fy)
{
  return std::visit([&](const auto &of_kind) { return forces_of_law(of_kind, bond, row, fx, fy); }, law);
}

bool AnyLongerAhead(const BondsOfHalfBond &row, double ahead, double breaking, double toughened)
{
  auto longer = hn::FirstN(D(), 0);
  const Lanes limit = lanes(breaking * breaking), tough_limit = lanes(toughened * toughened);
  for (std::size_t site = 0; site < row.n; site += width())
  {
    const std::size_t far = site + static_cast<std::size_t>(row.shift);
    const Lanes square =
      squared_length_after(ahead, load(row.x + far) - load(row.x + site), load(row.y + far) - load(row.y + site),
                           load(row.vx + far) - load(row.vx + site), load(row.vy + far) - load(row.vy + site));
    const auto own = hn::IfThenElse(mask_of(row.toughened + site, row.bit), tough_limit.v, limit.v);
    longer = hn::Or(longer, hn::And(mask_of(row.present + site, row.bit), hn::Gt(square.v, own)));
  }
  return !hn::AllFalse(D(), longer);
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(BondsOfHalf);
HWY_EXPORT(AnyLongerAhead);

double bonds_of_half_bond(const BondLaw &law, const BondConstants &bond, const BondsOfHalfBond &row, double *fx,
                          double *fy)
{
  return HWY_DYNAMIC_DISPATCH(BondsOfHalf)(law, bond, row, fx, fy);
}

bool any_longer_ahead(const BondsOfHalfBond &row, double ahead, double breaking, double toughened)
{
  return HWY_DYNAMIC_DISPATCH(AnyLongerAhead)(row, ahead, breaking, toughened);
}

} // namespace latcon::lattice::kernels
#endif
