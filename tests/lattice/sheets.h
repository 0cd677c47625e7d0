#pragma once

#include <cmath>
#include <memory>
#include <ostream>
#include <type_traits>

#include "lattice/simulation.h"

namespace latcon::lattice
{
/// Prints an orientation in the name of a test.
inline void PrintTo(const Orientation orientation, std::ostream *out)
{
  *out << (orientation == Orientation::rows_along_crack ? "rows along crack" : "rows across crack");
}
} // namespace latcon::lattice

/// Sheets that several tests share.
namespace sheets
{

inline constexpr double spacing = 0.625e-3;

/// A law of latcon's own, given as one from outside.
template <class Law>
class FromOutside : public latcon::lattice::CustomBondLaw
{
public:
  explicit FromOutside(const Law &law) : law_(law) {}
  double energy(double stretch) const noexcept override { return law_.energy(stretch); }
  double force(double stretch) const noexcept override
  {
    if constexpr (std::is_convertible_v<Law, latcon::lattice::BondLaw>)
      return latcon::lattice::force(law_, stretch);
    else
      return law_.force(stretch);
  }
  double stiffness(double stretch) const noexcept override { return law_.stiffness(stretch); }
  double largest_stiffness(double smallest_stretch) const noexcept override
  {
    return law_.largest_stiffness(smallest_stretch);
  }

private:
  Law law_;
};

template <class Law>
latcon::lattice::CustomBond from_outside(const Law &law)
{
  return latcon::lattice::CustomBond(std::make_shared<FromOutside<Law>>(law));
}

/// A Maxwell branch as a memory from outside, with one variable per bond: its overstress.
class BranchFromOutside : public latcon::lattice::CustomMemoryLaw
{
public:
  explicit BranchFromOutside(const latcon::lattice::MaxwellMemory::Branch &branch) : branch_(branch) {}
  std::size_t n_variables() const noexcept override { return 1; }
  double advance(double duration, double before, double now, double *overstress) const noexcept override
  {
    const double r = duration / branch_.relaxation_time;
    const double mean = r > 0. ? -std::expm1(-r) / r : 1.;
    return *overstress = std::exp(-r) * *overstress + branch_.modulus * mean * (now - before);
  }
  double stored_energy(double, const double *overstress) const noexcept override
  {
    return 0.5 * *overstress * *overstress / branch_.modulus;
  }
  double dissipation(double, const double *overstress) const noexcept override
  {
    return *overstress * *overstress / (branch_.modulus * branch_.relaxation_time);
  }
  double largest_stiffness() const noexcept override { return branch_.modulus; }

private:
  latcon::lattice::MaxwellMemory::Branch branch_;
};

/// A slider that yields as PlasticMemory does, as a memory from outside.
class SliderFromOutside : public latcon::lattice::CustomMemoryLaw
{
public:
  SliderFromOutside(double modulus, double yield_stress, double hardening)
    : E_(modulus), Y_(yield_stress), K_(hardening)
  {
  }
  std::size_t n_variables() const noexcept override { return 2; }
  double advance(double, double before, double now, double *variables) const noexcept override
  {
    const double trial = variables[0] + E_ * (now - before), beyond = std::abs(trial) - (Y_ + K_ * variables[1]);
    variables[0] = trial;
    if (beyond > 0.)
    {
      variables[1] += beyond / (E_ + K_);
      variables[0] = std::copysign(Y_ + K_ * variables[1], trial);
    }
    return variables[0];
  }
  double stored_energy(double, const double *variables) const noexcept override
  {
    return 0.5 * variables[0] * variables[0] / E_;
  }
  bool is_rate_independent() const noexcept override { return true; }
  double dissipation(double, const double *variables) const noexcept override
  {
    return (Y_ + 0.5 * K_ * variables[1]) * variables[1];
  }
  double largest_stiffness() const noexcept override { return E_; }

private:
  double E_, Y_, K_;
};

inline latcon::lattice::CustomMemory memory_from_outside(const latcon::lattice::MaxwellMemory::Branch &branch)
{
  return latcon::lattice::CustomMemory(std::make_shared<BranchFromOutside>(branch));
}

/// The rubber of the source paper's Fig. 1; viscosity of the nearest neighbours in Pa s, three times that for the next.
inline latcon::lattice::Material rubber(double viscosity = 65.625)
{
  const latcon::lattice::MooneyRivlinBond bond{1e5, 1.5e5};
  const double area_factor = 2. / 3.;
  return {944., {bond, area_factor, viscosity}, latcon::lattice::Shell{bond, area_factor, 3. * viscosity}};
}

inline latcon::lattice::Material without_next_nearest(latcon::lattice::Material material)
{
  material.next_nearest.reset();
  return material;
}

inline latcon::lattice::Material nearest_only(double viscosity = 65.625)
{
  return without_next_nearest(rubber(viscosity));
}

/// Rubber with third-nearest neighbours too, of another stiffness, area factor and viscosity than the others.
inline latcon::lattice::Material rubber_of_three_shells(double viscosity = 65.625)
{
  latcon::lattice::Material material = rubber(viscosity);
  material.third_nearest = latcon::lattice::Shell{latcon::lattice::MooneyRivlinBond{6e4, 1.1e5}, 0.4, 1.5 * viscosity};
  return material;
}

/// Rubber with custom laws.
inline latcon::lattice::Material rubber_from_outside()
{
  latcon::lattice::Material material = rubber();
  material.nearest.law = from_outside(latcon::lattice::MooneyRivlinBond{1e5, 1.5e5});
  material.next_nearest->law = material.nearest.law;
  return material;
}

/// Rubber with two Maxwell branches in nearest-neighbour bonds and a custom memory in the others.
inline latcon::lattice::Material rubber_with_memory(double viscosity = 65.625)
{
  latcon::lattice::Material material = rubber(viscosity);
  material.nearest.memory = latcon::lattice::MaxwellMemory({{2e5, 2e-5}, {1e5, 2e-4}});
  material.next_nearest->memory = memory_from_outside({1.5e5, 5e-5});
  return material;
}

/// Rubber with three Maxwell branches in nearest-neighbour bonds and one in the others.
inline latcon::lattice::Material rubber_with_branches(double viscosity = 65.625)
{
  latcon::lattice::Material material = rubber(viscosity);
  material.nearest.memory = latcon::lattice::MaxwellMemory({{2e5, 2e-5}, {1e5, 2e-4}, {3e4, 1e-3}});
  material.next_nearest->memory = latcon::lattice::MaxwellMemory({{1.5e5, 5e-5}});
  return material;
}

/// Rubber whose bonds yield, with hardening in the next-nearest ones alone.
inline latcon::lattice::Material plastic_rubber(double viscosity = 65.625)
{
  latcon::lattice::Material material = rubber(viscosity);
  material.nearest.memory = latcon::lattice::PlasticMemory(2e5, 2e4, 0.);
  material.next_nearest->memory = latcon::lattice::PlasticMemory(1e5, 1e4, 3e4);
  return material;
}

/// Such a rubber with disorder of all bonds.
inline latcon::lattice::Material disordered_rubber(double viscosity = 65.625)
{
  using latcon::lattice::Distribution;
  latcon::lattice::Material material = rubber_with_branches(viscosity);
  material.disorder = {{Distribution::Kind::weibull, 0.05}, {Distribution::Kind::normal, 0.2}, 7};
  return material;
}

/// Three shells with memories and disorder of all bonds.
inline latcon::lattice::Material disordered_rubber_of_three_shells()
{
  latcon::lattice::Material material = disordered_rubber();
  material.third_nearest = rubber_of_three_shells().third_nearest;
  material.third_nearest->memory = latcon::lattice::MaxwellMemory({{5e4, 3e-5}, {1e5, 4e-4}});
  return material;
}

inline Eigen::Matrix2d stretched(double x, double y)
{
  return Eigen::Vector2d(x, y).asDiagonal();
}

/// A sheet of about n by n sites.
inline latcon::lattice::TriangularLattice
square(double n, latcon::lattice::Orientation orientation = latcon::lattice::Orientation::rows_along_crack)
{
  return {spacing, n * spacing, n * spacing, orientation};
}

/// The site at the same X and at -Y.
inline std::size_t mirrored(const latcon::lattice::TriangularLattice &sheet, std::size_t place)
{
  const std::size_t row = sheet.row_of(place), column = sheet.column_of(place);
  return sheet.orientation() == latcon::lattice::Orientation::rows_along_crack
           ? sheet.index(sheet.rows() - 1 - row, column)
           : sheet.index(row, sheet.sites_in_row(row) - 1 - column);
}

/// Each energy of a ledger.
inline constexpr double latcon::lattice::EnergyBalance::*energies[] = {
  &latcon::lattice::EnergyBalance::elastic, &latcon::lattice::EnergyBalance::kinetic,
  &latcon::lattice::EnergyBalance::viscous, &latcon::lattice::EnergyBalance::broken,
  &latcon::lattice::EnergyBalance::contact, &latcon::lattice::EnergyBalance::boundary_work,
  &latcon::lattice::EnergyBalance::initial};

/// The n places in a row from a given column on.
inline std::vector<std::size_t> places_in_row(const latcon::lattice::TriangularLattice &sheet, std::size_t row,
                                              std::size_t column, std::size_t n)
{
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < n; ++i)
    places.push_back(sheet.index(row, column + i));
  return places;
}
/// The same in the middle row; a seed crack.
inline std::vector<std::size_t> middle_row(const latcon::lattice::TriangularLattice &sheet, std::size_t column,
                                           std::size_t n)
{
  return places_in_row(sheet, sheet.rows() / 2, column, n);
}

} // namespace sheets
