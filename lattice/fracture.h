#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lattice/breaking_rule.h"
#include "lattice/forces.h"
#include "support/require.h"

namespace latcon::lattice
{

/// How bonds toughen behind the crack, by default not at all: their limits are multiplied by `factor`, for good. Bonds
/// that the caller toughened in advance (BondStates::toughen) have it too.
struct Toughening
{
  double factor = 1.; ///< [-], >= 1; infinity: these bonds never break
  /// Bonds toughen that contract below this fraction of their stretch in the loaded, unbroken sheet [-], in [0, 1), 0:
  /// none (Marder 2005: the material toughens where it retracts).
  double retraction = 0.;
  /// delta [m], >= 0: bonds toughen whose reference midpoint lies at X < X_tip - delta; infinity: none
  double distance = std::numeric_limits<double>::infinity();
};

/// A bond that broke.
struct BrokenBond : Bond
{
  double time;    ///< [s]
  double X, Y;    ///< reference midpoint [m]
  double stretch; ///< at breaking [-]
  double energy;  ///< elastic energy it held, per sheet thickness [J/m]

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("time", time);
    archive("near", near);
    archive("far", far);
    archive("kind", kind);
    archive("X", X);
    archive("Y", Y);
    archive("stretch", stretch);
    archive("energy", energy);
  }
};

/// A bond that is present.
struct StretchedBond : Bond
{
  double stretch; ///< [-]
  double limit;   ///< stretch beyond which it breaks [-]
};

/// Permanent breaking by a rule, toughening, and the crack tip (theory.md, section "Fracture").
///
/// Disorder of the strength multiplies the limit of each bond, toughened or not, by its factor.
///
/// The tip is the right-most site (reference X) that has lost at least a quarter of its bonds, rounded up: 3 of 12 as
/// in the source paper, 2 of 6 where there are nearest neighbours alone. Held and removed sites do not count. Among
/// sites at the same X the one nearest the previous tip is taken, then the one stored first.
///
/// If ranks share a sheet, each handles the bonds that start in its rows and sends the broken ones to the others, so
/// that all ranks have the same crack.
class Fracture
{
public:
  /// @param band rows whose bonds may break, that of the simulation
  /// @param rule limit of a bond that has not toughened
  /// @param deformation F of the loaded, unbroken sheet: the stretch that retraction is measured against
  /// @throws std::invalid_argument for a rule out of its range
  Fracture(const RowPartition &band, const Material &material, std::shared_ptr<const BreakingRule> rule,
           Toughening toughening, const Eigen::Matrix2d &deformation);
  /// All bonds break beyond lam_f > 0. @throws std::invalid_argument for any other
  Fracture(const RowPartition &band, const Material &material, double breaking_stretch, const Toughening &toughening,
           const Eigen::Matrix2d &deformation)
    : Fracture(band, material, std::make_shared<CriticalStretch>(breaking_stretch), toughening, deformation)
  {
  }

  /// Sets the smallest limits of virgin and of toughened bonds in `state`, and enables retraction events in
  /// `forces`. To be called before apply(); a Simulation does.
  void configure(State &state, Forces &forces) const;

  /// A stretch that no bond exceeds for longer than a step [-].
  double largest_limit() const
  {
    return rule_->largest_limit(toughening_.factor) * material_.disorder.strength.largest();
  }

  /// Cuts sites and their bonds out of the sheet. Collective.
  /// @return elastic energy of the bonds removed, per sheet thickness [J/m]
  double remove_sites(State &state, const std::vector<std::size_t> &places);

  /// Takes bonds out of the sheet, whatever their stretch. Those that are absent are left out. Collective, with the
  /// same list on all ranks.
  /// @param bonds place where each starts and its kind @return elastic energy that they held, per sheet thickness [J/m]
  double remove_bonds(State &state, const std::vector<std::pair<std::size_t, std::size_t>> &bonds);

  /// Breaks every bond that is past its limit at the last evaluation of `forces`, with its lookahead, toughens what is
  /// to be toughened, and moves the tip. Collective.
  /// @param evaluated_velocity those of that evaluation [m/s]
  /// @param number in: of this rank, out: the largest over all ranks; see RowPartition::all_gather
  /// @return the bonds of the whole sheet that broke now, in the order of storage
  /// @throws std::logic_error for a state that configure() has not set
  std::vector<BrokenBond> apply(State &state, const Forces &forces, const VectorField &evaluated_velocity,
                                int *number = nullptr);

  /// Finds the tip among all sites and toughens behind it; for a state that was cut or loaded from outside.
  void locate_tip(State &state);

  /// Place of the tip; none before anything was cut or broken.
  std::optional<std::size_t> tip() const { return tip_; }

  /// The bond present whose stretch over its limit at rest is largest, the one stored first of several: why a crack
  /// stopped. None in a sheet without bonds. @param state of the whole sheet
  std::optional<StretchedBond> nearest_to_breaking(const State &state) const;

  /// Saves or loads what changes while a crack runs, besides the state; see Simulation.
  /// @throws std::invalid_argument for a tip that is none of the sheet
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("tip", tip_);
    const double at = tip_ ? lattice_.reference(*tip_).x() : 0.;
    double x = at;
    archive("tip_x", x);
    archive("tip_y", tip_Y_before_);
    if constexpr (Archive::loads)
    {
      toughened_to_ = -std::numeric_limits<double>::infinity();
      support::require(x == at && (!tip_ || (*tip_ < lattice_.n_places() && lattice_.is_site(*tip_))),
                       "`tip` is no site of the sheet, or `tip_x` not where it is");
    }
  }

private:
  enum class Event
  {
    none,
    broken,   // past the limit
    retracted // to be toughened
  };
  Event event(const State &state, const Bond &bond, const VectorField &evaluated_velocity, double lookahead) const;
  double limit(const State &state, const Bond &bond, double rate) const;
  BrokenBond broken(const State &state, const Bond &bond) const;
  std::vector<BrokenBond> lose_bonds(State &state, const std::vector<BrokenBond> &own, int *number) const;
  void consider_tip(const State &state, std::size_t place);
  void toughen_behind_tip(State &state);

  RowPartition band_;
  const TriangularLattice &lattice_;
  Material material_;
  std::shared_ptr<const BreakingRule> rule_;
  Toughening toughening_;
  double breaking_stretch_, toughened_stretch_;                    // smallest limits
  std::vector<double> retraction_stretch_;                         // by kind; none: not watched
  std::optional<std::size_t> tip_;                                 // its place; none before a site was considered
  double tip_Y_before_ = 0.;                                       // reference Y of the tip before this step [m]
  double toughened_to_ = -std::numeric_limits<double>::infinity(); // X [m] behind which all bonds are toughened
};

} // namespace latcon::lattice
