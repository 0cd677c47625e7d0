#pragma once

#include "continuum/damage/damage_law.h"
#include "continuum/sheet.h"
#include "continuum/stiffness_factor.h"

#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>

#include <functional>
#include <set>
#include <vector>

namespace latcon::continuum
{
/// Damage field d(X) of a sheet: bilinear (Q1) on the mesh of the sheet, with the energy
///   E(u, phi) = sum over nodes a of g(phi_a) e_a(u) + S(phi),
///   S(phi) = 2 (1 - k) W_c integral of phi + xi^2 |Grad phi|^2 dX
/// (theory-damage.md, eqs. (C.59) to (C.63)). As a StiffnessFactor it interpolates g(phi_a) bilinearly, so that the
/// nodal energies e_a, the integrals of the stored energy density times shape function, are exactly conjugate to
/// g(phi_a).
///
/// Damage is irreversible: minimize() does not let it fall below the state of the last accept() or set(). All functions
/// but at() are collective.
class DamageField : public StiffnessFactor
{
public:
  using Vector = Sheet::Vector;

  /// Creates a field without damage. `mesh` must outlive it and must not change. On `intact` boundaries damage keeps
  /// the value of set(). `periodic` pairs are those of the sheet. Throws InvalidInput for constants out of range.
  DamageField(const Sheet::Mesh &mesh, const DamageLaw &law, const std::set<dealii::types::boundary_id> &intact = {},
              const std::vector<PeriodicPair> &periodic = {});

  /// Sets the damage and its lower bound to the nodal values of `damage` [-], in [0, 1], such as that of a seed crack.
  /// Throws InvalidInput for a value out of range.
  void set(const std::function<double(const dealii::Point<2> &)> &damage);

  /// Minimises E(u, phi) over phi not below the accepted damage, at fixed u [m] (with ghost entries) of a `sheet` on
  /// the same mesh, by a primal-dual active set method, eq. (C.64). Returns the largest change of phi at any node [-].
  /// Throws NonPhysicalState as Sheet::energy does and if the energy is not convex in the damage of a node, because its
  /// e_a is too negative, and LinearSolverFailed if the active sets do not converge.
  double minimize(const Sheet &sheet, const Vector &u, double load_factor);

  /// Makes the current damage the lower bound of later ones.
  void accept() { lower_bound_ = damage_; }

  /// Returns S(phi) [J/m], per unit reference thickness.
  double fracture_energy() const;

  /// Returns the largest damage of any node [-].
  double largest() const;

  /// Returns the damage [-] at reference points [m]. Every rank passes the same points and gets all values. Throws
  /// InvalidInput if a point is outside the mesh by more than 1e-8 of a cell, or not finite.
  std::vector<double> evaluate(const std::vector<dealii::Point<2>> &points) const;

  /// Returns the interpolated g(phi_a) [-].
  double at(const dealii::Triangulation<2>::cell_iterator &cell, const dealii::Point<2> &unit_point) const override;

  const DamageLaw &law() const { return law_; }
  const dealii::DoFHandler<2> &dof_handler() const { return dof_handler_; }
  const Vector &damage() const { return damage_; } ///< nodal, with ghost entries [-]

private:
  Vector nodal_energies(const Sheet &sheet, const Vector &u, double load_factor) const;
  void update_factors();
  template <class Test>
  bool select(std::vector<char> &fixed, const Test &test) const;

  DamageLaw law_;
  dealii::FE_Q<2> element_;
  dealii::MappingQ<2> mapping_;
  dealii::DoFHandler<2> dof_handler_;
  dealii::IndexSet owned_;
  dealii::IndexSet relevant_;
  dealii::AffineConstraints<double> constraints_; // hanging nodes and periodic edges
  dealii::IndexSet intact_;                       // owned nodes on intact boundaries
  Sheet::Matrix laplace_;                         // integrals of Grad phi_a . Grad phi_b [-]
  Vector measure_;                                // integrals of phi_a [m^2]
  Vector damage_;                                 // with ghost entries, as lower_bound_ and factor_
  Vector lower_bound_;
  Vector factor_; // g(phi_a)
};
} // namespace latcon::continuum
