#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lattice/bond_states.h"
#include "lattice/bonds/bond_law.h"
#include "lattice/bonds/bond_memory.h"
#include "lattice/chebyshev_stages.h"

/// @file
/// The loops that take nearly all of a simulation's time, over the sites of one row each. They exist once per
/// instruction set, from SSSE3 to AVX-512; the best that the processor has is chosen at run time, and all give the same
/// bits. Rows begin at multiples of TriangularLattice::row_alignment and are worked on in blocks of as many places, so
/// arrays must be readable, and those written to writable, to the end of the last block.
namespace latcon::lattice
{

#include "lattice/bond_geometry.inc"

} // namespace latcon::lattice

namespace latcon::lattice::kernels
{

/// Laws of the shells; those of shells that the sheet lacks are unused.
using BondLaws = std::array<BondLaw, n_shells>;

/// Kinds of bonds that bonds_of_row(), gather_row() and any_event_ahead() take: those of nearest and next-nearest
/// neighbours, at once. Third-nearest ones, which few sheets have, are left to shell_kernels.h.
inline constexpr std::size_t n_row_kinds = BondStates::kinds_per_word;

/// Constants of the bonds of a shell besides their law.
struct BondConstants
{
  double rest_length = 0.;   ///< l [m]
  double cross_section = 0.; ///< A0 / h [m]; 0: there are no such bonds
  double damping = 0.;       ///< A0 eta / (h l) [Pa s]
};

/// Constants of the bonds of a sheet.
struct SheetConstants
{
  std::array<BondConstants, n_shells> shells;
  std::array<double, n_bond_kinds> retraction_stretch{}; ///< see Forces::set_retraction_threshold; 0: not watched
  /// Inverse of the stretch below which bonds are short [-]; see Forces::set_shortness_threshold.
  double shortness_limit = std::numeric_limits<double>::infinity();

  const BondConstants &shell(std::size_t kind) const { return shells[shell_of(kind)]; }
};

/// The bonds that start in a row, with places counted from its first site.
struct RowOfBonds
{
  std::size_t n;                                  ///< sites
  const double *x, *y, *vx, *vy;                  ///< of sites [m, m/s]
  const BondStates::Word *bonds;                  ///< of sites: the words of the kinds that are worked on
  std::array<std::ptrdiff_t, n_bond_kinds> shift; ///< from a site to the far end of its bond of a kind
  double breaking_stretch, toughened_stretch;     ///< as in State
  /// Forces on the near ends [N/m], x (0) and y (1) for each kind: what is computed.
  std::array<std::array<double *, 2>, n_bond_kinds> force;
  /// `n_ahead` arrays whose same slots are prefetched, since they are needed next.
  const double *const *ahead;
  std::size_t n_ahead;
  /// Factors of the bonds of each kind by site, as in State; null: all 1. bonds_of_row() and any_event_ahead() do not
  /// take them into account; see shell_kernels.h.
  std::array<const double *, n_bond_kinds> stiffness{}, strength{};
};

/// Sums over the bonds that start in a row.
struct RowSums
{
  double viscous_power = 0.;    ///< of their dashpots [W/m]
  bool has_events = false;      ///< whether one is past its limit, or has retracted
  bool has_short_bonds = false; ///< whether one has an inverse stretch above SheetConstants::shortness_limit
};

/// Forces of all bonds of n_row_kinds that start in a row (theory.md, eq. (L.3)). Only `row.force` of kinds with a
/// shell is written.
RowSums bonds_of_row(const BondLaws &laws, const SheetConstants &sheet, const RowOfBonds &row);

/// A component of the forces on the n sites of a row: those on the near ends of the bonds that start at a site, less
/// those of the bonds that end there, [kind][site]. Kinds without a shell must be there and hold zeros.
void gather_row(std::size_t n, const std::array<const double *, n_row_kinds> &start,
                const std::array<const double *, n_row_kinds> &end, double *total);

/// One component of n sites: from velocity and acceleration at the start of a step h [s] to the velocity at half of it,
/// and position and predicted velocity at its end (theory.md, eq. (L.7)).
void drift(double h, std::size_t n, const double *acceleration, double *velocity, double *position, double *predicted);

/// Computes one component of the acceleration of n sites from the force on them.
void accelerate(std::size_t n, const double *force, const double *inverse_mass, double *acceleration);

/// Computes the acceleration as accelerate() does, and the velocity after it has acted for `duration` [s].
void kick(double duration, std::size_t n, const double *force, const double *inverse_mass, double *acceleration,
          double *velocity);

/// The first stage of a Runge-Kutta-Chebyshev step (theory.md, eq. (L.18)) for one component of n sites, in place,
/// after `duration` [s]; positions and velocities before it go to `start` and `previous`.
void first_stage(double duration, std::size_t n, const double *acceleration, double *position, double *velocity,
                 double *start_position, double *start_velocity, double *previous_position, double *previous_velocity);

/// A further stage of a step h [s] from the forces at the last one; it takes the place of the stage before the last.
void next_stage(const ChebyshevStages::Stage &stage, double h, std::size_t n, const double *force,
                const double *inverse_mass, const double *start_acceleration, const double *start_position,
                const double *start_velocity, const double *position, const double *velocity, double *previous_position,
                double *previous_velocity);

/// Returns whether one of the bonds of n_row_kinds that start in a row will be past its limit, or will have retracted,
/// after its ends have moved for `ahead` [s] at their velocities. Does not use `row.force`.
bool any_event_ahead(const SheetConstants &sheet, const RowOfBonds &row, double ahead);

/// Returns the names of the instruction sets that this processor has and the loops exist for, the best first. The
/// last is for any processor: "SCALAR", or with some compilers "EMU128". The environment variable
/// LATCON_INSTRUCTION_SET, which is read once, names the best one of them that may be used: for ThreadSanitizer, which
/// does not see loads and stores of more than 16 bytes.
/// @throws std::invalid_argument if the variable names none of them
std::vector<std::string> instruction_sets();
/// Leaves out the instruction sets that LATCON_INSTRUCTION_SET rules out. Forces do so before they use any loop.
/// @throws std::invalid_argument as instruction_sets() does
void limit_instruction_sets();
/// Selects the instruction set of the loops; the default is the best one. Not to be called during a computation.
/// @throws std::invalid_argument for a name that instruction_sets() does not have
void use_instruction_set(const std::string &name);
/// Name of the one in use.
std::string instruction_set();

/// A bond's force, one at a time: the operations of bonds_of_row, so that both have the same bits.
struct BondForce
{
  double x, y;   ///< on the near end [N/m], the opposite on the far end
  double nx, ny; ///< direction from the near to the far end
  double stretch;
  double viscous_power; ///< [W/m]
};
/// Returns the force of a bond whose ends are at a distance (dx, dy) [m] and move apart with (dvx, dvy) [m/s].
/// @param factor of its cross-section
BondForce bond_force(const BondLaw &law, const BondConstants &bond, double factor, double dx, double dy, double dvx,
                     double dvy);

} // namespace latcon::lattice::kernels
