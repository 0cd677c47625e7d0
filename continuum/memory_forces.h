#pragma once

#include "continuum/cell_order.h"
#include "continuum/element_integrals.h"
#include "continuum/fibre_memory.h"
#include "continuum/sheet.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// Energies of one branch [J/m] per unit reference thickness.
struct BranchEnergy
{
  double stored = 0.;     ///< in its springs
  double dissipated = 0.; ///< by its dashpots since the start

  /// Saves the energies to an archive or loads them from it.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("stored", stored);
    archive("dissipated", dissipated);
  }
};

/// Nodal forces of the Maxwell branches of a sheet, integral of P(F, q) : Grad phi_a dX (theory-viscoelastic.md, eqs.
/// (V.1), (V.2)), and their history: overstresses at the quadrature points, and the stretches at which they were
/// updated last. Functions of a `duration` [s] >= 0 and u evaluate the state that follows from the history if the
/// stretches change linearly to those of u within this time; advance() makes it the history.
///
/// Nodal displacements u [m] have ghost entries. All functions are collective and throw NonPhysicalState on every rank.
/// Without a law all forces and energies are zero.
class MemoryForces
{
public:
  using Vector = Sheet::Vector;

  /// Creates the forces of `law` on `sheet`; both must outlive this object. `law` may be nullptr.
  MemoryForces(const Sheet &sheet, const FibreMemory *law) : sheet_(sheet), law_(law) {}

  bool is_present() const { return law_ != nullptr; }
  std::size_t n_branches() const { return law_ == nullptr ? 0 : law_->n_numbers(); } ///< of branch_energies

  /// Sets the history to that of a sheet deformed suddenly to u from states in which branches were relaxed:
  /// q = E (l(u) - l(relaxed)). @param relaxed displacement for each branch by its number; empty: u
  void start(const Vector &u, const std::vector<Vector> &relaxed);

  /// Adds the nodal forces [N/m] to `forces` and, if given, the absolute values of their terms to `magnitude`.
  void add_forces(double duration, const Vector &u, Vector &forces, Vector *magnitude) const;

  /// Adds the first Piola stresses [Pa] of the present history, that of the last update at u, at the points of the
  /// elastic energy, the cells on this rank in their order.
  void add_stresses(const Vector &u, std::vector<dealii::Tensor<2, 2>> &stresses) const;

  /// Adds the derivative of these forces by u [N/m^2] to `matrix`, condensed by `constraints`.
  void add_tangent(double duration, const Vector &u, const dealii::AffineConstraints<double> &constraints,
                   Sheet::Matrix &matrix) const;

  /// Adds the tangent for a history that is relaxed at u; independent of the history, for any sheet.
  static void add_relaxed_tangent(const Sheet &sheet, const FibreMemory *law, double duration, const Vector &u,
                                  const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &matrix);

  /// Overstresses [Pa] and stretches [-] at the quadrature points of locally owned cells.
  struct History
  {
    std::vector<double> overstress;
    std::vector<double> stretch;
  };
  const History &history() const { return history_; }
  void set_history(History history) { history_ = std::move(history); }

  /// Returns the history at u after `duration`, and adds the energies dissipated until then to `energies`, whose
  /// stored energies are set to those at the end; n_branches() of them.
  History advanced(double duration, const Vector &u, std::vector<BranchEnergy> &energies) const;

  /// Returns the energies that the branches store in the present history, that of the last update at u [J/m].
  std::vector<BranchEnergy> stored(const Vector &u) const;

  /// Saves the history to an archive or loads it from there. @param u displacement at the last update
  template <class Archive>
  void archive(Archive &archive, const Vector &u)
  {
    if (law_ == nullptr)
      return;
    const CellOrder order(sheet_);
    std::vector<double> all;
    if constexpr (!Archive::loads)
      all = order.gather(history_.overstress);
    archive("overstress", all);
    if constexpr (Archive::loads)
    {
      start(u, {});
      history_.overstress = order.scatter(all, n_points_per_cell() * law_->n_variables());
    }
  }

private:
  // State of one quadrature point.
  struct AtPoint
  {
    std::vector<double> stretch;    // [-]
    std::vector<double> overstress; // [Pa]
  };

  std::size_t n_points_per_cell() const;
  const double *stretch_before(std::size_t point) const;
  PointForces after(double duration, Order order, AtPoint &state) const;
  void advance(const FibreMemory::Step &step, std::size_t point, const dealii::Tensor<2, 2> &F, AtPoint &state) const;

  const Sheet &sheet_;
  const FibreMemory *law_;
  History history_;
};
} // namespace latcon::continuum
