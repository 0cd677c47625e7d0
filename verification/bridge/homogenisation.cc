#include "verification/bridge/homogenisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include "continuum/errors.h"
#include "continuum/expression_potential.h"
#include "lattice/bonds/expression_law.h"
#include "lattice/bonds/library_law.h"
#include "support/fits.h"
#include "support/largest_error.h"

namespace latcon::bridge
{
namespace
{

class LibraryPotential : public continuum::CustomPotentialLaw
{
public:
  explicit LibraryPotential(std::shared_ptr<const lattice::LibraryLaw> law) : law_(std::move(law)) {}
  continuum::PotentialDerivatives derivatives(double l) const override
  {
    const std::array<double, 5> psi = law_->derivatives(l);
    return {psi[0], psi[1], psi[2], psi[3], psi[4]};
  }

private:
  std::shared_ptr<const lattice::LibraryLaw> law_;
};

// Returns the potential of a custom law, made at the first call for a shell. From an expression the continuum takes the
// energy alone; from a library it takes the derivatives, of which psi'' is also that of the lattice.
continuum::CustomPotential custom_potential(const lattice::Shell &shell, continuum::CustomPotential &of_shell)
{
  const auto &law = std::get<lattice::CustomBond>(shell.law).law();
  if (of_shell.law)
    return of_shell;
  if (const auto expression = std::dynamic_pointer_cast<const lattice::ExpressionLaw>(law))
    of_shell.law = std::make_shared<continuum::ExpressionPotential>(expression->psi());
  else if (const auto library = std::dynamic_pointer_cast<const lattice::LibraryLaw>(law))
    of_shell.law = std::make_shared<LibraryPotential>(library);
  else
    throw std::invalid_argument("the continuum of bonds with a law of another program is not supported");
  return of_shell;
}

dealii::Tensor<1, 2> direction_of(const lattice::TriangularLattice &lattice, std::size_t kind)
{
  const Eigen::Vector2d direction = lattice.bond_vector(kind).normalized();
  return dealii::Tensor<1, 2>({direction.x(), direction.y()});
}

// Number of points along the path; the fit covers the whole path, not only its end.
constexpr int path_points = 40;

Eigen::Matrix2d on_path(const Eigen::Matrix2d &F, int point)
{
  const double t = static_cast<double>(point) / path_points;
  return Eigen::Matrix2d::Identity() + t * (F - Eigen::Matrix2d::Identity());
}

} // namespace

dealii::Tensor<2, 2> to_continuum(const Eigen::Matrix2d &F)
{
  return dealii::Tensor<2, 2>({{F(0, 0), F(0, 1)}, {F(1, 0), F(1, 1)}});
}

Eigen::Matrix2d to_lattice(const dealii::Tensor<2, 2> &F)
{
  return Eigen::Matrix2d{{F[0][0], F[0][1]}, {F[1][0], F[1][1]}};
}

std::vector<continuum::BondFamily> bond_families(const lattice::TriangularLattice &lattice,
                                                 const lattice::Material &material)
{
  std::vector<continuum::BondFamily> families;
  std::array<continuum::CustomPotential, lattice::n_shells> custom; // one for all bonds of a shell
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      continuum::FibreFamily family;
      family.direction = direction_of(lattice, kind);
      family.weight = bond_weight(lattice, *shell, kind);
      if (const auto *rod = std::get_if<lattice::MooneyRivlinBond>(&shell->law))
        family.potential = continuum::RodPotential{rod->a, rod->b};
      else if (const auto *spring = std::get_if<lattice::LinearBond>(&shell->law))
        family.potential = continuum::LinearPotential{spring->modulus};
      else
        family.potential = custom_potential(*shell, custom[lattice::shell_of(kind)]);
      families.push_back({family, lattice.rest_length(kind)});
    }
  return families;
}

continuum::CauchyBorn cauchy_born(const lattice::TriangularLattice &lattice, const lattice::Material &material)
{
  std::vector<continuum::FibreFamily> fibres;
  for (const continuum::BondFamily &family : bond_families(lattice, material))
    fibres.push_back(family.fibre);
  return continuum::CauchyBorn(std::move(fibres));
}

continuum::IsotropicNetwork isotropic_network(const lattice::TriangularLattice &lattice,
                                              const lattice::Material &material)
{
  return continuum::IsotropicNetwork(cauchy_born(lattice, material).families());
}

std::unique_ptr<continuum::Viscosity> homogenised_viscosity(const lattice::TriangularLattice &lattice,
                                                            const lattice::Material &material, double gradient_length)
{
  std::vector<continuum::FibreDashpot> dashpots;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind); shell && shell->viscosity > 0.)
      dashpots.push_back(
        {direction_of(lattice, kind), bond_weight(lattice, *shell, kind), shell->viscosity, lattice.rest_length(kind)});
  if (dashpots.empty())
    return nullptr;
  return std::make_unique<continuum::FibreViscosity>(std::move(dashpots), gradient_length);
}

std::unique_ptr<continuum::FibreMemory> homogenised_memory(const lattice::TriangularLattice &lattice,
                                                           const lattice::Material &material, double gradient_length)
{
  std::vector<continuum::MaxwellFibres> families;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    const lattice::Shell *shell = material.shell(kind);
    if (shell == nullptr || lattice::properties(shell->memory).n_variables == 0)
      continue;
    const auto *memory = std::get_if<lattice::MaxwellMemory>(&shell->memory);
    if (memory == nullptr)
      throw std::invalid_argument("the continuum of bonds with a memory of another program is not supported");
    continuum::MaxwellFibres fibres{direction_of(lattice, kind),
                                    bond_weight(lattice, *shell, kind),
                                    {},
                                    material.first_mechanism(lattice::shell_of(kind)),
                                    lattice.rest_length(kind)};
    for (const auto &[modulus, relaxation_time] : memory->branches())
      fibres.branches.push_back({modulus, relaxation_time});
    families.push_back(std::move(fibres));
  }
  return families.empty() ? nullptr : std::make_unique<continuum::FibreMemory>(std::move(families), gradient_length);
}

GradientLengths gradient_lengths(const lattice::TriangularLattice &lattice, const lattice::Material &material)
{
  double stiffness = 0.;
  double with_length = 0.;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const double c = bond_weight(lattice, *shell, kind) * lattice::stiffness(shell->law, 1.);
      stiffness += c;
      with_length += c * std::pow(lattice.rest_length(kind), 2);
    }
  const double lambda = with_length / stiffness;
  return {continuum::LatticeGradient::smallest_length(bond_families(lattice, material)), std::sqrt(lambda / 24.),
          std::sqrt(lambda / 12.)};
}

Calibration calibrate_mooney_rivlin(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                    const Eigen::Matrix2d &F)
{
  if (F.isIdentity(1e-12)) // every ratio is exact at F = I
    return with_ratio(lattice, material, F, 0.);
  const double mu = small_strain(lattice, material).shear_modulus;
  const continuum::CauchyBorn exact = cauchy_born(lattice, material);
  const auto law = [mu](double ratio)
  { return continuum::MooneyRivlin(continuum::MooneyRivlin::Constants::with_equal_lame_constants(mu, ratio)); };
  const auto mean_square_residual = [&](double ratio)
  {
    try
    {
      const continuum::MooneyRivlin candidate = law(ratio);
      double sum = 0.;
      for (int point = 1; point <= path_points; ++point)
      {
        const dealii::Tensor<2, 2> state = to_continuum(on_path(F, point));
        sum += std::pow(candidate.energy(state) / exact.energy(state) - 1., 2);
      }
      return sum / path_points;
    }
    catch (const continuum::NonPhysicalState &)
    {
      return std::numeric_limits<double>::infinity(); // no equilibrium thickness: excluded
    }
  };

  // A scan brackets the minimum, golden-section search refines it. The residual is smooth and has one minimum where it
  // is finite.
  constexpr int scan_steps = 90; // of 0.01, to either side
  constexpr double scan_step = largest_ratio / scan_steps;
  double best = 0.;
  for (int i = -scan_steps; i <= scan_steps; ++i)
    if (mean_square_residual(i * scan_step) < mean_square_residual(best))
      best = i * scan_step;
  // A minimum can be located to the square root of the round-off.
  const double found =
    support::golden_section(mean_square_residual, std::clamp(best - scan_step, -largest_ratio, largest_ratio),
                            std::clamp(best + scan_step, -largest_ratio, largest_ratio), 1e-9);
  // Return an end of the interval exactly.
  const bool is_end = largest_ratio - std::abs(found) < 1e-8;
  return with_ratio(lattice, material, F, is_end ? std::copysign(largest_ratio, found) : found);
}

Calibration with_ratio(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                       const Eigen::Matrix2d &F, double ratio)
{
  const double mu = small_strain(lattice, material).shear_modulus;
  const continuum::CauchyBorn exact = cauchy_born(lattice, material);
  const continuum::MooneyRivlin fitted(continuum::MooneyRivlin::Constants::with_equal_lame_constants(mu, ratio));
  Calibration calibration{ratio, 0., 0., fitted.constants()};
  support::Extremes eigenvalues;
  for (int point = 1; point <= path_points; ++point)
  {
    const dealii::Tensor<2, 2> state = to_continuum(on_path(F, point));
    const double difference = F.isIdentity(1e-12) ? 0. : fitted.energy(state) / exact.energy(state) - 1.;
    calibration.energy_residual += difference * difference / path_points;
    eigenvalues.add(continuum::minimum_acoustic_eigenvalue(fitted, state) / mu);
  }
  calibration.smallest_acoustic_eigenvalue = eigenvalues.smallest();
  calibration.energy_residual = std::sqrt(calibration.energy_residual);
  return calibration;
}

} // namespace latcon::bridge
