#pragma once

#include <type_traits>
#include <variant>

#include "lattice/bonds/formulas.h"

/// @file
/// Memories of bonds: overstresses q that depend on the past of a bond through a number of variables per bond,
///   sigma = psi'(lam) + eta lam' + q   (theory.md, eq. (L.27)).
///
/// A memory declares its number of variables, the mechanisms by which it stores and dissipates energy, and a bound on
/// its stiffness; its `Step` has what an update over one duration needs, and `advance` is its formula (formulas.inc).
/// Variables are 0 at rest and are stored by BondHistory. `advance` gives the power that each mechanism
/// dissipates at the end of an update, or, if `Step::dissipates_energy`, the energy that it dissipates in the update.
namespace latcon::lattice
{

/// No memory: costs nothing.
struct NoMemory
{
  std::size_t n_variables() const { return 0; }
  std::size_t n_mechanisms() const { return 0; }
  double largest_stiffness() const { return 0.; }
  double stored_energy(std::size_t /*mechanism*/, double /*stretch*/, const double * /*variables*/) const { return 0.; }
  /// Update over one duration.
  struct Step
  {
    static constexpr bool dissipates_energy = false; ///< see above
  };
  Step step(double /*duration*/) const { return {}; }
};

/// Memory of the bonds of one shell.
using BondMemory = std::variant<NoMemory, MaxwellMemory, PlasticMemory, CustomMemory>;
/// Its update over one duration.
using MemoryStep = std::variant<NoMemory::Step, MaxwellMemory::Step, PlasticMemory::Step, CustomMemory::Step>;

/// Number of variables per bond.
inline std::size_t n_variables(const BondMemory &memory)
{
  return std::visit([](const auto &m) { return m.n_variables(); }, memory);
}
/// Returns whether an update gives the energy that each mechanism dissipates, and not its power.
inline bool dissipates_energy(const MemoryStep &step)
{
  return std::visit([](const auto &s) { return s.dissipates_energy; }, step);
}
/// Number of mechanisms whose energies are recorded one by one, at most n_variables(): branches of a MaxwellMemory.
inline std::size_t n_mechanisms(const BondMemory &memory)
{
  return std::visit([](const auto &m) { return m.n_mechanisms(); }, memory);
}
/// Bound on dq/dlam in fast motion [Pa].
inline double largest_stiffness(const BondMemory &memory)
{
  return std::visit([](const auto &m) { return m.largest_stiffness(); }, memory);
}
/// Energy that one mechanism stores per reference volume of a bond [Pa].
inline double stored_energy(const BondMemory &memory, std::size_t mechanism, double stretch, const double *variables)
{
  return std::visit([&](const auto &m) { return m.stored_energy(mechanism, stretch, variables); }, memory);
}
/// Overstress of a bond after an update of its variables by the formula of its memory [Pa].
/// @param dissipation of each mechanism, see above
inline double advance(const MemoryStep &step, double before, double now, double *variables, double *dissipation)
{
  const auto of_kind = [&](const auto &s) -> double
  {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, NoMemory::Step>)
      return 0.;
    else
      return formulas::advance(s, before, now, variables, dissipation);
  };
  return std::visit(of_kind, step);
}
/// Update over `duration` [s], >= 0.
inline MemoryStep memory_step(const BondMemory &memory, double duration)
{
  return std::visit([duration](const auto &m) { return MemoryStep(m.step(duration)); }, memory);
}

} // namespace latcon::lattice
