#pragma once

#include <algorithm>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "lattice/cutout.h"
#include "lattice/simulation.h"
#include "lattice/site_fields.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

/// A crack that runs through a noisy sheet, and the comparison of two simulations bit by bit.
namespace running_crack
{

inline latcon::lattice::TriangularLattice small_sheet()
{
  using namespace latcon::lattice;
  return {sheets::spacing, 40. * sheets::spacing, 16. * sheets::spacing, Orientation::rows_along_crack};
}

/// @param stages 0: velocity Verlet, in steps that are a third as long
inline latcon::lattice::TimeStepping stepping(const latcon::lattice::TriangularLattice &sheet,
                                              const latcon::lattice::Material &material, unsigned int stages)
{
  const double step = 0.5 * time_step_limits(sheet, material, 0.3).combined;
  return stages > 0 ? latcon::lattice::TimeStepping(3. * step, stages) : latcon::lattice::TimeStepping(step);
}

/// How the crack of start() runs.
struct Choice
{
  using End = latcon::lattice::EndLoads::End;
  latcon::lattice::Material material = sheets::rubber();
  latcon::lattice::TimeStepping stepping = 0.;
  latcon::lattice::Toughening toughening = {3., 0., 4. * sheets::spacing};
  double noise = 0.05;           ///< in spacings
  double contact = 0.;           ///< distance in spacings; 0: none
  double contact_strength = 0.1; ///< stiffness and viscosity in those of a bond
  End left = End::held, right = End::held;
};

/// A crack from a slit at Y = 0 in a stretched sheet, held along its long edges.
inline std::unique_ptr<latcon::lattice::Simulation> start(const latcon::lattice::RowPartition &band,
                                                          const Choice &choice)
{
  using namespace latcon::lattice;
  const TriangularLattice &sheet = band.lattice();
  const double d = sheet.is_triangular() ? sheet.spacing() : sheets::spacing;
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.9);
  const bool is_left_held = choice.left == EndLoads::End::held, is_right_held = choice.right == EndLoads::End::held;
  State state = homogeneous_state(band, choice.material, F, {is_left_held, is_right_held, true, true});
  add_noise(state, band, choice.noise * d, 1);
  auto simulation = std::make_unique<Simulation>(band, choice.material, std::move(state), choice.stepping,
                                                 Fracture(band, choice.material, 3.05, choice.toughening, F));
  if (!is_left_held || !is_right_held)
    simulation->load_ends(F, choice.left, choice.right);
  if (choice.contact > 0.)
    simulation->enable_contact(contact_like_nearest_bond(sheet, choice.material, choice.contact * d,
                                                         choice.contact_strength, choice.contact_strength));
  if (sheet.is_triangular())
    simulation->cut(seed_slit(sheet, {4. * d, -0.55 * d}, {11.5 * d, 0.55 * d}));
  else
    simulation->cut_bonds(bonds_across(sheet, 4. * d, 12. * d, 0.1 * d));
  return simulation;
}

inline bool same_bits(const latcon::lattice::Field &a, const latcon::lattice::Field &b)
{
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// Expects the same state of all sites and bonds, the same ledger, and the same stresses as frames have them.
inline void expect_same_bits(const latcon::lattice::Simulation &one, const latcon::lattice::Simulation &other)
{
  using namespace latcon::lattice;
  const State &a = one.state(), &b = other.state();
  const TriangularLattice &sheet = one.lattice();
  EXPECT_EQ(a.time, b.time);
  for (std::size_t kind = 0; kind < a.bonds.n_kinds(); kind += BondStates::kinds_per_word)
    EXPECT_TRUE(std::equal(a.bonds.words(kind), a.bonds.words(kind) + sheet.n_places(), b.bonds.words(kind)));
  EXPECT_EQ(a.lost_bonds, b.lost_bonds);
  EXPECT_EQ(one.tip(), other.tip());
  EXPECT_EQ(one.n_broken(), other.n_broken());
  ASSERT_EQ(a.history.kinds.size(), b.history.kinds.size());
  for (std::size_t kind = 0; kind < a.history.kinds.size(); ++kind)
  {
    EXPECT_TRUE(same_bits(a.history.kinds[kind].stretch, b.history.kinds[kind].stretch));
    for (std::size_t v = 0; v < a.history.kinds[kind].variables.size(); ++v)
      EXPECT_TRUE(same_bits(a.history.kinds[kind].variables[v], b.history.kinds[kind].variables[v]));
  }
  const EnergyBalance e = one.energies(), f = other.energies();
  for (const auto energy : sheets::energies)
    EXPECT_EQ(e.*energy, f.*energy);
  EXPECT_EQ(e.imbalance(), f.imbalance());
  const std::vector<MechanismEnergy> of_one = one.mechanism_energies(), of_other = other.mechanism_energies();
  ASSERT_EQ(of_one.size(), of_other.size());
  for (std::size_t m = 0; m < of_one.size(); ++m)
  {
    EXPECT_EQ(of_one[m].stored, of_other[m].stored);
    EXPECT_EQ(of_one[m].dissipated, of_other[m].dissipated);
  }
  for (const std::size_t place : sheet.sites())
  {
    for (VectorField State::*field : {&State::position, &State::velocity, &State::acceleration})
      for (const std::size_t axis : axes)
        ASSERT_EQ(std::memcmp(&(a.*field)[axis][place], &(b.*field)[axis][place], sizeof(double)), 0) << place;
    ASSERT_EQ(site_values(a, sheet, one.material(), place).first_piola_stress,
              site_values(b, sheet, one.material(), place).first_piola_stress)
      << place;
  }
}

} // namespace running_crack
