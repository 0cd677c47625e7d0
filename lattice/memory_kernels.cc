#include "lattice/memory_kernels.h"

#include <type_traits>
#include <variant>

#include "lattice/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/memory_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace latcon::lattice::kernels::HWY_NAMESPACE
{

#include "lattice/lanes.inc"

} // namespace latcon::lattice::kernels::HWY_NAMESPACE

#include "lattice/bonds/formulas_for_vectors.inc"

namespace latcon::lattice::kernels::HWY_NAMESPACE
{

// Stretches and directions of bonds as bonds_of_row computes them, both 0 for absent bonds; from the lengths that it
// kept, if it did.
struct Directions
{
  HWY_INLINE Directions(const RowOfBonds &row, const BondsOfKind &bonds, std::size_t site)
  {
    const std::size_t far = site + static_cast<std::size_t>(bonds.shift);
    const Lanes ratio = load_factors(bonds.length_ratio, site);
    const Lanes dx = ratio * (load(row.x + far) - load(row.x + site)),
                dy = ratio * (load(row.y + far) - load(row.y + site));
    present = hn::VecFromMask(D(), mask_of_bit(load_states(bonds.states + site), bonds.present));
    Lanes length, inverse;
    if (bonds.lengths[0] != nullptr)
    {
      length = load(bonds.lengths[0] + site);
      inverse = load(bonds.lengths[1] + site);
    }
    else
    {
      const Lanes distance = square_root(dx * dx + dy * dy);
      length = where_present(distance);
      inverse = where_present(reciprocal(distance));
    }
    nx = ratio * (dx * inverse);
    ny = ratio * (dy * inverse);
    stretch = (1. / bonds.constants.rest_length) * length;
  }
  HWY_INLINE Lanes where_present(Lanes value) const { return {hn::IfThenElseZero(hn::MaskFromVec(present), value.v)}; }

  Vector present;
  Lanes nx, ny, stretch;
};

// @tparam n_branches of a Maxwell memory, so that their variables stay in registers; 0: any number
template <std::size_t n_branches, class Step, class Pointer>
// cppcheck-suppress passedByValue ; copies, which no store can change
void add_overstress_of(Step step, const RowOfBonds row, const BondsOfKind bonds,
                       const RememberedRow<Pointer> remembered, double *power)
{
  if constexpr (n_branches > 0)
    step.n = n_branches;
  // Partial sums whose order does not depend on the width of a vector.
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
    const Directions now(row, bonds, site);
    Lanes variables[n_sums], dissipation[n_sums];
    for (std::size_t v = 0; v < step.n; ++v)
      variables[v] = load(remembered.variable[v] + site);
    const Lanes stress = advance(step, load(remembered.stretch + site), now.stretch, variables, dissipation);
    if constexpr (std::is_same_v<Pointer, double *>)
    {
      for (std::size_t v = 0; v < step.n; ++v)
        store(now.where_present(variables[v]), remembered.variable[v] + site);
      store(now.stretch, remembered.stretch + site);
    }
    Lanes axial = section * now.where_present(stress);
    if (bonds.stiffness != nullptr)
    {
      const Lanes factor = load(bonds.stiffness + site);
      axial = factor * axial;
      for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
        dissipation[m] = factor * dissipation[m];
    }
    store(load(fx + site) + axial * now.nx, fx + site);
    store(load(fy + site) + axial * now.ny, fy + site);
    for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
    {
      Lanes &sum = sums[m][site % block / width()];
      sum = sum + now.where_present(dissipation[m]);
    }
  }
  for (std::size_t m = 0; m < step.n_mechanisms(); ++m)
  {
    alignas(64) double parts[block];
    for (std::size_t part = 0; part < block / width(); ++part)
      store(sums[m][part], parts + part * width());
    double total = 0.;
    for (const double part : parts)
      total += part;
    power[m] += volume * total;
  }
}
template <class Pointer>
void add_overstress_of_step(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                            const RememberedRow<Pointer> &remembered, double *power)
{
  const auto of_step = [&](const auto &of_kind)
  {
    using Step = std::decay_t<decltype(of_kind)>;
    if constexpr (std::is_same_v<Step, MaxwellMemory::Step>)
    {
      if (of_kind.n == 1)
        return add_overstress_of<1>(of_kind, row, bonds, remembered, power);
      if (of_kind.n == 2)
        return add_overstress_of<2>(of_kind, row, bonds, remembered, power);
      if (of_kind.n == 3)
        return add_overstress_of<3>(of_kind, row, bonds, remembered, power);
    }
    if constexpr (!std::is_same_v<Step, NoMemory::Step>)
      add_overstress_of<0>(of_kind, row, bonds, remembered, power);
  };
  std::visit(of_step, step);
}

void AddOverstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                   const RememberedRow<const double *> &remembered, double *power)
{
  add_overstress_of_step(step, row, bonds, remembered, power);
}

void UpdateOverstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                      const RememberedRow<double *> &remembered, double *power)
{
  add_overstress_of_step(step, row, bonds, remembered, power);
}

} // namespace latcon::lattice::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace latcon::lattice::kernels
{

HWY_EXPORT(AddOverstress);
HWY_EXPORT(UpdateOverstress);

void add_overstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                    const RememberedRow<const double *> &remembered, double *power)
{
  HWY_DYNAMIC_DISPATCH(AddOverstress)(step, row, bonds, remembered, power);
}

void add_overstress(const MemoryStep &step, const RowOfBonds &row, const BondsOfKind &bonds,
                    const RememberedRow<double *> &remembered, double *power)
{
  HWY_DYNAMIC_DISPATCH(UpdateOverstress)(step, row, bonds, remembered, power);
}

Overstress overstress(const MemoryStep &step, const BondConstants &bond, double stretch, std::size_t place,
                      const RememberedRow<const double *> &remembered)
{
  const auto of_bond = [&](const auto &s) -> Overstress
  {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, NoMemory::Step>)
      return {0., {}};
    else
    {
      std::array<double, max_history_variables> variables{};
      for (std::size_t v = 0; v < s.n; ++v)
        variables[v] = remembered.variable[v][place];
      Overstress result{0., {}};
      result.axial = bond.cross_section * formulas::advance(s, remembered.stretch[place], stretch, variables.data(),
                                                            result.dissipation.data());
      for (double &power : result.dissipation)
        power *= bond.cross_section * bond.rest_length;
      return result;
    }
  };
  return std::visit(of_bond, step);
}

} // namespace latcon::lattice::kernels
#endif
