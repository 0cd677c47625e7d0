#pragma once

#include <memory>
#include <optional>

#include "lattice/contact.h"
#include "lattice/end_loads.h"
#include "lattice/energy.h"
#include "lattice/fracture.h"
#include "lattice/integrator.h"
#include "lattice/time_step.h"

namespace lattice
{

/// A sheet in motion: state, forces, time stepping, fracture and the energy ledger, one step at a time.
class Simulation
{
public:
  /// @param initial loaded state; its accelerations are computed here
  /// @param fracture breaking rules; none for a sheet whose bonds never break
  Simulation(const TriangularLattice &lattice, const Material &material, State initial, TimeStepping time_stepping,
             std::optional<Fracture> fracture = std::nullopt);
  Simulation(const Simulation &) = delete; // parts refer to each other
  Simulation &operator=(const Simulation &) = delete;

  /// Has sites that are not bonded repel each other from now on. To be called once at most.
  void let_touch(const ContactLaw &law);

  /// Loads the short ends of the unbroken sheet as if it went on at x = F X. To be called once at most, before cut().
  void load_ends(const Eigen::Matrix2d &F, EndLoads::End left, EndLoads::End right);

  /// Cuts sites out of the sheet before it moves. @throws std::logic_error without fracture rules
  void cut(const std::vector<std::size_t> &places);

  /// Lets the held sites move with v = L X from now on, L [1/s] in the reference frame.
  void move_edges(const Eigen::Matrix2d &velocity_gradient);

  /// Adds a velocity field to the free sites; for waves and for tests. One (vx, vy) a place [m/s].
  void set_velocities(const Field &vx, const Field &vy);

  /// Advances by one time step. @return bonds that broke in it
  const std::vector<BrokenBond> &step();

  const TriangularLattice &lattice() const { return lattice_; }
  const Material &material() const { return material_; }
  const State &state() const { return state_; }
  const Forces &forces() const { return forces_; }
  double time_step() const { return integrator_->time_step(); }
  std::optional<std::size_t> tip() const;
  std::size_t n_broken() const { return n_broken_; } ///< bonds broken since the start, the seed's not counted
  EnergyBalance energies() const;
  const Contact *contact() const { return contact_ ? &*contact_ : nullptr; } ///< nullptr: sites do not touch

private:
  void restart();
  void note_powers();

  const TriangularLattice &lattice_;
  const Material &material_;
  State state_;
  Forces forces_;
  std::unique_ptr<Integrator> integrator_;
  std::optional<Fracture> fracture_;
  std::optional<Contact> contact_;
  std::optional<EndLoads> end_loads_;
  std::vector<BrokenBond> no_bonds_;

  bool edges_move_ = false;
  std::size_t n_broken_ = 0;
  double initial_energy_ = 0.;
  double viscous_ = 0., broken_ = 0., contact_energy_ = 0., boundary_work_ = 0.;
  double contact_power_ = 0., boundary_power_ = 0.; // from the sheet, into the sheet
};

} // namespace lattice
