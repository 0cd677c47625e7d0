#include "verification/claims/running_crack/tip_field.h"

#include <limits>

#include "support/largest_error.h"

namespace latcon::claims
{

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
  std::vector<TipSite> sites;
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      const Eigen::Vector2d X = sheet.reference(place);
      const double xi = X.x() - X_tip, eta = X.y() - drive.axis();
      if (std::hypot(xi, eta) <= reach)
        sites.push_back({place, X.x(), xi, std::abs(eta), eta > 0.});
    }
  return sites;
}

void TipField::add(const TipSite &site, const TipValues &values)
{
  Sum &sum = sums_[{std::lround(site.eta / drive_.pitch() + 0.5),
                    std::lround(site.xi / drive_.stride() + CrackDrive::first_phase)}];
  sum.values += values;
  ++sum.n;
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

BackwardZone backward_zone(const TipField &field, double limit, double reach)
{
  BackwardZone zone{0., 0.};
  for (const TipField::Point &point : field.points())
  {
    const double v = point.values.velocity.x();
    if (!std::isfinite(v))
      return {v, v};
    if (point.xi < 0. || point.radius() > reach)
      continue;
    zone.depth = support::smallest_of({zone.depth, v});
    if (v < -limit)
      zone.area += 2. * field.point_area();
  }
  return zone;
}

StressLobes stress_lobes(const TipField &field, double radius)
{
  const auto stress = [&](double degrees) {
    return field.at(radius * std::cos(degrees * M_PI / 180.), radius * std::sin(degrees * M_PI / 180.)).opening_stress;
  };
  StressLobes lobes{0., 1., stress(0.)};
  double largest = lobes.ahead;
  for (double degrees = 2.; degrees <= 120.; degrees += 2.)
    if (const double value = stress(degrees); !(value <= largest))
    {
      largest = value;
      lobes.angle = degrees;
    }
  lobes.ratio = largest / lobes.ahead;
  return lobes;
}

} // namespace latcon::claims
