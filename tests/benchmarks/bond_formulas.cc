#include "tests/benchmarks/bond_formulas.h"

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/bond_formulas.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace latcon::lattice::kernels::HWY_NAMESPACE
{

#include "lattice/lanes.inc"

double BondFormulas(const MooneyRivlinBond &given_law, const BondConstants &given_bond, std::size_t n, const double *dx,
                    const double *dy, const double *dvx, const double *dvy, double *fx, double *fy)
{
  const MooneyRivlinBond law = given_law; // copies, which no store can change
  const BondConstants bond = given_bond;
  Lanes power = lanes(0.);
  for (std::size_t i = 0; i < n; i += width())
  {
    const Lanes x = load(dx + i), y = load(dy + i);
    const Lanes length = hn::Sqrt(x * x + y * y);
    const Lanes inverse = lanes(1.) / length;
    const Lanes nx = x * inverse, ny = y * inverse;
    const Lanes rate = load(dvx + i) * nx + load(dvy + i) * ny;
    const Lanes stretch = (1. / bond.rest_length) * length;
    const Lanes viscous = bond.damping * rate;
    const Lanes axial = bond.cross_section * force(law, stretch, bond.rest_length * inverse) + viscous;
    store(axial * nx, fx + i);
    store(axial * ny, fy + i);
    power = power + viscous * rate;
  }
  alignas(64) double parts[block] = {};
  store(power, parts);
  double total = 0.;
  for (const double part : parts)
    total += part;
  return total;
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(BondFormulas);

double bond_formulas(const MooneyRivlinBond &law, const BondConstants &bond, std::size_t n, const double *dx,
                     const double *dy, const double *dvx, const double *dvy, double *fx, double *fy)
{
  return HWY_DYNAMIC_DISPATCH(BondFormulas)(law, bond, n, dx, dy, dvx, dvy, fx, fy);
}

} // namespace latcon::lattice::kernels
#endif
