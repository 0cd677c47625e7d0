#include "verification/compare/site_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace latcon::compare
{
namespace
{

// Lagrange polynomials on p + 1 equidistant nodes of [0, 1], and their derivatives.
struct Basis
{
  std::array<double, 32> value, slope;
};

void evaluate_basis(unsigned int p, double x, Basis &basis)
{
  const double s = x * p; // nodes at 0, 1 ... p
  for (unsigned int k = 0; k <= p; ++k)
  {
    double value = 1.;
    double slope = 0.;
    for (unsigned int m = 0; m <= p; ++m)
      if (m != k)
      {
        const double factor = 1. / (static_cast<double>(k) - static_cast<double>(m));
        slope = (slope * (s - m) + value) * factor;
        value *= (s - m) * factor;
      }
    basis.value[k] = value;
    basis.slope[k] = slope * p;
  }
}

// Returns the distance of a coordinate outside [0, 1].
double beyond(double x)
{
  return x < 0. ? x : std::max(0., x - 1.);
}

} // namespace

SiteProbe::SiteProbe(const ContinuumFrame &frame, double tolerance) : frame_(frame), tolerance_(tolerance)
{
  for (const FieldValues &field : frame.fields)
    n_values_ += field.field->components;

  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Box empty{{{infinity, infinity}}, {{-infinity, -infinity}}};
  whole_ = empty;
  for (const Cell &cell : frame.cells)
  {
    Box box = empty;
    const std::size_t n = (cell.degree + 1) * (cell.degree + 1);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t k = 0; k < 2; ++k)
      {
        const double x = frame.points[frame.nodes[cell.first_node + a]][k];
        box.low[k] = std::min(box.low[k], x);
        box.high[k] = std::max(box.high[k], x);
      }
    // A curved side may extend beyond the box of its nodes, by much less than the length of the cell.
    const double margin = 0.1 * std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]) + tolerance;
    for (std::size_t k = 0; k < 2; ++k)
    {
      box.low[k] -= margin;
      box.high[k] += margin;
      whole_.low[k] = std::min(whole_.low[k], box.low[k]);
      whole_.high[k] = std::max(whole_.high[k], box.high[k]);
    }
    boxes_.push_back(box);
  }

  // About as many bins as cells, nearly square.
  const double width = whole_.high[0] - whole_.low[0];
  const double height = whole_.high[1] - whole_.low[1];
  const double per_length = std::sqrt(static_cast<double>(boxes_.size()) / (width * height));
  n_bins_ = {{static_cast<std::size_t>(std::ceil(width * per_length)),
              static_cast<std::size_t>(std::ceil(height * per_length))}};
  bins_.resize(n_bins_[0] * n_bins_[1]);
  for (std::size_t cell = 0; cell < boxes_.size(); ++cell)
    for (std::size_t j = bin(1, boxes_[cell].low[1]); j <= bin(1, boxes_[cell].high[1]); ++j)
      for (std::size_t i = bin(0, boxes_[cell].low[0]); i <= bin(0, boxes_[cell].high[0]); ++i)
        bins_[j * n_bins_[0] + i].push_back(cell);
}

std::size_t SiteProbe::bin(std::size_t axis, double coordinate) const
{
  const double share = (coordinate - whole_.low[axis]) / (whole_.high[axis] - whole_.low[axis]);
  const double index = std::floor(share * static_cast<double>(n_bins_[axis]));
  return static_cast<std::size_t>(std::clamp(index, 0., static_cast<double>(n_bins_[axis] - 1)));
}

bool SiteProbe::find_in_cell(const Cell &cell, const Position &point, Position &unit) const
{
  const unsigned int n = cell.degree + 1;
  unit = {{0.5, 0.5}};
  Basis first, second;
  for (unsigned int iteration = 0; iteration < 30; ++iteration)
  {
    evaluate_basis(cell.degree, unit[0], first);
    evaluate_basis(cell.degree, unit[1], second);
    Position x{};
    std::array<Position, 2> d{}; // d[l][k] = dx_k / dunit_l
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const Position &node = frame_.points[frame_.nodes[cell.first_node + j * n + i]];
        for (std::size_t k = 0; k < 2; ++k)
        {
          x[k] += first.value[i] * second.value[j] * node[k];
          d[0][k] += first.slope[i] * second.value[j] * node[k];
          d[1][k] += first.value[i] * second.slope[j] * node[k];
        }
      }
    const double determinant = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    const Position r{{point[0] - x[0], point[1] - x[1]}};
    const Position step{
      {(d[1][1] * r[0] - d[1][0] * r[1]) / determinant, (d[0][0] * r[1] - d[0][1] * r[0]) / determinant}};
    // Far outside the cell the polynomials are meaningless. NaN also ends the iteration here.
    if (!(std::abs(unit[0] - 0.5) < 2. && std::abs(unit[1] - 0.5) < 2. && std::isfinite(step[0] + step[1])))
      return false;
    unit[0] += step[0];
    unit[1] += step[1];
    // The convergence is quadratic: after a step this small the error is round-off.
    if (std::abs(step[0]) + std::abs(step[1]) < 1e-9)
    {
      const Position over{{beyond(unit[0]), beyond(unit[1])}};
      return std::hypot(d[0][0] * over[0] + d[1][0] * over[1], d[0][1] * over[0] + d[1][1] * over[1]) <= tolerance_;
    }
  }
  return false;
}

bool SiteProbe::evaluate(const Position &point, double *values) const
{
  for (std::size_t k = 0; k < 2; ++k)
    if (point[k] < whole_.low[k] || point[k] > whole_.high[k])
      return false;
  std::size_t n_found = 0;
  std::vector<double> sum(n_values_, 0.);
  Basis first, second;
  for (const std::size_t id : bins_[bin(1, point[1]) * n_bins_[0] + bin(0, point[0])])
  {
    const Box &box = boxes_[id];
    const Cell &cell = frame_.cells[id];
    Position unit;
    if (point[0] < box.low[0] || point[0] > box.high[0] || point[1] < box.low[1] || point[1] > box.high[1] ||
        !find_in_cell(cell, point, unit))
      continue;
    ++n_found;
    evaluate_basis(cell.degree, unit[0], first);
    evaluate_basis(cell.degree, unit[1], second);
    const unsigned int n = cell.degree + 1;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const double shape = first.value[i] * second.value[j];
        const std::size_t node = frame_.nodes[cell.first_node + j * n + i];
        double *at = sum.data();
        for (const FieldValues &field : frame_.fields)
          for (std::size_t c = 0; c < field.field->components; ++c)
            *at++ += shape * field.at(node)[c];
      }
  }
  if (n_found == 0)
    return false;
  for (std::size_t i = 0; i < n_values_; ++i)
    values[i] = sum[i] / static_cast<double>(n_found);
  return true;
}

SiteValues probe(const ContinuumFrame &frame, const std::vector<Position> &points, double tolerance,
                 MPI_Comm communicator)
{
  int rank = 0;
  int n_ranks = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  const SiteProbe site_probe(frame, tolerance);
  const std::size_t n_values = site_probe.n_values();
  const auto first_point = [&](int r)
  { return points.size() * static_cast<std::size_t>(r) / static_cast<std::size_t>(n_ranks); };

  std::vector<double> mine((first_point(rank + 1) - first_point(rank)) * n_values,
                           std::numeric_limits<double>::quiet_NaN());
  std::vector<std::uint8_t> mine_outside(first_point(rank + 1) - first_point(rank));
  for (std::size_t i = 0; i < mine_outside.size(); ++i)
    mine_outside[i] = site_probe.evaluate(points[first_point(rank) + i], mine.data() + i * n_values) ? 0 : 1;

  // Counts of sites, because counts of values may exceed the range of int.
  std::vector<int> counts, offsets;
  for (int r = 0; r < n_ranks; ++r)
  {
    counts.push_back(static_cast<int>(first_point(r + 1) - first_point(r)));
    offsets.push_back(static_cast<int>(first_point(r)));
  }
  MPI_Datatype values_of_site;
  MPI_Type_contiguous(static_cast<int>(n_values), MPI_DOUBLE, &values_of_site);
  MPI_Type_commit(&values_of_site);
  std::vector<double> all(points.size() * n_values);
  SiteValues found;
  found.outside.resize(points.size());
  MPI_Allgatherv(mine.data(), counts[static_cast<std::size_t>(rank)], values_of_site, all.data(), counts.data(),
                 offsets.data(), values_of_site, communicator);
  MPI_Allgatherv(mine_outside.data(), counts[static_cast<std::size_t>(rank)], MPI_UINT8_T, found.outside.data(),
                 counts.data(), offsets.data(), MPI_UINT8_T, communicator);
  MPI_Type_free(&values_of_site);

  std::size_t offset = 0;
  for (const FieldValues &field : frame.fields)
  {
    const std::size_t n = field.field->components;
    FieldValues at_points{field.field, std::vector<double>(points.size() * n)};
    for (std::size_t i = 0; i < points.size(); ++i)
      std::copy_n(all.data() + i * n_values + offset, n, at_points.values.data() + i * n);
    offset += n;
    found.fields.push_back(std::move(at_points));
  }
  return found;
}

} // namespace latcon::compare
