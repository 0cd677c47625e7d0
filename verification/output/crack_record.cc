#include "verification/output/crack_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "lattice/archive_rows.h"
#include "support/errors.h"
#include "support/full_precision.h"
#include "verification/analysis/fragments.h"
#include "verification/output/crack_json.h"
#include "verification/output/mechanism_names.h"

namespace latcon::output
{
namespace
{

// The tip hops between sites, so its speed is meaningful only over several of them.
constexpr double speed_baseline = 6.; // in spacings

void write_row(std::ostream &out, std::initializer_list<double> values)
{
  const char *separator = "";
  for (const double value : values)
  {
    out << separator << support::full_precision(value);
    separator = ",";
  }
}

// Fastest site; a site whose position or velocity is not finite takes precedence.
struct FastestSite
{
  std::size_t place = 0;
  double speed = -1.; // [m/s]
};

FastestSite fastest_site(const lattice::Simulation &simulation)
{
  const lattice::TriangularLattice &sheet = simulation.lattice();
  const lattice::State &state = simulation.state();
  FastestSite fastest;
  const lattice::Rows rows = simulation.band().rows();
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      double speed = std::hypot(state.vx[place], state.vy[place]);
      if (!std::isfinite(speed) || !std::isfinite(state.x[place]) || !std::isfinite(state.y[place]))
        speed = std::numeric_limits<double>::infinity();
      if (speed > fastest.speed)
        fastest = {place, speed};
    }
  for (const FastestSite &other : simulation.band().all_gather(std::vector<FastestSite>{fastest}))
    if (other.speed > fastest.speed || (other.speed == fastest.speed && other.place < fastest.place))
      fastest = other;
  return fastest;
}

} // namespace

CrackRecord::CrackRecord(lattice::Simulation &simulation, std::string step_entry)
  : simulation_(simulation), step_entry_(std::move(step_entry)), mechanisms_(mechanism_names(simulation.material()))
{
}

void CrackRecord::start()
{
  record_tip();
  energies();
}

void CrackRecord::step(const std::vector<lattice::BrokenBond> &broken)
{
  if (broken.empty())
    return;
  broken_.insert(broken_.end(), broken.begin(), broken.end());
  record_tip();
}

void CrackRecord::record_tip()
{
  const std::optional<std::size_t> tip = simulation_.tip();
  if (!tip || tip == last_tip_)
    return;
  last_tip_ = tip;
  const double time = simulation_.state().time;
  const Eigen::Vector2d X = simulation_.lattice().reference(*tip), x = simulation_.position(*tip);
  tip_.push_back({time, X.x(), X.y(), x.x(), x.y()});
  broken_at_tip_.push_back(simulation_.n_broken());

  double speed = 0.;
  const double baseline = speed_baseline * simulation_.lattice().spacing();
  for (std::size_t i = tip_.size() - 1; i-- > 0;)
    if (X.x() - tip_[i].X >= baseline && time > tip_[i].t)
    {
      speed = (X.x() - tip_[i].X) / (time - tip_[i].t);
      break;
    }
  speeds_.push_back(speed);
}

void CrackRecord::energies()
{
  energies_.push_back({simulation_.state().time, sound_energies()});
  for (const lattice::MechanismEnergy &mechanism : simulation_.mechanism_energies())
    mechanism_energies_.insert(mechanism_energies_.end(), {mechanism.stored, mechanism.dissipated});
}

lattice::EnergyBalance CrackRecord::sound_energies()
{
  const lattice::EnergyBalance balance = simulation_.energies();
  const double available = balance.initial + std::abs(balance.boundary_work);
  if (balance.elastic + balance.kinetic <= 2. * available)
  {
    simulation_.save(last_sound_);
    return balance;
  }
  const FastestSite fastest = fastest_site(simulation_);
  const Eigen::Vector2d X = simulation_.lattice().reference(fastest.place);
  std::ostringstream message;
  message << "the simulation became unstable: at " << simulation_.state().time << " s the lattice has "
          << balance.elastic << " J/m elastic and " << balance.kinetic << " J/m kinetic energy, of " << available
          << " J/m supplied; the fastest site is number " << simulation_.lattice().site_number(fastest.place)
          << " at X = " << X.x() << " m, Y = " << X.y() << " m, with " << fastest.speed << " m/s; ";
  if (!last_sound_.empty())
  {
    message << "the last frame shows the last valid state, at " << last_sound_.time() << " s; ";
    simulation_.restore(last_sound_);
  }
  message << "try a smaller " << step_entry_;
  throw support::SolverError(message.str());
}

void CrackRecord::check_loaded() const
{
  using lattice::require_archived;
  const lattice::TriangularLattice &sheet = simulation_.lattice();
  const auto is_site = [&](std::size_t place) { return place < sheet.n_places() && sheet.is_site(place); };
  const double now = simulation_.state().time;
  require_archived(speeds_.size() == tip_.size() && broken_at_tip_.size() == tip_.size(),
                   "the numbers of `speeds`, `broken_at_tip` and records of the tip do not match");
  require_archived(last_tip_.has_value() == !tip_.empty() && (!last_tip_ || is_site(*last_tip_)),
                   "`last_tip` is not a site of the sheet");
  require_archived(broken_.size() == simulation_.n_broken(), "the number of `broken_bonds` does not match the state");
  require_archived(!energies_.empty(), "`energies` is empty");
  require_archived(mechanism_energies_.size() == 2 * mechanisms_.size() * energies_.size(),
                   "the number of `mechanism_energies` does not match `energies`");
  double before = 0.;
  const auto require_order = [&](double time, const std::string &what)
  {
    require_archived(time >= before && time <= now, "times of `" + what + "` do not increase up to the current time");
    before = time;
  };
  for (const analysis::TipRecord &tip : tip_)
  {
    require_order(tip.t, "tip");
    require_archived(std::abs(tip.X) <= sheet.length() + sheet.spacing(), "`tip` is outside the sheet");
  }
  before = 0.;
  for (const EnergyRow &row : energies_)
    require_order(row.time, "energies");
  before = 0.;
  for (const lattice::BrokenBond &bond : broken_)
  {
    require_order(bond.time, "broken_bonds");
    require_archived(is_site(bond.near) && is_site(bond.far) && bond.kind < simulation_.state().bonds.n_kinds(),
                     "`broken_bonds` contains bonds that the sheet does not have");
  }
}

double CrackRecord::imbalance() const
{
  LedgerCheck check;
  for (const auto &[time, e] : energies_)
    check.add({time, e.elastic, e.kinetic, e.viscous, e.broken, 0., e.boundary_work, e.imbalance()});
  return check.imbalance();
}

analysis::CrackMeasurement CrackRecord::measure(double seed_tip_X) const
{
  std::vector<analysis::BreakRecord> breaks;
  for (const lattice::BrokenBond &bond : broken_)
    breaks.push_back({bond.time, bond.midpoint.x(), bond.midpoint.y()});
  analysis::CrackMeasurementOptions options;
  options.strip_length = simulation_.lattice().length();
  options.lattice_spacing = simulation_.lattice().spacing();
  options.end_time = simulation_.state().time;
  options.seed_tip_X = seed_tip_X;
  return analysis::measure_crack(tip_, breaks, options);
}

TextFiles CrackRecord::tables(const std::filesystem::path &directory) const
{
  std::ostringstream crack, broken, energy;
  crack << "t,X,Y,x,y,speed,bonds_broken\n";
  for (std::size_t i = 0; i < tip_.size(); ++i)
  {
    write_row(crack, {tip_[i].t, tip_[i].X, tip_[i].Y, tip_[i].x, tip_[i].y, speeds_[i]});
    crack << ',' << broken_at_tip_[i] << '\n';
  }
  broken << "t,site,other_site,X,Y,stretch\n";
  const lattice::TriangularLattice &sheet = simulation_.lattice();
  for (const lattice::BrokenBond &bond : broken_)
  {
    broken << support::full_precision(bond.time) << ',' << sheet.site_number(bond.near) << ','
           << sheet.site_number(bond.far) << ',';
    write_row(broken, {bond.midpoint.x(), bond.midpoint.y(), bond.stretch});
    broken << '\n';
  }
  energy << "t,elastic,kinetic,viscous,broken,boundary_work,contact,imbalance";
  for (const std::string &mechanism : mechanisms_)
    energy << ',' << mechanism << "_stored," << mechanism << "_dissipated";
  energy << '\n';
  auto of_mechanism = mechanism_energies_.begin();
  for (const auto &[time, e] : energies_)
  {
    write_row(energy, {time, e.elastic, e.kinetic, e.viscous, e.broken, e.boundary_work, e.contact, e.imbalance()});
    for (std::size_t i = 0; i < 2 * mechanisms_.size(); ++i)
      energy << ',' << support::full_precision(*of_mechanism++);
    energy << '\n';
  }
  return {{directory / "crack.csv", crack.str()},
          {directory / "broken_bonds.csv", broken.str()},
          {directory / "energy.csv", energy.str()}};
}

void CrackRecord::write_measurement(const std::filesystem::path &directory,
                                    const analysis::CrackMeasurement &measurement, double seed_tip_X,
                                    double breaking_stretch, bool skip_verification)
{
  const lattice::State &state = simulation_.gather();
  if (!simulation_.band().is_first())
    return;
  nlohmann::ordered_json json = crack_json(measurement);
  const auto put_flanks = [&](const std::string &name, double analysis::FlankDamage::*number)
  { json[name] = measurement.flanks ? nlohmann::ordered_json((*measurement.flanks).*number) : nullptr; };
  put_flanks("flank_damage_depth", &analysis::FlankDamage::depth);
  put_flanks("flank_damage_share", &analysis::FlankDamage::share);
  json["bonds_broken"] = simulation_.n_broken();
  const analysis::Fragments fragments = analysis::find_fragments(state, simulation_.lattice());
  json["detached_sites"] = std::accumulate(fragments.sizes.begin(), fragments.sizes.end(), std::size_t{0});
  json["detached_fragments"] = fragments.sizes.size();
  json["largest_fragment"] = fragments.sizes.empty() ? 0 : fragments.sizes.front();
  json["overstretched_bonds"] = analysis::n_overstretched_bonds(state, simulation_.lattice(), breaking_stretch);
  if (const auto bond = simulation_.nearest_to_breaking())
  {
    const lattice::TriangularLattice &sheet = simulation_.lattice();
    const Eigen::Vector2d X = sheet.reference(bond->near) + 0.5 * sheet.bond_vector(bond->kind);
    json["nearest_to_breaking"] = {{"site", sheet.site_number(bond->near)},
                                   {"other_site", sheet.site_number(bond->far)},
                                   {"X", X.x()},
                                   {"Y", X.y()},
                                   {"stretch", bond->stretch},
                                   {"limit", bond->limit}};
  }
  json["bridged_length"] = analysis::bridged_length(state, simulation_.lattice(), seed_tip_X, tip_X());
  json["end_time"] = state.time;
  json["energy_imbalance"] = imbalance();
  json["skip_verification"] = skip_verification;
  json["units"] = "speeds m/s, lengths m in the undeformed sheet, time s; uncertainties are one standard deviation";
  write_file(directory / "crack.json", json.dump(2) + "\n");
}

} // namespace latcon::output
