#include "verification/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>

#include "support/errors.h"
#include "support/full_precision.h"
#include "support/largest_error.h"

namespace latcon::compare
{
namespace
{

// Formats a number with few digits for messages.
std::string short_number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

struct Bounds
{
  Position low, high;
  double side(std::size_t k) const { return high[k] - low[k]; }
  std::string text() const
  {
    return short_number(low[0]) + " to " + short_number(high[0]) + " m by " + short_number(low[1]) + " to " +
           short_number(high[1]) + " m";
  }
};

Bounds bounds(const std::vector<Position> &points)
{
  std::array<support::Extremes, 2> extremes;
  for (const Position &point : points)
    for (std::size_t k = 0; k < 2; ++k)
      extremes[k].add(point[k]);
  return {{{extremes[0].smallest(), extremes[1].smallest()}}, {{extremes[0].largest(), extremes[1].largest()}}};
}

std::string both_files(const Frame &lattice, const Frame &continuum)
{
  return lattice.file.path.string() + " and " + continuum.file.path.string();
}

std::string series_text(const Frame &frame, const char *side)
{
  return frame.file.times.size() > 1 ? std::string("\ntimes of the ") + side + ": " + list_of_times(frame.file.times)
                                     : "";
}

// Returns true if a ratio is that of a unit with a prefix to the unit itself, to 5 %.
bool is_ratio_of_units(double ratio)
{
  for (const double units : {1e2, 1e3, 1e6, 1e9})
    for (const double r : {ratio, 1. / ratio})
      if (std::abs(r / units - 1.) < 0.05)
        return true;
  return false;
}

// Returns a component of a field for the norms: F minus identity for the deformation gradient.
double component(const FieldValues &field, std::size_t point, std::size_t c)
{
  const bool diagonal = c == 0 || c == 3;
  return field.at(point)[c] - (diagonal && std::string(field.field->name) == "deformation_gradient" ? 1. : 0.);
}

struct Norms
{
  double largest, root_mean_square; // NaN if a value is not finite
};

template <typename Value>
Norms norms_of(const std::vector<std::size_t> &sites, std::size_t n_components, const Value &value)
{
  support::Extremes sizes;
  sizes.add(0.);
  double sum = 0.;
  for (const std::size_t site : sites)
  {
    double square = 0.;
    for (std::size_t c = 0; c < n_components; ++c)
      square += value(site, c) * value(site, c);
    sizes.add(std::sqrt(square));
    sum += square;
  }
  return {sizes.largest(), sites.empty() ? 0. : std::sqrt(sum / static_cast<double>(sites.size()))};
}

double relative(double difference, double lattice, double continuum)
{
  return difference == 0. ? 0. : difference / support::largest_of({lattice, continuum});
}

// A site at the rim of a curved hole may be outside because of rounding, but then some of its neighbours are inside.
void require_no_missing_part(const LatticeFrame &lattice, const ContinuumFrame &continuum, const SiteValues &at_sites)
{
  std::vector<std::uint8_t> has_neighbour_inside(lattice.points.size(), 0);
  for (const auto &[a, b] : lattice.bonds)
  {
    has_neighbour_inside[a] |= at_sites.outside[b] == 0 ? 1 : 0;
    has_neighbour_inside[b] |= at_sites.outside[a] == 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < lattice.points.size(); ++i)
    if (at_sites.outside[i] != 0 && has_neighbour_inside[i] == 0 && lattice.n_bonds[i] > 0)
      throw support::InputError(
        both_files(lattice, continuum) + ": not the same sheet: the continuum has no cell at the site (" +
        short_number(lattice.points[i][0]) + ", " + short_number(lattice.points[i][1]) + ") m, nor at its neighbours");

  vtkNew<vtkPolyData> sites;
  sites->SetPoints(lattice.data->GetPoints());
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(sites);
  locator->BuildLocator();
  // In a complete lattice every point of the sheet is within one spacing of a site.
  const double far = 2. * lattice.spacing;
  for (const Position &point : continuum.points)
  {
    const std::array<double, 3> x{{point[0], point[1], 0.}};
    double squared = 0.;
    if (locator->FindClosestPointWithinRadius(far, x.data(), squared) < 0)
      throw support::InputError(
        both_files(lattice, continuum) + ": not the same sheet: the lattice has no site within " + short_number(far) +
        " m of the continuum's node (" + short_number(point[0]) + ", " + short_number(point[1]) + ") m");
  }
}

// Row that both sheets have the same load, if a held site is on an edge of both: largest difference of displacements
// that the edges prescribe.
void add_load_row(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Comparison &comparison,
                  output::Results &results)
{
  const Bounds box = bounds(continuum.points);
  const double near = position_tolerance(continuum);
  std::vector<std::size_t> sites;
  for (std::size_t i = 0; i < lattice.points.size(); ++i)
  {
    const Position &X = lattice.points[i];
    const bool is_on_edge = std::abs(X[0] - box.low[0]) <= near || std::abs(X[0] - box.high[0]) <= near ||
                            std::abs(X[1] - box.low[1]) <= near || std::abs(X[1] - box.high[1]) <= near;
    if (is_on_edge && lattice.held[i] != 0 && comparison.continuum.outside[i] == 0 && comparison.excluded[i] == 0)
      sites.push_back(i);
  }
  if (sites.empty())
    return;
  // The displacement is the first of the fields.
  const auto largest = [&](const FieldValues &values)
  { return norms_of(sites, 2, [&](std::size_t site, std::size_t c) { return values.at(site)[c]; }).largest; };
  const double here = largest(*lattice.find("displacement")), there = largest(comparison.continuum.fields.front());
  results.add({"compare",
               "load: displacement of held sites on the edges, largest difference",
               "m",
               here,
               there,
               {},
               relative(largest(comparison.differences.front()), here, there),
               {1e-4, "positions in files: 1e-6 of the longer side, at most a hundred times the shorter"}});
}

void require_same_units(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Comparison &comparison)
{
  for (std::size_t f = 0; f < comparison.continuum.fields.size(); ++f)
  {
    const FieldValues &there = comparison.continuum.fields[f];
    const FieldValues &here = *lattice.find(there.field->name);
    double product = 0.;
    double squares_here = 0.;
    double squares_there = 0.;
    for (const std::size_t i : comparison.compared(lattice, *there.field))
      for (std::size_t c = 0; c < there.field->components; ++c)
      {
        product += here.at(i)[c] * there.at(i)[c];
        squares_here += here.at(i)[c] * here.at(i)[c];
        squares_there += there.at(i)[c] * there.at(i)[c];
      }
    // Proportional fields, with a ratio that indicates another unit.
    const bool alike = product > 0.95 * std::sqrt(squares_here * squares_there);
    const double ratio = std::sqrt(squares_there / squares_here);
    if (alike && squares_here > 0. && is_ratio_of_units(ratio))
      throw support::InputError(both_files(lattice, continuum) + ": '" + there.field->name + "' of the continuum is " +
                                short_number(ratio) + " times that of the lattice: different units? Both must be in " +
                                there.field->unit);
  }
}

} // namespace

double position_tolerance(const ContinuumFrame &frame)
{
  const Bounds box = bounds(frame.points);
  return 1e-6 * support::largest_of({box.side(0), box.side(1)});
}

void require_same_time(const LatticeFrame &lattice, const ContinuumFrame &continuum)
{
  if (lattice.file.chosen && continuum.file.chosen)
    return;
  const std::string advice = series_text(lattice, "lattice") + series_text(continuum, "continuum") +
                             "\nto compare these frames anyway, give both --lattice-time and --continuum-time";
  if ((lattice.kind == TimeKind::motion && continuum.kind == TimeKind::equilibrium) ||
      (lattice.kind == TimeKind::equilibrium && continuum.kind == TimeKind::motion))
  {
    const bool lattice_moves = lattice.kind == TimeKind::motion;
    throw support::InputError(both_files(lattice, continuum) + ": the " + (lattice_moves ? "lattice" : "continuum") +
                              " is in motion and the " + (lattice_moves ? "continuum" : "lattice") + " in equilibrium" +
                              advice);
  }
  if (!is_same_time(lattice.time, continuum.time))
    throw support::InputError(both_files(lattice, continuum) +
                              ": the times differ: " + support::full_precision(lattice.time) + " of the lattice, " +
                              support::full_precision(continuum.time) + " of the continuum" + advice);
}

void require_same_bounds(const LatticeFrame &lattice, const ContinuumFrame &continuum)
{
  Bounds here = bounds(lattice.points);
  if (const auto &given = lattice.sheet_bounds)
    here = {{{(*given)[0], (*given)[2]}}, {{(*given)[1], (*given)[3]}}};
  const Bounds there = bounds(continuum.points);
  const double tolerance = position_tolerance(continuum);
  support::LargestError distance;
  for (std::size_t k = 0; k < 2; ++k)
  {
    distance.add_difference(here.low[k], there.low[k]);
    distance.add_difference(here.high[k], there.high[k]);
  }
  if (distance.error() <= tolerance)
    return;
  std::string why;
  const Position ratio{{there.side(0) / here.side(0), there.side(1) / here.side(1)}};
  if (is_ratio_of_units(ratio[0]) && std::abs(ratio[1] / ratio[0] - 1.) < 0.05)
    why = ": " + short_number(ratio[0]) + " times as large in both directions, so one of them is not in metres";
  else if (std::abs(there.side(0) - here.side(1)) <= tolerance && std::abs(there.side(1) - here.side(0)) <= tolerance)
    why = ": x and y are exchanged";
  throw support::InputError(both_files(lattice, continuum) + ": not the same sheet: the lattice spans " + here.text() +
                            ", the continuum " + there.text() + why);
}

std::vector<std::size_t> Comparison::compared(const LatticeFrame &lattice, const CommonField &field) const
{
  std::vector<std::size_t> sites;
  for (std::size_t i = 0; i < lattice.points.size(); ++i)
    if (continuum.outside[i] == 0 && excluded[i] == 0 && lattice.held[i] == 0 &&
        (!field.from_bonds || complete[i] != 0))
      sites.push_back(i);
  return sites;
}

Comparison compare(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Scope &scope,
                   MPI_Comm communicator)
{
  Comparison comparison;
  comparison.continuum = probe(continuum, lattice.points, position_tolerance(continuum), communicator);
  if (!scope.is_overlap)
    require_no_missing_part(lattice, continuum, comparison.continuum);
  for (const Position &point : lattice.points)
    comparison.excluded.push_back(
      std::any_of(scope.excluded.begin(), scope.excluded.end(),
                  [&](const Circle &circle)
                  { return std::hypot(point[0] - circle.centre[0], point[1] - circle.centre[1]) <= circle.radius; })
        ? 1
        : 0);
  unsigned int most = 0;
  for (const unsigned int n : lattice.n_bonds)
    most = std::max<unsigned int>(most, n);
  for (const unsigned int n : lattice.n_bonds)
    comparison.complete.push_back(n == most ? 1 : 0);
  for (const FieldValues &there : comparison.continuum.fields)
  {
    const FieldValues &here = *lattice.find(there.field->name);
    FieldValues difference{there.field, here.values};
    for (std::size_t i = 0; i < difference.values.size(); ++i)
      difference.values[i] -= there.values[i];
    comparison.differences.push_back(std::move(difference));
    if (comparison.compared(lattice, *there.field).empty())
      throw support::InputError(
        both_files(lattice, continuum) + ": '" + there.field->name +
        "' cannot be compared: no free site inside the continuum and outside the excluded circles has all "
        "its bonds");
  }
  require_same_units(lattice, continuum, comparison);
  return comparison;
}

output::Results norms(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Comparison &comparison,
                      const std::map<std::string, double> &tolerances)
{
  for (const auto &[name, tolerance] : tolerances)
    if (continuum.find(name) == nullptr)
      throw support::InputError("--tolerance: '" + name + "' is not in " + continuum.file.path.string());

  output::Results results;
  const auto count = [&results](const std::string &what, std::size_t n) {
    results.add({"compare", what, "1", static_cast<double>(n), {}, {}, {}, {}});
  };
  const std::vector<std::uint8_t> &outside = comparison.continuum.outside;
  count("sites", lattice.points.size());
  count("sites outside the finite element sheet",
        static_cast<std::size_t>(std::count(outside.begin(), outside.end(), std::uint8_t(1))));
  const std::vector<std::uint8_t> &excluded = comparison.excluded;
  count("sites in excluded circles",
        static_cast<std::size_t>(std::count(excluded.begin(), excluded.end(), std::uint8_t(1))));
  count("free sites inside", comparison.compared(lattice, common_fields.front()).size());
  count("free sites inside with all their bonds", comparison.compared(lattice, common_fields.back()).size());
  const bool motion = lattice.kind == TimeKind::motion || continuum.kind == TimeKind::motion;
  results.add(
    {"compare", motion ? "time" : "load factor", motion ? "s" : "1", lattice.time, continuum.time, {}, {}, {}});

  add_load_row(lattice, continuum, comparison, results);
  for (std::size_t f = 0; f < comparison.differences.size(); ++f)
  {
    const CommonField &field = *comparison.differences[f].field;
    const std::vector<std::size_t> sites = comparison.compared(lattice, field);
    const FieldValues &here = *lattice.find(field.name);
    const auto measure = [&](const FieldValues &values)
    {
      return norms_of(sites, field.components,
                      [&](std::size_t site, std::size_t c) { return component(values, site, c); });
    };
    const Norms on_lattice = measure(here);
    const Norms on_continuum = measure(comparison.continuum.fields[f]);
    const Norms difference = norms_of(
      sites, field.components, [&](std::size_t site, std::size_t c) { return comparison.differences[f].at(site)[c]; });
    const std::string name =
      std::string(field.name) + (std::string(field.name) == "deformation_gradient" ? " less identity" : "");
    results.add({"compare",
                 name + ", largest difference",
                 field.unit,
                 on_lattice.largest,
                 on_continuum.largest,
                 {},
                 relative(difference.largest, on_lattice.largest, on_continuum.largest),
                 {}});
    std::optional<double> tolerance;
    if (const auto found = tolerances.find(field.name); found != tolerances.end())
      tolerance = found->second;
    results.add({"compare",
                 name + ", rms difference",
                 field.unit,
                 on_lattice.root_mean_square,
                 on_continuum.root_mean_square,
                 {},
                 relative(difference.root_mean_square, on_lattice.root_mean_square, on_continuum.root_mean_square),
                 tolerance});
  }
  return results;
}

} // namespace latcon::compare
