#pragma once

#include <array>
#include <memory>
#include <optional>

#include "continuum/conditions.h"
#include "continuum/constitution.h"
#include "continuum/sheet.h"
#include "verification/bridge/subject.h"
#include "verification/input/case.h"

namespace latcon::bridge
{

/// Finite element model of a case: laws, mesh and boundary conditions. The continuum gets constants and functions only.
/// Must outlive the solvers that use it. Collective.
class ContinuumModel
{
public:
  /// Builds the model. @throws InputError if the mesh file is invalid, or if no plane-stress Mooney-Rivlin law exists
  /// for the loading path
  explicit ContinuumModel(const input::Case &input);

  continuum::Sheet::Mesh &mesh() { return mesh_; }
  continuum::Constitution constitution() const;
  const continuum::BoundaryConditions &conditions() const { return conditions_; }
  const Subject &subject() const { return subject_; }

  /// Length and height of the mesh [m].
  std::array<double, 2> mesh_extent() const;

  double extent() const { return extent_; }                 ///< smaller of length and height [m]
  double static_length() const { return static_length_; }   ///< l_s [m] of the isotropic gradient energy; otherwise 0
  double inertia_length() const { return inertia_length_; } ///< l_d [m]; 0 without a gradient energy
  /// Returns l_d [m] if the gradient energy is that of the bonds, whose dashpots and Maxwell branches then have a
  /// gradient part too; else 0.
  double viscous_gradient_length() const;

private:
  void make_mesh(const input::Case &input);
  void make_conditions(const input::Case &input);

  Subject subject_;
  input::ContinuumLaw law_;
  std::optional<continuum::MooneyRivlin> mooney_rivlin_; // if the case selects this law
  double penalty_;
  double extent_ = 0.;
  double static_length_ = 0.;
  double inertia_length_ = 0.;
  std::unique_ptr<continuum::GradientLaw> gradient_;
  continuum::Sheet::Mesh mesh_;
  continuum::BoundaryConditions conditions_;
};

} // namespace latcon::bridge
