#include "verification/claims/running_crack/tip_field.h"

#include <algorithm>
#include <limits>

#include "lattice/simulation.h"
#include "lattice/site_fields.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "verification/claims/bonds.h"
#include "verification/output/field_writer.h"

namespace latcon::claims
{
namespace
{

// Bond that crosses the line of the crack, and its position.
struct Crossing
{
  double X; // [m]
  std::pair<std::size_t, std::size_t> bond;
};

// In the order in which the tip passes them; bonds behind the start remain.
std::vector<Crossing> crossings(const CrackDrive &drive, const lattice::TriangularLattice &sheet,
                                const lattice::State &state)
{
  std::vector<Crossing> list;
  for (const lattice::Bond &bond : bonds(state, sheet))
  {
    const Eigen::Vector2d from = sheet.reference(bond.near), along = sheet.bond_vector(bond.kind);
    const double share = (drive.axis() - from.y()) / along.y();
    const double X = from.x() + share * along.x();
    if (share > 0. && share < 1. && X > drive.start)
      list.push_back({X, {bond.near, bond.kind}});
  }
  std::stable_sort(list.begin(), list.end(), [](const Crossing &a, const Crossing &b) { return a.X < b.X; });
  return list;
}

// Steps of equal length that divide the time between samples.
lattice::TimeStepping time_stepping(const CrackDrive &drive, const lattice::TriangularLattice &sheet,
                                    const lattice::Material &material)
{
  constexpr double shortest_bond = 0.5; // at the flanks; the integrator divides steps for shorter ones
  constexpr double safety = 0.8;
  const lattice::TimeStepLimits limits = lattice::time_step_limits(sheet, material, shortest_bond);
  const double chebyshev = safety * lattice::chebyshev_step(sheet, material, shortest_bond);
  const double longest = support::largest_of({chebyshev, safety * limits.combined});
  const double step =
    drive.stride_time() / std::ceil(drive.stride_time() / support::smallest_of({longest, drive.stride_time() / 4.}));
  return chebyshev > safety * limits.combined ? lattice::chebyshev_time_stepping(step, limits, 0)
                                              : lattice::TimeStepping(step);
}

// Power of the dashpots around a site, half of each bond's, per reference area [W/m^3].
double dissipation(const lattice::State &state, const lattice::TriangularLattice &sheet,
                   const lattice::Material &material, std::size_t place)
{
  double power = 0.;
  lattice::for_each_bond_of_site(state, sheet, place,
                                 [&](const lattice::Bond &bond)
                                 {
                                   const auto [near, kind, far] = bond;
                                   const Eigen::Vector2d r = state.position.at(far) - state.position.at(near);
                                   const Eigen::Vector2d rate = state.velocity.at(far) - state.velocity.at(near);
                                   const lattice::Shell &shell = *material.shell(kind);
                                   power += 0.5 * lattice::cross_section(shell, sheet) * shell.viscosity /
                                            sheet.rest_length(kind) * std::pow(rate.dot(r.normalized()), 2);
                                 });
  return power / sheet.site_area();
}

} // namespace

TipValues &TipValues::operator+=(const TipValues &other)
{
  velocity += other.velocity;
  excess += other.excess;
  opening_stress += other.opening_stress;
  dissipation += other.dissipation;
  anisotropy += other.anisotropy;
  excess_stress += other.excess_stress;
  return *this;
}

TipValues TipValues::operator*(double factor) const
{
  return {factor * velocity,    factor * excess,     factor * opening_stress,
          factor * dissipation, factor * anisotropy, factor * excess_stress};
}

std::vector<TipSite> tip_sites(const CrackDrive &drive, const lattice::TriangularLattice &sheet, double X_tip,
                               double reach)
{
  std::vector<TipSite> near;
  for (const std::size_t place : sheet.sites())
  {
    const Eigen::Vector2d X = sheet.reference(place);
    const double xi = X.x() - X_tip, eta = X.y() - drive.axis();
    if (std::hypot(xi, eta) <= reach)
      near.push_back({place, X.x(), xi, std::abs(eta), eta > 0.});
  }
  return near;
}

void TipField::add(const TipSite &site, const TipValues &values)
{
  Sum &sum = sums_[{std::lround(site.eta / drive_.pitch() + 0.5),
                    std::lround(site.xi / drive_.stride() + CrackDrive::first_phase)}];
  sum.values += values;
  ++sum.n;
  if (std::hypot(site.xi, site.eta) <= near_tip * drive_.spacing)
    near_ += values.dissipation;
}

std::vector<TipField::Point> TipField::points() const
{
  std::vector<Point> list;
  for (const auto &[at, sum] : sums_)
    list.push_back({(static_cast<double>(at.second) - CrackDrive::first_phase) * drive_.stride(),
                    (static_cast<double>(at.first) - 0.5) * drive_.pitch(), sum.values * (1. / sum.n)});
  return list;
}

TipValues TipField::at(double xi, double eta) const
{
  const double x = xi / drive_.stride() + CrackDrive::first_phase, y = eta / drive_.pitch() + 0.5;
  const auto i = static_cast<long>(std::floor(x)), j = static_cast<long>(std::floor(y));
  TipValues mean;
  for (int di = 0; di < 2; ++di)
    for (int dj = 0; dj < 2; ++dj)
    {
      const double weight = (di == 0 ? static_cast<double>(i + 1) - x : x - static_cast<double>(i)) *
                            (dj == 0 ? static_cast<double>(j + 1) - y : y - static_cast<double>(j));
      const bool is_below = j + dj <= 0; // the lower half is the mirror image
      const auto sum = sums_.find({is_below ? 1 - (j + dj) : j + dj, i + di});
      TipValues values = sum != sums_.end() ? sum->second.values * (1. / sum->second.n)
                                            : TipValues() * std::numeric_limits<double>::quiet_NaN();
      if (is_below)
      {
        values.velocity.y() *= -1.;
        values.excess.y() *= -1.;
      }
      if (weight > 0.)
        mean += values * weight;
    }
  return mean;
}

analysis::NegativeZone negative_zone(const TipField &field, double limit, double reach)
{
  std::vector<analysis::PointVelocity> points;
  for (const TipField::Point &point : field.points())
    if (point.radius() <= reach)
      points.push_back({{point.xi, point.eta}, point.values.velocity.x()});
  return analysis::negative_zone(points, field.pitch(), limit);
}

analysis::OpeningStress opening_stress(const TipField &field, double radius)
{
  const auto stress = [&](double angle) -> std::optional<double>
  {
    const double value = field.at(radius * std::cos(angle), radius * std::sin(angle)).opening_stress;
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return analysis::opening_stress(stress).value_or(analysis::OpeningStress{none, none, none});
}

TipRun drive_lattice_crack(const CrackDrive &drive, const lattice::Material &material, const Eigen::Matrix2d &F,
                           double reach, const std::optional<CrackFrame> &frame)
{
  const lattice::TriangularLattice sheet(drive.spacing, drive.length, drive.height, drive.orientation);
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::held);
  const std::vector<Crossing> schedule = crossings(drive, sheet, state);
  const lattice::TimeStepping stepping = time_stepping(drive, sheet, material);
  lattice::Simulation simulation(sheet, material, std::move(state), stepping,
                                 lattice::Fracture(sheet, material, lattice::unbreakable, lattice::Toughening(), F));

  TipRun run{TipField(drive), {}};
  auto next = schedule.begin();
  lattice::EnergyBalance middle{};
  const auto steps = static_cast<unsigned int>(std::lround(drive.stride_time() / stepping.step));
  const unsigned int n_half = drive.n_strides / 2;
  for (unsigned int stride = 1; stride <= drive.n_strides; ++stride)
  {
    if (stride == n_half + 1)
      middle = simulation.energies();
    for (unsigned int k = 0; k < steps; ++k)
    {
      // Each bond at the end of the step that is nearest to its time.
      const double X_tip = drive.tip(stride - 1) + (k + 0.5) / steps * drive.stride();
      std::vector<std::pair<std::size_t, std::size_t>> bonds;
      for (; next != schedule.end() && next->X < X_tip; ++next)
        bonds.push_back(next->bond);
      if (!bonds.empty())
        simulation.cut_bonds(bonds);
      simulation.step();
    }
    if (stride + CrackDrive::n_samples <= drive.n_strides)
      continue;
    const lattice::State &now = simulation.state();
    for (const TipSite &site : tip_sites(drive, sheet, drive.tip(stride), reach))
    {
      const Eigen::Vector2d X = sheet.reference(site.place);
      const double sign = site.is_above ? 1. : -1.; // the lower half is the mirror image
      TipValues values;
      values.velocity = {now.velocity.x[site.place], sign * now.velocity.y[site.place]};
      values.excess = now.position.at(site.place) - F * X;
      values.excess.y() *= sign;
      values.opening_stress = site_values(now, sheet, material, site.place).first_piola_stress(1, 1);
      values.dissipation = dissipation(now, sheet, material, site.place);
      run.field.add(site, values);
    }
  }
  if (frame)
  {
    output::FieldWriter writer(sheet, material, frame->folder, frame->name);
    writer.add_frame(simulation.state());
  }
  const lattice::EnergyBalance end = simulation.energies();
  const double advance = (drive.n_strides - n_half) * drive.stride();
  run.energy = {(middle.elastic + middle.kinetic - end.elastic - end.kinetic) / advance,
                (end.viscous - middle.viscous) / advance, (end.broken - middle.broken) / advance,
                run.field.near_power() / drive.speed};
  return run;
}

} // namespace latcon::claims
