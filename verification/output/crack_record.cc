#include "verification/output/crack_record.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "support/require.h"
#include "verification/analysis/fragments.h"

namespace latcon::output
{
namespace
{

using Json = nlohmann::ordered_json;

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
      double speed = std::hypot(state.velocity.x[place], state.velocity.y[place]);
      if (!std::isfinite(speed) || !std::isfinite(state.position.x[place]) || !std::isfinite(state.position.y[place]))
        speed = std::numeric_limits<double>::infinity();
      if (speed > fastest.speed)
        fastest = {place, speed};
    }
  for (const FastestSite &other : simulation.band().all_gather(std::vector<FastestSite>{fastest}))
    if (other.speed > fastest.speed || (other.speed == fastest.speed && other.place < fastest.place))
      fastest = other;
  return fastest;
}

// What crack.json says of every crack: pattern, reason, measured quantities with uncertainties, and the thresholds that
// decided.
Json crack_json(const analysis::CrackMeasurement &measurement)
{
  Json json;
  json["pattern"] = to_string(measurement.pattern);
  json["reason"] = measurement.reason;
  const auto put = [&json](const std::string &name, const std::optional<analysis::Measured> &measured)
  {
    json[name] = measured ? Json(measured->value) : Json();
    json[name + "_uncertainty"] = measured ? Json(measured->uncertainty) : Json();
  };
  put("speed_lagrangian", measurement.speed_lagrangian);
  put("speed_laboratory", measurement.speed_laboratory);
  put("wavelength", measurement.wavelength);
  put("amplitude", measurement.amplitude);
  put("crest_amplitude", measurement.crest_amplitude);
  for (const char *name : {"sinusoid_offset", "sinusoid_slope", "sinusoid_phase"})
    json[name] = nullptr;
  if (measurement.wavelength)
  {
    const analysis::Sinusoid curve = measurement.sinusoid->curve.about(0.);
    json["sinusoid_offset"] = curve.offset;
    json["sinusoid_slope"] = curve.slope;
    json["sinusoid_phase"] = std::atan2(curve.cosine, curve.sine);
  }
  json["periods"] = measurement.periods;
  json["window_begin"] = measurement.X_begin;
  json["window_end"] = measurement.X_end;
  json["branched_fraction"] = measurement.branched_fraction;
  const analysis::CrackMeasurementOptions limits;
  json["thresholds"] = {
    {"run_in_fraction", limits.run_in_fraction},       {"clamp_fraction", limits.clamp_fraction},
    {"min_wavelength", limits.min_wavelength},         {"min_amplitude", limits.min_amplitude},
    {"max_steepness", limits.max_steepness},           {"min_share", limits.min_share},
    {"max_straight_rms", limits.max_straight_rms},     {"min_periods", limits.min_periods},
    {"clear_periods", limits.clear_periods},           {"min_log_evidence", limits.min_log_evidence},
    {"clear_log_evidence", limits.clear_log_evidence}, {"steady_amplitude", limits.steady_amplitude},
    {"arrest_fraction", limits.arrest_fraction},       {"min_branched_fraction", limits.min_branched_fraction}};
  return json;
}

} // namespace

CrackRecord::CrackRecord(lattice::Simulation &simulation, std::string step_entry)
  : simulation_(simulation), step_entry_(std::move(step_entry)),
    tip_(simulation.lattice().lattice_spacing(), simulation.lattice().length()),
    energies_(mechanism_names(simulation.material())),
    at_rest_(energy_at_rest(simulation.material(), simulation.lattice().length() * simulation.lattice().height()))
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
  const Eigen::Vector2d X = simulation_.lattice().reference(*tip), x = simulation_.position(*tip);
  tip_.add({simulation_.state().time, X.x(), X.y(), x.x(), x.y(), simulation_.n_broken()});
}

void CrackRecord::energies()
{
  energies_.add(simulation_.state().time, checked_energies(), simulation_.mechanism_energies());
}

lattice::EnergyBalance CrackRecord::checked_energies()
{
  const lattice::EnergyBalance balance = simulation_.energies();
  const double available = balance.initial + std::abs(balance.boundary_work);
  if (balance.elastic + balance.kinetic <= 2. * available + at_rest_)
  {
    simulation_.save(last_valid_state_);
    return balance;
  }
  const FastestSite fastest = fastest_site(simulation_);
  const Eigen::Vector2d X = simulation_.lattice().reference(fastest.place);
  std::ostringstream message;
  message << "the simulation became unstable: at " << simulation_.state().time << " s the lattice has "
          << balance.elastic << " J/m elastic and " << balance.kinetic << " J/m kinetic energy, of " << available
          << " J/m supplied; the fastest site is number " << simulation_.lattice().site_number(fastest.place)
          << " at X = " << X.x() << " m, Y = " << X.y() << " m, with " << fastest.speed << " m/s; ";
  if (!last_valid_state_.empty())
  {
    simulation_.restore(last_valid_state_);
    message << "the last frame shows the last valid state, at " << simulation_.state().time << " s; ";
  }
  message << "try a smaller " << step_entry_;
  throw support::SolverError(message.str());
}

void CrackRecord::check_loaded() const
{
  using support::require;
  const lattice::TriangularLattice &sheet = simulation_.lattice();
  const auto is_site = [&](std::size_t place) { return place < sheet.n_places() && sheet.is_site(place); };
  require(last_tip_.has_value() == !tip_.records().empty() && (!last_tip_ || is_site(*last_tip_)),
          "`last_tip` is not a site of the sheet");
  require(broken_.size() == simulation_.n_broken(), "the number of `broken_bonds` does not match the state");
  require_increasing_times(broken_, simulation_.state().time, "broken_bonds",
                           [](const lattice::BrokenBond &bond) { return bond.time; });
  for (const lattice::BrokenBond &bond : broken_)
    require(is_site(bond.near) && is_site(bond.far) && bond.kind < simulation_.state().bonds.n_kinds(),
            "`broken_bonds` contains bonds that the sheet does not have");
}

double CrackRecord::imbalance() const
{
  return energies_.imbalance(
    at_rest_, [](double time, const lattice::EnergyBalance &e)
    { return LedgerState{time, e.elastic, e.kinetic, e.viscous, e.broken, e.boundary_work, e.imbalance()}; });
}

analysis::CrackMeasurement CrackRecord::measure(double seed_tip_X) const
{
  std::vector<analysis::BreakRecord> breaks;
  for (const lattice::BrokenBond &bond : broken_)
    breaks.push_back({bond.time, bond.X, bond.Y});
  analysis::CrackMeasurementOptions options;
  options.strip_length = simulation_.lattice().length();
  options.lattice_spacing = simulation_.lattice().lattice_spacing();
  // Of a nonlocal continuum: points are closer, and more bonds cross a crack.
  const lattice::TriangularLattice &sheet = simulation_.lattice();
  const lattice::Material &material = simulation_.material();
  const double d = options.lattice_spacing,
               bonds = sheet.scattered() != nullptr ? sheet.scattered()->bonds_of_point : material.coordination(sheet);
  options.position_error *= sheet.spacing() / d;
  options.branch_rule.bonds_per_spacing *=
    lattice::half_sqrt3 * d * d / sheet.site_area() * bonds / material.coordination();
  options.end_time = simulation_.state().time;
  options.seed_tip_X = seed_tip_X;
  return analysis::measure_crack(tip_.records(), breaks, options);
}

TextFiles CrackRecord::tables(const std::filesystem::path &directory) const
{
  const lattice::TriangularLattice &sheet = simulation_.lattice();
  Table broken({"t", "site", "other_site", "X", "Y", "stretch"});
  for (const lattice::BrokenBond &bond : broken_)
    broken.add({bond.time, sheet.site_number(bond.near), sheet.site_number(bond.far), bond.X, bond.Y, bond.stretch});
  return {{directory / "crack.csv", tip_.csv()},
          {directory / "broken_bonds.csv", broken.csv()},
          {directory / "energy.csv",
           energies_.csv({"elastic", "kinetic", "viscous", "broken", "boundary_work", "contact", "imbalance"},
                         [](const lattice::EnergyBalance &e) {
                           return std::array{e.elastic,       e.kinetic, e.viscous,    e.broken,
                                             e.boundary_work, e.contact, e.imbalance()};
                         })}};
}

void CrackRecord::write_measurement(const std::filesystem::path &directory,
                                    const analysis::CrackMeasurement &measurement, double seed_tip_X,
                                    const input::Case &input, bool skip_verification)
{
  const lattice::State &state = simulation_.gather();
  if (!simulation_.band().is_first())
    return;
  Json json = crack_json(measurement);
  if (input.nonlocal.is_used)
    json["side"] = "continuum";
  const auto put_flanks = [&](const std::string &name, double analysis::FlankDamage::*number)
  { json[name] = measurement.flanks ? Json((*measurement.flanks).*number) : Json(); };
  put_flanks("flank_damage_depth", &analysis::FlankDamage::depth);
  put_flanks("flank_damage_share", &analysis::FlankDamage::share);
  json["bonds_broken"] = simulation_.n_broken();
  const analysis::Fragments fragments = analysis::find_fragments(state, simulation_.lattice());
  json["detached_sites"] = std::accumulate(fragments.sizes.begin(), fragments.sizes.end(), std::size_t{0});
  json["detached_fragments"] = fragments.sizes.size();
  json["largest_fragment"] = fragments.sizes.empty() ? 0 : fragments.sizes.front();
  json["overstretched_bonds"] = analysis::n_overstretched_bonds(state, simulation_.lattice(), *input.breaking_rule());
  if (const auto bond = simulation_.nearest_to_breaking())
  {
    const lattice::TriangularLattice &sheet = simulation_.lattice();
    const Eigen::Vector2d X = sheet.reference(bond->near) + 0.5 * sheet.bond_vector(*bond);
    json["nearest_to_breaking"] = {{"site", sheet.site_number(bond->near)},
                                   {"other_site", sheet.site_number(bond->far)},
                                   {"X", X.x()},
                                   {"Y", X.y()},
                                   {"stretch", bond->stretch},
                                   {"limit", bond->limit}};
  }
  json["bridged_length"] = analysis::bridged_length(state, simulation_.lattice(), seed_tip_X, tip_.X());
  json["end_time"] = state.time;
  json["energy_imbalance"] = imbalance();
  json["skip_verification"] = skip_verification;
  json["units"] = "speeds m/s, lengths m in the undeformed sheet, time s; uncertainties are one standard deviation";
  write_file(directory / "crack.json", json.dump(2) + "\n");
}

} // namespace latcon::output
