#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "verification/input/parameters.h"

namespace latcon::input
{

struct Case;

/// Material law of the finite element sheet.
enum class ContinuumLaw
{
  cauchy_born,           ///< exact continuum of the lattice in homogeneous deformation
  mooney_rivlin_network, ///< mean of cauchy_born over all directions
  mooney_rivlin          ///< compressible Mooney-Rivlin law, calibrated along the loading path
};

/// Strain-gradient energy that is added to the material law.
enum class ContinuumGradient
{
  none,
  isotropic, ///< (mu l_s^2 / 2) |Grad F|^2
  lattice,   ///< gradient energy of the lattice's bonds
  network    ///< mean of lattice over all directions
};

/// Vector field of a case: an expression for each component, in x and y [m] of the undeformed sheet.
struct FieldCase
{
  std::string x = "0";
  std::string y = "0";

  /// Positions X, Y [m].
  using Points = std::vector<std::array<double, 2>>;

  /// @param values what a component may be
  void declare(Parameters &parameters, const std::string &section, const std::string &name, const std::string &unit,
               const std::string &documentation,
               const std::string &values = "expression in the undeformed x, y [m] and pi");
  /// Reports a component that is neither one of some words nor an expression that is finite at some points.
  void check(Parameters &parameters, const std::string &section, const std::string &name, const Points &points,
             const std::vector<std::string> &words = {}) const;
  bool is_zero() const { return x == "0" && y == "0"; }
  /// "x" or "y": the first component that is not zero.
  const char *given() const { return x != "0" ? "x" : "y"; }
  /// Returns the field as a function of the component (0 or 1) and of the reference position x, y [m]. It throws
  /// InputError with the position where a value is not finite. @param F of the loading: a component "loading" is that
  /// of (F - I) X, and "free" 0 @throws InputError if it cannot be parsed
  std::function<double(unsigned int component, double x, double y)>
  field(const Eigen::Matrix2d &F = Eigen::Matrix2d::Identity()) const;
};

/// Boundary conditions on one edge of the sheet. The lattice supports some of them, see require_lattice_sheet.
struct EdgeCase
{
  enum class Condition
  {
    held,    ///< displacement given
    free,    ///< traction given
    periodic ///< follows the opposite edge
  };
  /// Condition on the normal gradient of the displacement, for gradient laws only.
  enum class NormalGradient
  {
    free,    ///< double traction given
    clamped, ///< zero
    loading  ///< that of the homogeneous loading
  };

  std::string name; ///< "Left edge"
  Condition condition = Condition::held;
  FieldCase displacement{"loading", "loading"}; ///< [m]; a component may also be "loading" or "free"
  NormalGradient normal_gradient = NormalGradient::free;
  FieldCase traction{};        ///< [Pa]
  FieldCase double_traction{}; ///< [Pa m]

  void declare(Parameters &parameters, bool can_be_periodic);
  /// @param points on the edge, at which its values must be finite
  void check(Parameters &parameters, const FieldCase::Points &points) const;
  /// Returns whether the edge is held at the loading in one component and free in the other one.
  bool is_roller() const
  {
    return condition == Condition::held && ((displacement.x == "free" && displacement.y == "loading") ||
                                            (displacement.x == "loading" && displacement.y == "free"));
  }
};

/// Entries of a case for the finite element side alone.
struct ContinuumCase
{
  ContinuumLaw law = ContinuumLaw::cauchy_born;
  std::optional<double> mooney_rivlin_ratio; ///< r = C2 / (C1 + C2) [-]; none: calibrated
  ContinuumGradient gradient = ContinuumGradient::none;
  std::optional<double> static_length;  ///< l_s [m]; none: that of the lattice, averaged over directions
  std::optional<double> inertia_length; ///< l_d [m]; none: fitted with l_s, or the longest bond over sqrt(12)
  double penalty = 0.5;                 ///< gamma [-]
  unsigned int cells_x = 12;
  unsigned int cells_y = 8;
  unsigned int refinements = 2; ///< of the coarse mesh, where cells_x and cells_y do not apply
  std::string mesh_file;        ///< Gmsh; empty for none
  unsigned int degree = 3;
  unsigned int adaptive_cycles = 0;
  double refined_fraction = 0.1;
  std::optional<double> reaction_tolerance; ///< [-] change of the largest reaction in the last adaptive cycle
  double first_load_step = 1.;              ///< [-]
  double relative_tolerance = 1e-10;        ///< of the residual [-]
  unsigned int direct_limit = 20000;        ///< unknowns

  enum class Solution
  {
    equilibrium,
    motion
  };
  Solution solution = Solution::equilibrium;
  std::optional<double> time_step; ///< [s]; none: automatic, see element_motion.cc
  enum class Rule
  {
    average_acceleration,
    generalised_alpha
  };
  Rule rule = Rule::average_acceleration;
  double spectral_radius = 0.9; ///< of generalised-alpha at high frequencies [-]

  /// Indexed by continuum::edge.
  std::array<EdgeCase, 5> edges{
    {{"Left edge"}, {"Right edge"}, {"Bottom edge"}, {"Top edge"}, {"Inner edge", EdgeCase::Condition::free}}};
  FieldCase body_force; ///< [N/m^3]
  bool body_force_corrected = false;
  enum class Base
  {
    undeformed,
    loading,    ///< homogeneously deformed
    equilibrium ///< under the conditions of the case
  };
  Base initial_base = Base::loading;
  FieldCase initial_displacement; ///< [m], added to the base
  FieldCase initial_velocity;     ///< [m/s]

  /// Returns whether one is computed: the solution, or the initial state of a motion.
  bool has_equilibrium() const { return solution == Solution::equilibrium || initial_base == Base::equilibrium; }
  void declare(Parameters &parameters);
  /// Reports problems of these entries, also expressions that are not finite at one of many points of the sheet and its
  /// edges. @param input whose entries they are
  void check(Parameters &parameters, const Case &input) const;
  /// Reports what an equilibrium that `command` computes cannot have: a direction in which no edge is held, or a period
  /// other than the undeformed one.
  void require_equilibrium(Parameters &parameters, const Case &input, const std::string &command) const;
};

} // namespace latcon::input
