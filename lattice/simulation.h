#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lattice/constraint.h"
#include "lattice/contact.h"
#include "lattice/end_loads.h"
#include "lattice/energy.h"
#include "lattice/fracture.h"
#include "lattice/integrator.h"
#include "lattice/snapshot.h"
#include "lattice/time_step.h"

namespace latcon::lattice
{

/// A sheet in motion: state, forces, time stepping, fracture and the energy ledger, one step at a time.
///
/// Ranks that share the sheet make one simulation together, each of its band of rows. Every function that is not const
/// is collective, but for save() and restore(), and so are energies() and position(). What they return, and all that
/// does not depend on who moves which row, is the same bits on all ranks, for any number of them.
class Simulation
{
public:
  /// @param band rows that this process moves: a whole lattice, or its share
  /// @param initial loaded state in the rows that the band knows; its accelerations are computed here
  /// @param fracture breaking rules for the same band; none for a sheet whose bonds never break
  Simulation(const RowPartition &band, const Material &material, State initial, TimeStepping time_stepping,
             std::optional<Fracture> fracture = std::nullopt);
  Simulation(const Simulation &) = delete; // parts refer to each other
  Simulation &operator=(const Simulation &) = delete;

  /// Adds contact between unbonded sites. @throws std::logic_error if there is contact already
  void enable_contact(const ContactLaw &law);

  /// Loads the short ends of the unbroken sheet as if it continued at x = F X. @throws std::logic_error if they are
  /// loaded already, or after a bond broke or was cut
  void load_ends(const Eigen::Matrix2d &F, EndLoads::End left, EndLoads::End right);

  /// Cuts sites out of the sheet, with the energy of their bonds and of their motion. @throws std::logic_error without
  /// fracture rules
  void cut(const std::vector<std::size_t> &places);

  /// Cuts those of some bonds that are present out of the sheet, whatever their stretch, as a crack on a schedule does.
  /// @param bonds place where each starts and its kind, the same on all ranks
  /// @throws std::logic_error without fracture rules; std::invalid_argument for what is no bond of a site
  void cut_bonds(const std::vector<std::pair<std::size_t, std::size_t>> &bonds);

  /// Stops sites, whose kinetic energy leaves the initial one, and prescribes their motion from the next step on.
  /// @return number of the constraint
  /// @throws std::invalid_argument for what is no site; std::logic_error where another constraint holds a component
  std::size_t constrain(const Constraint &constraint);
  /// Gives a constraint another motion from the next step on.
  void set_motion(std::size_t constraint, const Constraint::Motion &motion)
  {
    constraints_.at(constraint).set_motion(motion);
  }
  /// Work that a constraint has done on the sheet [J/m]; a part of EnergyBalance::boundary_work. Collective.
  double constraint_work(std::size_t constraint) const { return band_.sum(work_.at(of_constraint(constraint))); }

  /// Adds forces on sites, whose work counts as boundary work. They must be functions of time, positions and
  /// velocities, and are evaluated on each rank for its own sites.
  void add(std::unique_ptr<SiteForces> forces);

  /// Sets the velocities of the free sites. @param velocity by place [m/s]
  /// @param is_initial the change of kinetic energy counts as initial energy, as of a wave to begin with; else as
  /// boundary work, as of an impulse on the way
  void set_velocities(const VectorField &velocity, bool is_initial = true);

  /// Advances by one time step, in parts if a bond is so short that the whole step would be unstable (theory.md,
  /// eq. (L.24)). @return bonds of the whole sheet that broke in it
  const std::vector<BrokenBond> &step();

  /// Sends positions, velocities and bonds in some rows to the root rank.
  /// @return state(), complete in these rows on the root rank, unchanged on the others
  const State &gather(Rows rows = TriangularLattice::all);

  /// Saves what changes from step to step, or loads it into a simulation that was set up like the one that was saved,
  /// before its first step; that continues with the same bits, on any number of ranks. Collective.
  /// @param archive called as archive(name, value) with numbers, vectors, matrices, and objects that have a function
  /// like this one; loads if `Archive::loads`. The first rank saves the whole, and all ranks load the whole.
  /// @throws std::invalid_argument if fields are of a sheet of another size, or bonds, counts or energy are none that
  /// the simulation can have come to
  template <class Archive>
  void archive(Archive &archive);

  /// Saves the present values of all that archive() saves, without communication.
  void save(Snapshot &snapshot);
  /// Returns to an earlier instant, without communication; the steps from there have the same bits again.
  /// @param earlier of this simulation, since which no sites were cut @throws std::invalid_argument for one of another
  /// simulation, whose values may then be in part of the state
  void restore(const Snapshot &earlier);

  const RowPartition &band() const { return band_; }
  const TriangularLattice &lattice() const { return lattice_; }
  const Material &material() const { return material_; }
  const State &state() const { return state_; }      ///< in the rows that the band knows
  Eigen::Vector2d position(std::size_t place) const; ///< of any site [m]
  double time_step() const { return time_stepping_.step; } ///< of a whole step [s]
  std::optional<std::size_t> tip() const { return fracture_ ? fracture_->tip() : std::nullopt; }
  /// See Fracture::nearest_to_breaking(), of state(), which must be complete; none if bonds do not break.
  std::optional<StretchedBond> nearest_to_breaking() const
  {
    return fracture_ ? fracture_->nearest_to_breaking(state_) : std::nullopt;
  }
  std::size_t n_broken() const { return n_broken_; } ///< bonds broken since the start, the seed's not counted
  std::size_t n_divided_steps() const { return n_divided_steps_; } ///< time steps made in parts since the start
  EnergyBalance energies() const;
  /// Energies by mechanism of the memories of bonds, in the order of Material::n_mechanisms(). Collective.
  std::vector<MechanismEnergy> mechanism_energies() const;
  const Contact *contact() const { return contact_ ? &*contact_ : nullptr; } ///< nullptr: sites do not touch

  static constexpr int most_parts = 1 << 20; ///< into which a step is divided
  static constexpr double shortest = 1e-6;   ///< stretch to which the parts follow a bond [-]

private:
  /// Powers per sheet thickness [W/m], and what they have added up to [J/m]: by account, one a row of the sheet. After
  /// these accounts come one for each mechanism of the memories, a part of `viscous`, and one for each constraint.
  using Ledger = std::vector<std::vector<double>>;
  enum Account : std::size_t
  {
    viscous,  // dissipated by dashpots
    contacts, // from the sheet into contacts
    boundary, // into the sheet from forces on its sites
    mechanisms
  };
  std::size_t of_constraint(std::size_t constraint) const { return mechanisms + material_.n_mechanisms() + constraint; }
  std::string name_of(std::size_t account) const;

  double stored_energy() const // in bonds and their memory [J/m]
  {
    return elastic_energy(state_, band_, material_) + memory_energy(state_, band_, material_);
  }
  void reinitialize_forces();
  void update_powers(double duration);
  void advance(double duration, double end);
  int needed_parts() const;
  /// Refuses a loaded state that cannot have followed from the one set up, of which these were bonds and energy.
  /// @throws std::invalid_argument
  void check_loaded(const BondStates &before, double energy) const;

  RowPartition band_;
  const TriangularLattice &lattice_;
  Material material_;
  State state_;
  TimeStepping time_stepping_;
  Forces forces_;
  std::unique_ptr<Integrator> integrator_;
  std::optional<Fracture> fracture_;
  std::optional<Contact> contact_;
  std::vector<std::unique_ptr<SiteForces>> added_forces_;
  bool has_end_loads_ = false;
  std::vector<PrescribedMotion> constraints_;
  std::vector<BrokenBond> broken_bonds_; // in the last step

  int parts_ = 1; // that the next step needs, a power of two: the same on all ranks
  std::size_t n_divided_steps_ = 0;
  std::size_t n_broken_ = 0;
  double initial_energy_ = 0.;
  double broken_ = 0.;
  Ledger powers_, work_;
};

template <class Archive>
void Simulation::archive(Archive &archive)
{
  const std::vector<std::size_t> known = band_.known_rows(), all = RowPartition(lattice_).known_rows();
  // Of this very simulation, on this rank.
  constexpr bool is_snapshot = std::is_same_v<Archive, Snapshot::Archive<Archive::loads>>;
  constexpr bool is_checked = Archive::loads && !is_snapshot;
  BondStates bonds_before;
  const double energy_before = initial_energy_;
  if constexpr (is_checked)
    bonds_before = state_.bonds;
  if constexpr (Archive::loads) // those that were let go after the instant that is loaded
    for (const PrescribedMotion &constraint : constraints_)
      constraint.hold(state_);
  archive("time", state_.time);
  for_each_field(state_, lattice_,
                 [&](const std::string &name, auto &field) { archive_rows(archive, name, field, band_, known); });
  archive_rows(archive, "lost_bonds", state_.lost_bonds, band_, all);
  for (const auto &[name, ledger] : {std::pair("powers_", &powers_), std::pair("work_", &work_)})
    for (std::size_t account = 0; account < ledger->size(); ++account)
    {
      std::vector<double> &of_rows = (*ledger)[account];
      if constexpr (!Archive::loads && !is_snapshot)
        of_rows = band_.all_rows(of_rows);
      archive(name + name_of(account), of_rows);
      support::require(of_rows.size() == lattice_.rows(),
                       "`" + (name + name_of(account)) + "` is of a sheet of another size");
    }
  archive("parts", parts_);
  archive("n_divided_steps", n_divided_steps_);
  archive("n_broken", n_broken_);
  archive("initial_energy", initial_energy_);
  archive("broken_energy", broken_);
  for (std::size_t c = 0; c < constraints_.size(); ++c)
    archive("constraint_" + std::to_string(c), constraints_[c]);
  if (fracture_)
    archive("fracture", *fracture_);
  if constexpr (is_checked)
    check_loaded(bonds_before, energy_before);
  if constexpr (Archive::loads)
  {
    update_images(state_, band_);
    for (const PrescribedMotion &constraint : constraints_)
      constraint.free_if_released(state_, material_);
    integrator_->find_rollers(state_);
    // The candidate pairs of contacts follow from the state.
    if (contact_)
      contact_->find_candidates(state_);
  }
}

} // namespace latcon::lattice
