#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lattice/breaking_rule.h"
#include "lattice/constraint.h"
#include "lattice/disorder.h"
#include "lattice/end_loads.h"
#include "lattice/fracture.h"
#include "lattice/material.h"
#include "lattice/time_step.h"
#include "lattice/triangular_lattice.h"
#include "verification/input/continuum_case.h"
#include "verification/input/parameters.h"
#include "verification/input/user_law.h"

namespace latcon::lattice
{
struct ContactLaw;
class Simulation;
}

namespace latcon::input
{

struct Case;

/// Entries of a case for the rule by which bonds break, besides lam_f.
struct BreakingCase
{
  enum class Rule : int; // the list of rules: breaking_case.cc

  Rule rule = {}; ///< by default the first
  std::vector<double> shell_factors = {}; ///< of lam_f, by shell; empty: all 1
  double rate_factor = 1.;                ///< of lam_f at high rates [-]
  double rate_time = 1e-4;                ///< tau [s]

  void declare(Parameters &parameters);
  void check(const Case &input, Parameters &parameters) const;
  /// Largest limit of a bond that has not toughened over lam_f, for rules that do not ask for the law of the bonds.
  double largest_factor() const;
  /// Returns whether the rule asks for the energy of bonds.
  bool needs_energy() const;
  /// The rule. @param input with a breaking stretch; bond-energy needs its material
  std::shared_ptr<const lattice::BreakingRule> make(const Case &input) const;
};

/// Entries of a case for the disorder of bonds.
struct DisorderCase
{
  /// A distribution as entries give it.
  struct Factors
  {
    lattice::Distribution::Kind kind = lattice::Distribution::Kind::none;
    double width = 0.1; ///< standard deviation [-]

    /// Returns whether the distribution allows the width, as distribution() requires.
    bool is_valid() const;
    /// Returns the distribution; none also if the width is not valid.
    lattice::Distribution distribution() const;
  };

  Factors strength;
  Factors stiffness;
  std::uint64_t seed = 1;

  void declare(Parameters &parameters);
  /// Reports widths that their distribution does not allow.
  void check(Parameters &parameters) const;
  lattice::Disorder disorder() const { return {strength.distribution(), stiffness.distribution(), seed}; }
};

/// Entries of a case for strains of its edges that change during a motion of the lattice: piecewise linear in time,
/// from the loading at the start through the strains of each instant, and constant from the last one on.
struct LoadingHistory
{
  std::vector<double> times;    ///< [s]
  std::vector<double> strain_x; ///< [-]; empty: that of the loading
  std::vector<double> strain_y; ///< [-], likewise

  bool empty() const { return times.empty(); }
  void declare(Parameters &parameters);
  void check(Parameters &parameters) const;
  /// Deformations F at the start and at each instant; surplus strains, which check() refuses, are left out.
  std::vector<Eigen::Matrix2d> deformations(const Eigen::Matrix2d &start) const;
};

/// Entries of a case for the nonlocal continuum, whose bonds have the lengths of the lattice's shells.
struct NonlocalCase
{
  /// True if the sheet of the case is the continuum. Not an entry: one case describes both sides.
  bool is_used = false;

  lattice::Grid::Kind grid = lattice::Grid::Kind::square;
  double refinement = 2.;        ///< m [-]: spacing of the lattice over that of the grid
  double half_width = M_PI / 6.; ///< of the arcs about the lattice's six directions [rad]
  double scatter = 0.;           ///< largest displacement of a point over the spacing of the grid [-]

  void declare(Parameters &parameters);
  /// Reports what the continuum cannot be, if it is used: a grid whose points the bonds do not join, among others.
  void check(const Case &input, Parameters &parameters) const;
  /// Returns the sheet of a case. @throws std::invalid_argument if there is none
  lattice::TriangularLattice sheet(const Case &input) const;

private:
  lattice::TriangularLattice new_sheet(const Case &input) const;
  /// The last sheet of scattered points, whose weights take long, and what it is made of.
  mutable std::shared_ptr<const std::pair<std::vector<double>, lattice::TriangularLattice>> last_;
};

/// Entries of a case for one shell of bonds.
struct ShellCase
{
  enum class Law
  {
    mooney_rivlin,
    linear,
    expression,
    library
  };

  Law law = Law::mooney_rivlin;
  double a = 1e5;       ///< [Pa]
  double b = 1.5e5;     ///< [Pa]
  double modulus = 1e5; ///< e [Pa]
  double area_factor = 2. / 3.;
  double viscosity = 0.;                     ///< eta [Pa s]
  std::vector<double> branch_moduli = {};    ///< E_i of Maxwell branches [Pa]
  std::vector<double> relaxation_times = {}; ///< tau_i of the branches [s]
  double plastic_modulus = 0.;               ///< E of a plastic memory [Pa]; 0: none
  double yield_stress = 0.;                  ///< Y [Pa]
  double hardening = 0.;                     ///< K [Pa]
  UserLaw user_law = {};                     ///< for Law::expression and Law::library

  void declare(Parameters &parameters, const std::string &section);
  /// @param longest largest stretch of an unbroken bond [-]
  void check(Parameters &parameters, const std::string &section, double longest);
  /// Reports the first branch that relaxes within a time step: its overstress would lag behind the motion by half a
  /// step. Branches must be valid. @param step [s] @param step_entries entries that the step follows from; messages
  /// name the first
  void check_relaxation_times(Parameters &parameters, const std::string &section, double step,
                              std::vector<std::string> step_entries) const;
  /// Returns whether the bonds have stiffness, as shell() requires.
  bool has_stiffness() const { return has_user_law() ? user_law.is_usable : law == Law::linear || a + b > 0.; }
  bool has_user_law() const { return law == Law::expression || law == Law::library; }
  /// @param longest largest stretch of an unbroken bond [-]
  lattice::Shell shell(double longest) const;

private:
  /// Values that the expression of a law may name [SI].
  std::map<std::string, double> constants() const { return {{"a", a}, {"b", b}, {"modulus", modulus}}; }
  void declare_memory(Parameters &parameters, const std::string &section);
  void check_memory(Parameters &parameters, const std::string &section) const;
  /// Returns the Maxwell branches or plastic memory; none also if they are not given as these require.
  lattice::BondMemory memory() const;
};

/// All input parameters of a run: the rubber sheet, its loading, fracture, and numerical parameters. All commands read
/// the same entries, so that one file describes one sheet on both sides.
struct Case
{
  // Sheet
  double spacing = 0.;      ///< d [m]
  double length = 0.;       ///< [m]
  double height = 0.;       ///< [m]
  double hole_radius = 0.;  ///< [m], in the centre of the sheet; 0 for none
  double notch_length = 0.; ///< [m], from the left edge along y = 0; 0 for none
  lattice::Orientation orientation = lattice::Orientation::rows_along_crack;

  // Material
  double density = 0.; ///< rho [kg/m^3]
  ShellCase nearest;
  bool has_next_nearest = true;
  ShellCase next_nearest;
  bool has_third_nearest = false;
  ShellCase third_nearest;
  DisorderCase disorder;

  /// Sections of the shells in a case, by their numbers below lattice::n_shells.
  static constexpr std::array<const char *, lattice::n_shells> shell_sections{
    {"Nearest neighbours", "Next-nearest neighbours", "Third-nearest neighbours"}};
  /// Entries of a shell by its number, whether the case has it or not.
  ShellCase &shell(std::size_t number) { return number == 0 ? nearest : number == 1 ? next_nearest : third_nearest; }
  const ShellCase &shell(std::size_t number) const { return const_cast<Case *>(this)->shell(number); }
  bool has_shell(std::size_t number) const
  {
    return number == 0 || (number == 1 ? has_next_nearest : has_third_nearest);
  }

  // Loading
  double strain_x = 0.; ///< eps_x [-]
  double strain_y = 0.; ///< eps_y [-]
  double shear = 0.;    ///< F_xy [-]
  LoadingHistory history;

  // Lattice
  enum class Solution
  {
    relaxed, ///< static equilibrium
    motion   ///< motion with dashpots until the end time
  };
  Solution solution = Solution::relaxed;
  double noise_amplitude = 0.01; ///< in units of d [-]
  std::uint64_t noise_seed = 1;

  // Fracture
  std::optional<double> breaking_stretch; ///< lam_f [-]
  BreakingCase breaking;
  enum class Toughening
  {
    none,
    behind_tip,
    retraction
  };
  Toughening toughening = Toughening::none;
  double toughening_distance = 0.;  ///< delta [m]
  double toughening_fraction = 0.9; ///< of the initial stretch [-]
  double toughening_factor = 1.;    ///< [-]
  enum class SeedShape
  {
    sites, ///< sites in a line
    slit   ///< all sites in a rectangle
  };
  SeedShape seed_shape = SeedShape::sites;
  unsigned int seed_sites = 8;
  double seed_length = 0.;     ///< of a slit [m]
  double seed_height = 0.;     ///< of a slit [m]
  double seed_position = 0.1;  ///< left end, of the length [-]
  double seed_offset = 0.;     ///< Y of the seed's centre line [m]
  double stop_position = 0.93; ///< of the length [-]
  /// Boundary condition at a short end of a sheet that breaks.
  using End = lattice::EndLoads::End;
  End left_end = End::held;
  End right_end = End::held;

  // Contact, in sheets that break
  bool has_contact = true;
  double contact_distance = 1.;  ///< of d [-]
  double contact_stiffness = 1.; ///< of that of a nearest bond at rest [-]
  double contact_viscosity = 1.; ///< of the dashpot of a nearest bond [-]

  // Time
  double end_time = 0.; ///< [s]
  enum class Integrator
  {
    velocity_verlet,
    runge_kutta_chebyshev
  };
  Integrator integrator = Integrator::velocity_verlet;
  unsigned int stages = 0;         ///< of Runge-Kutta-Chebyshev; 0: the smallest stable number
  std::optional<double> time_step; ///< [s]; none: safety factor times the stability limit
  double safety_factor = 0.9;

  // Continuum
  ContinuumCase continuum;
  NonlocalCase nonlocal;

  // Output
  double frame_interval = 0.;      ///< [s]; 0: first and last frame only
  unsigned int motion_frames = 48; ///< in motion.pvd while a crack runs all the way; 0: none
  unsigned int energy_interval = 200;

  // Checkpoints: these do not affect results
  unsigned int checkpoint_steps = 0; ///< time steps between two; 0: not by steps
  double checkpoint_interval = 600.; ///< wall time between two [s]; 0: not by time

  // Near tip: the window that moves with the tip, undeformed; 0: a number of spacings
  double near_tip_ahead = 0.;              ///< [m]
  double near_tip_behind = 0.;             ///< [m]
  double near_tip_half_height = 0.;        ///< [m]
  std::optional<double> near_tip_interval; ///< time between samples [s]; 0: none are taken; none: near_tip_interval()

  // Reference: published values that measured ones are compared with; none if there are none
  std::optional<double> reference_wavelength; ///< [m]
  std::optional<double> reference_amplitude;  ///< [m]
  std::optional<double> reference_speed;      ///< [m/s], Lagrangian
  double reference_tolerance = 0.2;           ///< [-]

  void declare(Parameters &parameters);
  /// Reports problems that concern several entries, and sets those that follow from others.
  void check(Parameters &parameters);

  /// Returns whether length and height are in the range that lattice() requires.
  bool has_sheet() const;
  /// The lattice of the sheet, periodic where its edges are.
  lattice::TriangularLattice lattice() const;
  /// The sheet that moves: the lattice, or the nonlocal continuum if it is used.
  lattice::TriangularLattice sheet() const { return nonlocal.is_used ? nonlocal.sheet(*this) : lattice(); }
  lattice::Material material() const;
  /// Largest stretch of an unbroken bond [-], up to which user-defined laws must have values: the breaking stretch of
  /// the strongest bond, with toughening; in a sheet that does not break, that of the loading and a fifth more. check()
  /// requires values also for what a bond gains beyond the breaking stretch within a time step.
  double longest_stretch() const;
  /// Returns whether the sheet has an inner edge, that of a hole or a notch.
  bool has_inner_edge() const { return hole_radius > 0. || notch_length > 0.; }
  /// F = [1 + eps_x, F_xy; 0, 1 + eps_y] of the loaded sheet [-].
  Eigen::Matrix2d deformation() const;
  lattice::Toughening toughening_rule() const;
  /// Rule by which bonds break, if there is a breaking stretch.
  std::shared_ptr<const lattice::BreakingRule> breaking_rule() const { return breaking.make(*this); }
  /// Places of the sites that the seed crack removes from a lattice, by increasing X. @throws std::invalid_argument if
  /// there are none
  std::vector<std::size_t> seed(const lattice::TriangularLattice &lattice) const;
  /// A cut along x, the seed crack of a sheet that is not the triangular lattice.
  struct Cut
  {
    double from, to; ///< X [m]
    double Y;        ///< [m]; a quarter of a spacing above the seed's line, so that no row is on it
  };
  Cut seed_cut(const lattice::TriangularLattice &sheet) const;
  /// X of the right end of the seed crack [m]. @throws std::invalid_argument if it does not fit into the sheet
  double seed_tip(const lattice::TriangularLattice &sheet) const;
  lattice::ContactLaw contact_law() const;
  /// Time step limits of the sheet. @param breaks whether bonds break, so that sites may touch
  lattice::TimeStepLimits time_step_limits(bool breaks) const;
  /// Returns the case with automatic time steps of the lattice.
  Case automatic() const
  {
    Case automatic = *this;
    automatic.time_step.reset();
    automatic.safety_factor = Case().safety_factor;
    return automatic;
  }

  /// Time stepping of the lattice: the given step, or the safety factor times the limit.
  lattice::TimeStepping lattice_time_stepping() const { return time_stepping(false); }
  /// Time stepping of a sheet that breaks, whose sites may touch.
  lattice::TimeStepping fracture_time_stepping() const { return time_stepping(true); }

  /// Automatic step of Runge-Kutta-Chebyshev [s]. @param breaks whether bonds break, so that sites may touch
  double chebyshev_step(bool breaks) const;

private:
  lattice::TimeStepping time_stepping(bool breaks) const;
};

/// More spacings along an edge exceed any sheet of rubber, and the integers of some indices.
inline constexpr double most_spacings = 1e6;
/// More force evaluations per step gain nothing: the stable step grows as their square, limited by accuracy.
inline constexpr unsigned int most_stages = 200;

/// Stretch down to which the automatic time step is stable [-]; shorter bonds do not occur in a sheet under tension.
inline constexpr double smallest_stable_stretch = 0.3;

/// Stretch down to which the automatic step of Runge-Kutta-Chebyshev is stable for oscillating modes [-].
inline constexpr double smallest_chebyshev_stretch = 0.45;

/// Lines `key = value` of all entries that affect results, that is all but those of Checkpoints, and of the SHA-256 of
/// a mesh file. Their SHA-256 is `case_hash` in run.json and in checkpoints.
[[nodiscard]] std::string case_lines(const Parameters &parameters);

/// Refuses strains that change, for a `reason`.
void require_constant_loading(const Case &input, Parameters &parameters, const std::string &reason);

/// Refuses bonds with plastic stretch, for a `reason`.
void require_no_plasticity(const Case &input, Parameters &parameters, const std::string &reason);

/// Constraints of the edges of a case: its rollers, and the motion of all held sites.
/// @param state of the sheet, which has the held sites
std::vector<lattice::Constraint> edge_constraints(const Case &input, const lattice::State &state,
                                                  const lattice::TriangularLattice &sheet);

/// Returns the loaded sheet of a case with noise, ends, contact and the seed crack, before its first step. Collective.
/// @param input a case that bridge::require_fracture_case() accepts @param band of input.sheet(); must outlive the
/// result
[[nodiscard]] std::unique_ptr<lattice::Simulation> cracked_sheet(const Case &input, const lattice::RowPartition &band);

} // namespace latcon::input
