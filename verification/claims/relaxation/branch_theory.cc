#include "verification/claims/relaxation/branch_theory.h"

#include <variant>

namespace latcon::claims
{

std::vector<BranchTheory> relaxing_branches(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                            const std::array<double, lattice::n_bond_kinds> &n_bonds,
                                            const Eigen::Matrix2d &F)
{
  std::vector<BranchTheory> branches;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
  {
    const lattice::Shell *shell = material.in_shell(number);
    const std::size_t first_kind = number * lattice::n_kinds_per_shell;
    const auto *memory = shell != nullptr ? std::get_if<lattice::MaxwellMemory>(&shell->memory) : nullptr;
    if (memory == nullptr)
      continue;
    for (const lattice::MaxwellMemory::Branch &branch : memory->branches())
    {
      BranchTheory sum{branch.relaxation_time, 0., Eigen::Matrix2d::Zero()};
      for (std::size_t kind = first_kind; kind < first_kind + lattice::n_kinds_per_shell; ++kind)
      {
        const Eigen::Vector2d R = sheet.bond_vector(kind), r = F * R;
        const double change = r.norm() / R.norm() - 1., section = lattice::cross_section(*shell, sheet);
        sum.stored += n_bonds[kind] * section * R.norm() * 0.5 * branch.modulus * change * change;
        sum.stress += section / sheet.site_area() * branch.modulus * change * r.normalized() * R.transpose();
      }
      branches.push_back(sum);
    }
  }
  return branches;
}

} // namespace latcon::claims
