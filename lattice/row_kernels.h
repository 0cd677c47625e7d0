#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "lattice/bond_states.h"
#include "lattice/bonds/formulas.h"
#include "lattice/chebyshev_stages.h"

/// @file
/// The loops that take nearly all of a simulation's time, over the sites of one row each. They exist once per
/// instruction set, from SSSE3 to AVX-512; the best that the processor has is chosen at run time, and all give the same
/// bits. Rows begin at multiples of TriangularLattice::row_alignment and are worked on in blocks of as many places, so
/// arrays must be readable, and those written to writable, to the end of the last block.
namespace latcon::lattice::kernels
{

/// Constants of bonds of one kind besides their law.
struct BondConstants
{
  double rest_length = 0.;   ///< l [m]
  double cross_section = 0.; ///< A0 / h [m]; 0: there are no such bonds
  double damping = 0.;       ///< A0 eta / (h l) [Pa s]
};

/// History of the bonds of one kind that start in a row, by places counted from its first site.
struct RememberedRow
{
  const BondMemory *memory;                                   ///< with the duration since the last update
  const double *stretch;                                      ///< at the last update [-]
  std::array<const double *, max_history_variables> variable; ///< of the memory
  /// The same, to be updated to the present; null: not updated. Absent bonds remember 0.
  double *new_stretch = nullptr;
  std::array<double *, max_history_variables> new_variable = {};
  double *dissipation = nullptr; ///< of each mechanism, what is added to; see RowSums
};

/// The bonds of one kind, a half-bond of a stencil, that start in a row, with places counted from its first site.
struct BondsOfKind
{
  const BondLaw *law; ///< null: there are no such bonds
  BondConstants constants;
  std::ptrdiff_t shift;                ///< from a site to the far end of its bond
  const BondStates::Word *states;      ///< of sites: the words that hold this kind and all others of a call
  BondStates::Word present, toughened; ///< its bits in these words
  double retraction_stretch = 0.;      ///< see Forces::set_retraction_threshold; 0: not watched
  const double *stiffness = nullptr, *strength = nullptr; ///< factors by site, as in State; null: all 1
  /// Rest length of the kind over that of a bond, by site; null: all 1. The length of a bond times this ratio is that
  /// of a bond of the kind with the same stretch, and its gradient is what rates and forces are projected on.
  const double *length_ratio = nullptr;
  const RememberedRow *remembered = nullptr; ///< null: no memory
  std::array<double *, 2> force{};           ///< on the near ends, x (0) and y (1) [N/m]: what is computed
  std::array<double *, 2> lengths{};         ///< scratch for a call of bonds of which some have a memory
};

/// The sites of a row, with places counted from its first site, and the bonds that start there.
struct RowOfBonds
{
  std::size_t n;                              ///< sites
  const double *x, *y, *vx, *vy;              ///< of sites [m, m/s]
  double breaking_stretch, toughened_stretch; ///< as in State
  /// Inverse of the stretch below which bonds are short [-]; see Forces::set_shortness_threshold.
  double shortness_limit = std::numeric_limits<double>::infinity();
  const BondsOfKind *kinds = nullptr; ///< `n_kinds` of them
  std::size_t n_kinds = 0;
};

/// Sums over the bonds that start in a row.
struct RowSums
{
  /// Power of dashpots, A0 eta (v_rel . n)^2 / l [W/m], with those in memories, which bonds_of_row() omits.
  double viscous_power = 0.;
  /// Power that each mechanism of Material::n_mechanisms() dissipates [W/m], or energy that it has dissipated since its
  /// last update [J/m]; see MemoryProperties.
  std::vector<double> mechanism_power = {};
  bool has_events = false;      ///< whether one is past its limit, or has retracted; see Forces::evaluate
  bool has_short_bonds = false; ///< whether one has an inverse stretch above RowOfBonds::shortness_limit
};

/// The loops of one instruction set.
struct Loops
{
  const char *instruction_set; ///< its name

  /// Computes the forces of all bonds of a row (theory.md, eq. (L.3)), with the overstress of those with a memory, the
  /// present stretch being reached in the time since the last update, and adds to `sums` those over the bonds.
  /// @param row of one kind, of the n_kinds_per_shell of a shell, or, for bonds without factors, of two shells
  void (*bonds_of_row)(const RowOfBonds &row, RowSums &sums);

  /// A component of the forces on the n sites of a row: those on the near ends of the bonds that start at a site, less
  /// those of the bonds that end there, [kind][site]. Kinds without a shell must be there and hold zeros.
  /// @param n_kinds 6, or 9 with third-nearest neighbours
  void (*gather_row)(std::size_t n, std::size_t n_kinds, const std::array<const double *, n_bond_kinds> &start,
                     const std::array<const double *, n_bond_kinds> &end, double *total);

  /// Adds a component of the forces of n bonds of a kind to the sums of their near ends, unless null, and takes it from
  /// those of their far ends, which may be other places of the same array.
  void (*scatter)(std::size_t n, const double *force, double *near, double *far);

  /// Returns whether one of the bonds of all kinds of a row will be past its limit, or will have retracted, after its
  /// ends have moved for `ahead` [s] at their velocities. Does not use the forces.
  bool (*any_event_ahead)(const RowOfBonds &row, double ahead);

  /// Returns whether one of the bonds of all kinds of a row has at most a stretch of `stretch` [-] now, or will have it
  /// in `ahead` [s] at its present rate. Does not use the forces.
  bool (*any_short_ahead)(const RowOfBonds &row, double ahead, double stretch);

  /// One component of n sites: from velocity and acceleration at the start of a step h [s] to the velocity at half of
  /// it, and position and predicted velocity at its end (theory.md, eq. (L.7)).
  void (*drift)(double h, std::size_t n, const double *acceleration, double *velocity, double *position,
                double *predicted);

  /// Computes one component of the acceleration of n sites from the force on them, and the velocity after it has acted
  /// for `duration` [s].
  void (*kick)(double duration, std::size_t n, const double *force, const double *inverse_mass, double *acceleration,
               double *velocity);

  /// The first stage of a Runge-Kutta-Chebyshev step (theory.md, eq. (L.18)) for one component of n sites, after
  /// `duration` [s]; positions and velocities before it go to `start` and `previous`. `from` may be the
  /// fields at `position` and `velocity`, or those at `previous`.
  void (*first_stage)(double duration, std::size_t n, const double *acceleration, const double *from_position,
                      const double *from_velocity, double *position, double *velocity, double *start_position,
                      double *start_velocity, double *previous_position, double *previous_velocity);

  /// A further stage of a step h [s] from the forces at the last one; it takes the place of the stage before the last.
  void (*next_stage)(const ChebyshevStages::Stage &stage, double h, std::size_t n, const double *force,
                     const double *inverse_mass, const double *start_acceleration, const double *start_position,
                     const double *start_velocity, const double *position, const double *velocity,
                     double *previous_position, double *previous_velocity);
};
/// Those of the instruction set in use.
const Loops &loops();

/// Returns the names of the instruction sets that this processor has and the loops exist for, the best first. The
/// last is for any processor: "SCALAR", or with some compilers "EMU128". The environment variable
/// LATCON_INSTRUCTION_SET, which is read once, names the best one of them that may be used: for ThreadSanitizer, which
/// does not see loads and stores of more than 16 bytes. Forces call this before they use any loop.
/// @throws std::invalid_argument if the variable names none of them
std::vector<std::string> instruction_sets();
/// Selects the instruction set of the loops; the default is the best one. Not to be called during a computation.
/// @throws std::invalid_argument for a name that instruction_sets() does not have
void use_instruction_set(const std::string &name);

} // namespace latcon::lattice::kernels
