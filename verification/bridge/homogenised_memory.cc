#include "verification/bridge/homogenised_memory.h"

#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "verification/bridge/homogenisation.h"

namespace latcon::bridge
{

std::unique_ptr<continuum::FibreMemory> homogenised_memory(const lattice::TriangularLattice &lattice,
                                                           const lattice::Material &material)
{
  const std::vector<continuum::BondFamily> bonds = bond_families(lattice, material);
  auto of_kind = bonds.begin();
  std::vector<continuum::MaxwellFibres> families;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    const lattice::Shell *shell = material.shell(kind);
    if (shell == nullptr)
      continue;
    const continuum::FibreFamily &fibre = of_kind++->fibre;
    if (lattice::n_variables(shell->memory) == 0)
      continue;
    const auto *memory = std::get_if<lattice::MaxwellMemory>(&shell->memory);
    if (memory == nullptr)
      throw std::invalid_argument("the continuum of bonds with a memory of another program is not supported");
    continuum::MaxwellFibres fibres{
      fibre.direction, fibre.weight, {}, material.first_mechanism(lattice::shell_of(kind))};
    for (const auto &[modulus, relaxation_time] : memory->branches())
      fibres.branches.push_back({modulus, relaxation_time});
    families.push_back(std::move(fibres));
  }
  return families.empty() ? nullptr : std::make_unique<continuum::FibreMemory>(std::move(families));
}

} // namespace latcon::bridge
