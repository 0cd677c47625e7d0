#include "lattice/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "support/require.h"

namespace latcon::lattice
{

Simulation::Simulation(const RowPartition &band, const Material &material, State initial, TimeStepping time_stepping,
                       std::optional<Fracture> fracture)
  : band_(band), lattice_(band.lattice()), material_(material), state_(std::move(initial)),
    time_stepping_(time_stepping), forces_(band, material), fracture_(std::move(fracture)),
    powers_(of_constraint(0), std::vector<double>(lattice_.rows(), 0.)), work_(powers_)
{
  if (time_stepping.make)
    integrator_ = time_stepping.make(band, forces_);
  else if (time_stepping.stages == 0)
    integrator_ = std::make_unique<VelocityVerlet>(band, forces_, time_stepping.step);
  else
    integrator_ = std::make_unique<RungeKuttaChebyshev>(band, forces_, time_stepping.step, time_stepping.stages);
  if (state_.history.empty())
    relax_memory(state_, band_, material_);
  bool fits = state_.history.kinds.size() == lattice_.n_kinds();
  for (std::size_t kind = 0; fits && kind < lattice_.n_kinds(); ++kind)
  {
    const BondHistory::Kind &history = state_.history.kinds[kind];
    const Shell *shell = material_.shell(lattice_, kind);
    fits = history.variables.size() == (shell != nullptr ? properties(shell->memory).n_variables : 0);
    for (const Field &variable : history.variables)
      fits = fits && variable.size() == lattice_.n_places() && history.stretch.size() == lattice_.n_places();
  }
  support::require(fits, "the history of the bonds does not fit the lattice or the memories of the material");
  support::require(state_.stiffness.empty() ==
                     (material_.disorder.stiffness.is_none() && lattice_.scattered() == nullptr),
                   "the stiffness of the bonds does not have the disorder of the material");
  if (fracture_)
    fracture_->configure(state_, forces_);
  forces_.set_shortness_threshold(
    watched_stretch(time_stepping, lattice_, material_, fracture_ ? fracture_->largest_limit() : unbreakable));
  reinitialize_forces();
  initial_energy_ = stored_energy() + kinetic_energy(state_, band_);
}

void Simulation::reinitialize_forces()
{
  if (contact_)
    contact_->find_candidates(state_);
  integrator_->initialise(state_);
  update_powers(0.);
  parts_ = needed_parts();
  band_.all_gather(std::vector<char>(), &parts_);
}

// Number of parts, a power of two, of which the next step must consist for each part to be stable in own rows: with
// every short bond at its extrapolated stretch at the end of the part.
int Simulation::needed_parts() const
{
  const double h = time_stepping_.step;
  const std::optional<ContactLaw> contact = contact_ ? std::optional(contact_->law()) : std::nullopt;
  const VectorField &velocity = integrator_->evaluated_velocity(state_);
  const auto divide_for = [&](const Bond &bond, int &parts)
  {
    if (!stiffens_when_short(material_.shell(lattice_, bond.kind)->law))
      return;
    const double now = stretch(state_, lattice_, bond), rate = stretch_rate(state_, lattice_, bond, velocity);
    int needed = 1;
    for (; needed < most_parts; needed *= 2)
    {
      const double part = h / needed, then = now + std::min(rate, 0.) * part;
      if (!(then < short_stretch) ||
          !(part > recoil_step(time_stepping_, lattice_, material_, bond.kind, std::max(then, shortest), contact)))
        break;
    }
    parts = std::max(parts, needed);
  };
  std::vector<std::size_t> rows;
  for (std::size_t row = band_.rows().begin; row < band_.rows().end; ++row)
    if (forces_.row_sums(row).has_short_bonds)
      rows.push_back(row);
  int parts = 1;
  const bool threads = rows.size() * lattice_.stride() >= min_places_for_threads;
#pragma omp parallel for schedule(dynamic) reduction(max : parts) if (threads)
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const std::size_t row = rows[i];
    // A hair more for round-off.
    if (forces_.row_has_short_bonds_ahead(state_, velocity, row, h, (1. + 1e-9) * short_stretch))
      for_each_bond(state_, lattice_, {row, row + 1}, [&](const Bond &bond) { divide_for(bond, parts); });
  }
  return parts;
}

std::string Simulation::name_of(std::size_t account) const
{
  if (account < mechanisms)
    return std::array{"viscous", "contact", "boundary"}[account];
  return account < of_constraint(0) ? "mechanism_" + std::to_string(account - mechanisms)
                                    : "constraint_" + std::to_string(account - of_constraint(0));
}

// Powers at the last evaluation. Their work over the `duration` since the one before follows by the trapezoidal rule.
void Simulation::update_powers(double duration)
{
  const Ledger before = powers_;
  for (std::vector<double> &power : powers_)
    std::fill(power.begin(), power.end(), 0.);
  for (std::size_t row = band_.rows().begin; row < band_.rows().end; ++row)
  {
    const kernels::RowSums &sums = forces_.row_sums(row);
    powers_[viscous][row] = sums.viscous_power;
    for (std::size_t m = 0; m < sums.mechanism_power.size(); ++m)
      powers_[mechanisms + m][row] = sums.mechanism_power[m];
  }
  std::vector<const SiteForces *> site_forces;
  const auto add = [&](const SiteForces &forces, Account account, double sign)
  {
    for (const auto &[place, force] : forces.last())
      powers_[account][lattice_.row_of(place)] += sign * force.dot(state_.velocity.at(place));
    site_forces.push_back(&forces);
  };
  if (contact_)
    add(*contact_, contacts, -1.);
  for (const std::unique_ptr<SiteForces> &added : added_forces_)
    add(*added, boundary, 1.);
  for (std::size_t c = 0; c < constraints_.size(); ++c)
    constraints_[c].add_power(state_, forces_.on_sites(), site_forces, powers_[of_constraint(c)]);
  if (!(duration > 0.))
    return;
  for (std::size_t account = 0; account < powers_.size(); ++account)
  {
    const bool is_energy =
      account >= mechanisms && account < of_constraint(0) && forces_.gives_energy(account - mechanisms);
    for (std::size_t row = band_.rows().begin; row < band_.rows().end; ++row)
    {
      const double now = powers_[account][row];
      work_[account][row] += is_energy ? now : 0.5 * duration * (before[account][row] + now);
      if (is_energy)
        work_[viscous][row] += now;
    }
  }
}

void Simulation::enable_contact(const ContactLaw &law)
{
  if (contact_)
    throw std::logic_error("contact has been added to this simulation already");
  contact_.emplace(band_, law);
  integrator_->add(*contact_);
  reinitialize_forces();
}

void Simulation::load_ends(const Eigen::Matrix2d &F, EndLoads::End left, EndLoads::End right)
{
  if (has_end_loads_)
    throw std::logic_error("the ends of this sheet are loaded already");
  if (std::any_of(state_.lost_bonds.begin(), state_.lost_bonds.end(), [](std::uint8_t lost) { return lost > 0; }))
    throw std::logic_error("the ends of a sheet must be loaded before any of its bonds is cut or broken");
  add(std::make_unique<EndLoads>(band_, material_, state_, F, left, right));
  has_end_loads_ = true;
}

void Simulation::add(std::unique_ptr<SiteForces> forces)
{
  integrator_->add(*forces);
  added_forces_.push_back(std::move(forces));
  reinitialize_forces();
}

void Simulation::cut(const std::vector<std::size_t> &places)
{
  if (!fracture_)
    throw std::logic_error("a sheet without fracture rules cannot be cut");
  const double kinetic = kinetic_energy(state_, band_);
  broken_ += fracture_->remove_sites(state_, places);
  broken_ += kinetic - kinetic_energy(state_, band_);
  fracture_->locate_tip(state_);
  reinitialize_forces();
}

void Simulation::cut_bonds(const std::vector<std::pair<std::size_t, std::size_t>> &bonds)
{
  if (!fracture_)
    throw std::logic_error("a sheet without fracture rules cannot be cut");
  for (const auto &[place, kind] : bonds)
    support::require(lattice_.is_site(place) && kind < lattice_.n_kinds(),
                     "only a bond that starts at a site can be cut");
  broken_ += fracture_->remove_bonds(state_, bonds);
  fracture_->locate_tip(state_);
  reinitialize_forces();
}

void Simulation::set_velocities(const VectorField &velocity, bool is_initial)
{
  const double before = kinetic_energy(state_, band_);
  for (const std::size_t place : band_.known_sites())
    for (const std::size_t axis : axes)
      if (state_.inverse_mass[place] > 0. && state_.is_free(place, axis))
        state_.velocity[axis][place] = velocity[axis][place];
  (is_initial ? initial_energy_ : work_[boundary][0]) += kinetic_energy(state_, band_) - before;
  reinitialize_forces();
}

std::size_t Simulation::constrain(const Constraint &constraint)
{
  const PrescribedMotion added(band_, constraint);
  for (const PrescribedMotion &other : constraints_)
    if (added.overlaps(other))
      throw std::logic_error("a site is constrained twice along the same axis");
  const double before = kinetic_energy(state_, band_);
  lattice::constrain(state_, band_, constraint);
  initial_energy_ += kinetic_energy(state_, band_) - before;
  constraints_.push_back(added);
  for (const std::size_t place : constraint.sites)
    forces_.keep(lattice_.row_of(place));
  for (Ledger *ledger : {&powers_, &work_})
    ledger->emplace_back(lattice_.rows(), 0.);
  reinitialize_forces();
  return constraints_.size() - 1;
}

const std::vector<BrokenBond> &Simulation::step()
{
  const double h = time_stepping_.step, end = state_.time + h;
  broken_bonds_.clear();
  n_divided_steps_ += parts_ > 1 ? 1 : 0;
  // Shares are powers of two, so that their sum is exact. After each part the rest is divided anew.
  for (double left = 1.; left > 0.;)
  {
    const double share = std::min(left, 1. / parts_);
    left -= share;
    advance(share * h, end - left * h);
  }
  return broken_bonds_;
}

void Simulation::advance(double duration, double end)
{
  // Forces are evaluated anew only where the velocities of constrained sites change.
  bool changed = false;
  for (std::size_t c = 0; c < constraints_.size(); ++c)
    changed |=
      constraints_[c].prescribe(state_, material_, state_.time, state_.time + duration, work_[of_constraint(c)]);
  if (changed)
    reinitialize_forces();
  integrator_->set_time_step(duration);
  integrator_->step(state_);
  state_.time = end; // without the round-off of added parts: what breaks from here on breaks then

  // Powers are taken before bonds break, so that each interval of the trapezoidal rule sees one set of bonds.
  update_powers(duration);
  parts_ = needed_parts();
  if (!fracture_)
  {
    band_.all_gather(std::vector<char>(), &parts_);
    return;
  }

  const std::vector<BrokenBond> broken =
    fracture_->apply(state_, forces_, integrator_->evaluated_velocity(state_), &parts_);
  if (broken.empty())
    return;
  broken_bonds_.insert(broken_bonds_.end(), broken.begin(), broken.end());
  n_broken_ += broken.size();
  for (const BrokenBond &bond : broken)
    broken_ += bond.energy;
  if (contact_)
  {
    // From this instant on, as the bonds are gone from it.
    contact_->add_broken_bonds(broken);
    integrator_->evaluate_site_forces(state_);
  }
  integrator_->update_accelerations(state_, broken);
  update_powers(0.);
}

void Simulation::save(Snapshot &snapshot)
{
  Snapshot::Archive<false> saving(snapshot);
  archive(saving);
}

void Simulation::restore(const Snapshot &earlier)
{
  Snapshot::Archive<true> loading(earlier);
  archive(loading);
}

Eigen::Vector2d Simulation::position(std::size_t place) const
{
  Eigen::Vector2d x = state_.position.at(place);
  if (band_.is_shared())
    MPI_Bcast(x.data(), 2, MPI_DOUBLE, static_cast<int>(band_.owner(lattice_.row_of(place))), band_.communicator());
  return x;
}

const State &Simulation::gather(Rows rows)
{
  for_each_field(state_, lattice_, [&](const std::string &, auto &field) { band_.gather(field, rows); });
  for (BondFactors *factors : {&state_.stiffness, &state_.strength})
    for (Field &of_kind : factors->kinds)
      if (!of_kind.empty())
        band_.gather(of_kind, rows);
  if (band_.is_first())
    update_images(state_, lattice_);
  return state_;
}

void Simulation::check_loaded(const BondStates &before, double energy) const
{
  support::require(state_.time >= 0., "`time` is negative");
  support::require(parts_ >= 1 && parts_ <= most_parts && (parts_ & (parts_ - 1)) == 0,
                   "`parts` of a step are no power of two up to " + std::to_string(most_parts));
  // It was computed from the same input: only another compiler may have rounded otherwise.
  support::require(std::abs(initial_energy_ - energy) <= 1e-9 * std::abs(energy),
                   "`initial_energy` is not that of the case");
  for (const std::size_t place : band_.known_sites())
    for (std::size_t kind = 0; kind < before.n_kinds(); ++kind)
      support::require(before.present(place, kind) ||
                         (!state_.bonds.present(place, kind) && !state_.bonds.toughened(place, kind)),
                       "`bonds` has some that the sheet never had");
  for (const std::uint8_t lost : state_.lost_bonds)
    support::require(lost <= material_.coordination(lattice_), "`lost_bonds` are more than a site has");
}

EnergyBalance Simulation::energies() const
{
  double boundary_work = band_.sum(work_[boundary]);
  for (std::size_t c = 0; c < constraints_.size(); ++c)
    boundary_work += constraint_work(c);
  return {stored_energy(), kinetic_energy(state_, band_), band_.sum(work_[viscous]),
          broken_,         band_.sum(work_[contacts]),    boundary_work,
          initial_energy_};
}

std::vector<MechanismEnergy> Simulation::mechanism_energies() const
{
  std::vector<MechanismEnergy> energies;
  for (const double stored : memory_energies(state_, band_, material_))
    energies.push_back({stored, band_.sum(work_[mechanisms + energies.size()])});
  return energies;
}

} // namespace latcon::lattice
