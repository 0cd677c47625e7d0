#include "verification/analysis/damage_contour.h"

#include <algorithm>
#include <cmath>

namespace latcon::analysis
{
namespace
{

// Y between two nodes at which the damage has the level.
double crossing(const DamageImage &image, const std::size_t i, const std::size_t below, const std::size_t above)
{
  const double d_below = image.at(i, below), d_above = image.at(i, above);
  const double part = (contour_level - d_below) / (d_above - d_below);
  return image.bottom + image.size_y * (static_cast<double>(below) + part);
}

struct Strand
{
  double lower, upper;    // [m]
  std::size_t begin, end; // rows of nodes
};

std::vector<Strand> strands(const DamageImage &image, const std::size_t i)
{
  std::vector<Strand> found;
  for (std::size_t begin = 0, end; begin < image.rows; begin = end)
  {
    end = begin + 1;
    if (!(image.at(i, begin) >= contour_level))
      continue;
    while (end < image.rows && image.at(i, end) >= contour_level)
      ++end;
    const double lower = begin > 0 ? crossing(image, i, begin - 1, begin) : image.bottom;
    const double upper = end < image.rows ? crossing(image, i, end - 1, end)
                                          : image.bottom + image.size_y * static_cast<double>(image.rows - 1);
    found.push_back({lower, upper, begin, end});
  }
  return found;
}

double deviation(const std::vector<double> &values)
{
  double mean = 0., square = 0.;
  for (const double value : values)
    mean += value / static_cast<double>(values.size());
  for (const double value : values)
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  return std::sqrt(square);
}

} // namespace

std::optional<ContourColumn> contour_column(const DamageImage &image, const std::size_t i)
{
  const std::vector<Strand> found = strands(image, i);
  if (found.empty())
    return {};
  ContourColumn column{
    static_cast<double>(i) * image.size_x, found.size(), found.front().lower, found.back().upper, 0., 0.};
  for (std::size_t n = 0; n < found.size(); ++n)
  {
    column.damaged += found[n].upper - found[n].lower;
    if (n > 0)
      column.gap = std::max(column.gap, found[n].lower - found[n - 1].upper);
  }
  return column;
}

std::vector<ContourColumn> contour(const DamageImage &image, const double from)
{
  std::vector<ContourColumn> columns;
  for (auto i = static_cast<std::size_t>(std::max(0., std::ceil(from / image.size_x))); i < image.columns; ++i)
  {
    const std::optional<ContourColumn> column = contour_column(image, i);
    if (!column)
      break;
    columns.push_back(*column);
  }
  return columns;
}

double branched_fraction(const std::vector<ContourColumn> &columns, const double X_begin, const double X_end,
                         const double spacing, const BranchRule &rule)
{
  std::vector<double> gaps;
  for (const ContourColumn &column : columns)
    if (column.X >= X_begin && column.X <= X_end)
      gaps.push_back(column.gap >= rule.gap * spacing ? column.gap : 0.);
  return gaps.size() < 2 ? 0. : share_of_branches(gaps, columns[1].X - columns[0].X, spacing, rule);
}

std::optional<ContourTip> contour_tip(const DamageImage &image, const std::size_t column)
{
  std::vector<Strand> found = strands(image, column);
  if (found.empty())
    return {};
  std::size_t i = column;
  while (i + 1 < image.columns)
  {
    std::vector<Strand> next = strands(image, i + 1);
    if (next.empty())
      break;
    found = std::move(next);
    ++i;
  }
  double most = 0.;
  const Strand *of_tip = nullptr;
  std::size_t row = 0;
  for (const Strand &strand : found)
    for (std::size_t j = strand.begin; j < strand.end; ++j)
      if (of_tip == nullptr || image.at(i, j) > most)
      {
        most = image.at(i, j);
        of_tip = &strand;
        row = j;
      }
  double X = static_cast<double>(i) * image.size_x;
  if (i + 1 < image.columns)
    X += image.size_x * (most - contour_level) / (most - image.at(i + 1, row));
  return ContourTip{i, X, 0.5 * (of_tip->lower + of_tip->upper)};
}

std::optional<ContourMeasurement> measure_contour(const std::vector<ContourColumn> &columns, const double X_begin,
                                                  const double X_end, const double spacing, const double min_wavelength)
{
  std::vector<double> X, centre, lower, upper, width;
  ContourMeasurement measured;
  double widest = 0.;
  for (const ContourColumn &column : columns)
    widest = std::max(widest, column.upper - column.lower);
  for (const ContourColumn &column : columns)
    if (column.X >= X_begin && column.X <= std::min(X_end, columns.back().X - widest))
    {
      X.push_back(column.X);
      centre.push_back(column.centre());
      lower.push_back(column.lower);
      upper.push_back(column.upper);
      width.push_back(column.upper - column.lower);
      measured.mean_width += column.damaged;
      measured.several_strands += column.n_strands > 1 ? 1. : 0.;
    }
  if (X.size() < 2)
    return {};
  const double n = static_cast<double>(X.size()), h = X[1] - X[0];
  measured.mean_width /= n;
  measured.several_strands /= n;
  measured.rms_width = deviation(width);
  measured.rms_centre = deviation(centre);
  // The contour is interpolated between nodes: a hundredth of a cell is the accuracy of a smooth field.
  const auto fit = [&](const std::vector<double> &Y)
  { return fit_sinusoid(ColumnMeans(X, Y, 2. * spacing), min_wavelength * spacing, 0.01 * h); };
  measured.centre = fit(centre);
  measured.lower = fit(lower);
  measured.upper = fit(upper);
  measured.width = fit(width);
  return measured;
}

} // namespace latcon::analysis
