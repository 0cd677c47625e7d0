#pragma once

#include "continuum/cell_order.h"
#include "continuum/element_integrals.h"
#include "continuum/fibre_memory.h"
#include "continuum/sheet.h"
#include "continuum/viscosity.h"

#include <array>
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

/// Nodal forces of the rate-dependent laws of a sheet, and the history of its Maxwell branches. Those of viscosity are
/// C_a = integral of P_v(F, Fdot) : Grad phi_a dX (theory-continuum.md, eq. (C.40)), those of branches Q_a = integral
/// of P(F, q) : Grad phi_a dX (theory-viscoelastic.md, eq. (V.1)), both with those of their gradient parts,
/// eqs. (C.63) and (V.9). The history consists of the overstresses q where the densities are evaluated, at the
/// quadrature points and for the gradient part once for each lifted face, and of the strains at which they were updated
/// last. Functions of a `duration` [s] >= 0 and u evaluate the state that follows from the history if the strains
/// change linearly to those of u within this time; set_history() makes it the history.
///
/// The nodal vectors u [m] and v [m/s] have ghost entries; prescribed normal gradients are constant. All functions
/// are collective, and throw NonPhysicalState on every rank.
class RateForces
{
public:
  using Vector = Sheet::Vector;

  /// Creates the forces on `sheet`; all must outlive this object. A law may be nullptr, and then has neither forces nor
  /// energies. Throws InvalidInput for a law with a gradient part on a sheet without a gradient law.
  RateForces(const Sheet &sheet, const Viscosity *viscosity, const FibreMemory *memory);

  /// Returns the forces of the same laws on another mesh of the sheet, without a history.
  RateForces on(const Sheet &sheet) const;

  bool is_present() const { return viscosity_ != nullptr || !memory_.empty(); }
  bool has_gradient_memory() const { return memory_.size() > 1; }
  bool has_gradient() const { return gradient_viscosity_ != nullptr || has_gradient_memory(); }
  std::size_t n_branches() const { return memory_.empty() ? 0 : memory_[0]->n_numbers(); } ///< of branch energies

  /// Sets the history to that of a sheet deformed suddenly to u from states in which branches were relaxed, with the
  /// same normal gradients: q = E (e(u) - e(relaxed)). @param relaxed displacement for each branch by its number;
  /// empty: u
  void start(const Vector &u, const std::vector<Vector> &relaxed);

  /// Adds the nodal forces [N/m] to `forces` and, if given, the absolute values of their terms to `magnitude`.
  void add_forces(double duration, const Vector &u, const Vector &v, Vector &forces, Vector *magnitude) const;

  /// Adds their derivative by u [N/m^2] to `matrix`, condensed by `constraints`, with dv/du = `rate_by_displacement`
  /// [1/s]. @tparam AnyMatrix Sheet::Matrix or SinglePrecisionMatrix
  template <class AnyMatrix>
  void add_tangent(double duration, const Vector &u, const Vector &v, double rate_by_displacement,
                   const dealii::AffineConstraints<double> &constraints, AnyMatrix &matrix) const;

  /// Adds the first Piola stresses [Pa] of v and of the present history, that of the last update at u, at the points of
  /// the elastic energy, the cells on this rank in their order.
  void add_stresses(const Vector &u, const Vector &v, std::vector<dealii::Tensor<2, 2>> &stresses) const;

  /// Returns the power dissipated by viscosity [W/m] per unit reference thickness, the integral of 2 R and 2 R_g, which
  /// is that of the nodal forces.
  double dissipation(const Vector &u, const Vector &v) const;

  /// Overstresses [Pa] and stretches [-], of gradients [Pa/m] and [1/m], where a law is evaluated on this rank.
  struct PointHistory
  {
    std::vector<double> overstress;
    std::vector<double> strain;
  };
  using History = std::array<PointHistory, 2>; ///< of the local law and of its gradient part
  const History &history() const { return history_; }
  void set_history(History history) { history_ = std::move(history); }

  /// Returns the history at u after `duration`, and adds the energies dissipated until then to `energies`, whose
  /// stored energies are set to those at the end; n_branches() of them. Within no time, only the latter.
  History advanced(double duration, const Vector &u, std::vector<BranchEnergy> &energies) const;

  /// Saves the history to an archive or loads it from there. @param u displacement at the last update
  template <class Archive>
  void archive(Archive &archive, const Vector &u)
  {
    if constexpr (Archive::loads)
      start(u, {});
    for (std::size_t part = 0; part < memory_.size(); ++part)
    {
      const CellOrder order(sheet_, n_variables_of_cells(part, u));
      std::vector<double> all;
      if constexpr (!Archive::loads)
        all = order.gather(history_[part].overstress);
      archive(part == 0 ? "overstress" : "gradient_overstress", all);
      if constexpr (Archive::loads)
        history_[part].overstress = order.scatter(all);
    }
  }

private:
  PointForces at(double duration, Order order, const Vector &v, double rate_by_displacement = 0.) const;
  PointHistory after(const FibreMemory::Step &step, std::size_t part, const CellPoint &point) const;
  std::vector<FibreMemory::Step> steps(double duration) const;
  template <class Visit>
  void for_each_point(const Vector &u, const Visit &visit) const;
  History strains(const Vector &u) const;
  std::vector<std::size_t> n_variables_of_cells(std::size_t part, const Vector &u) const;

  const Sheet &sheet_;
  const Viscosity *viscosity_;
  const Viscosity *gradient_viscosity_;
  std::vector<const FibreMemory *> memory_; // local law and gradient part, those that are present
  History history_;
};
} // namespace latcon::continuum
