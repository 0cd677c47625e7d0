#include "verification/analysis/crack_branches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace latcon::analysis
{
namespace
{

/// Returns the widest gap between neighbouring strands of one column [m]; 0 if there are fewer than two strands.
double widest_gap(std::vector<double> &Y, double gap, double min_bonds)
{
  std::sort(Y.begin(), Y.end());
  double widest = 0.;
  bool has_previous = false;
  double previous_top = 0.;
  for (std::size_t begin = 0, end; begin < Y.size(); begin = end)
  {
    end = begin + 1;
    while (end < Y.size() && Y[end] - Y[end - 1] < gap)
      ++end;
    if (static_cast<double>(end - begin) < min_bonds)
      continue;
    if (has_previous)
      widest = std::max(widest, Y[begin] - previous_top);
    has_previous = true;
    previous_top = Y[end - 1];
  }
  return widest;
}

// Returns the fraction of columns that branched_fraction() counts. It does not depend on the width of the columns, if
// this resolves the strands. @param gaps of each column, along X: the widest between neighbouring strands [m]; 0: fewer
// than two strands
double share_of_branches(const std::vector<double> &gaps, double column_width, double spacing, const BranchRule &rule)
{
  // A run of columns as long as the persistence may be shorter by rounding.
  const double persistence = rule.persistence * spacing * (1. - 1e-12);
  std::size_t n_branched = 0;
  for (std::size_t begin = 0, end; begin < gaps.size(); begin = end)
  {
    end = begin + 1;
    if (gaps[begin] == 0.)
      continue;
    while (end < gaps.size() && gaps[end] > 0.)
      ++end;
    const double widest = *std::max_element(gaps.begin() + static_cast<std::ptrdiff_t>(begin),
                                            gaps.begin() + static_cast<std::ptrdiff_t>(end));
    if (static_cast<double>(end - begin) * column_width >= persistence && widest >= rule.grown_gap * spacing)
      n_branched += end - begin;
  }
  return gaps.empty() ? 0. : static_cast<double>(n_branched) / static_cast<double>(gaps.size());
}

} // namespace

double branched_fraction(const std::vector<BreakRecord> &breaks, double X_begin, double X_end, double lattice_spacing,
                         const BranchRule &rule)
{
  const double width = rule.column_width * lattice_spacing;
  if (!(X_end - X_begin >= width))
    return 0.;
  if (!(X_end - X_begin < 1e9 * width))
    throw std::invalid_argument("branched_fraction: the interval must contain fewer than 1e9 columns");
  const auto n_columns = static_cast<std::size_t>((X_end - X_begin) / width);
  std::vector<std::vector<double>> columns(n_columns);
  for (const BreakRecord &bond : breaks)
  {
    const double column = std::floor((bond.X - X_begin) / width);
    if (column >= 0. && column < static_cast<double>(n_columns))
      columns[static_cast<std::size_t>(column)].push_back(bond.Y);
  }

  std::vector<double> gaps;
  gaps.reserve(n_columns);
  for (std::vector<double> &column : columns)
    gaps.push_back(widest_gap(column, rule.gap * lattice_spacing, rule.bonds_per_spacing * rule.column_width));
  return share_of_branches(gaps, width, lattice_spacing, rule);
}

} // namespace latcon::analysis
