/// Two cracks compared: quantities, entries of their cases, paths.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace latcon::commands
{

/// One quantity of both runs, in SI units. A value is missing where it was not measured.
struct QuantityPair
{
  std::string name, unit;
  std::optional<double> first, first_uncertainty; ///< uncertainties: one standard deviation
  std::optional<double> second, second_uncertainty;

  /// Second minus first.
  [[nodiscard]] std::optional<double> difference() const;
  /// difference() over the root of the sum of both squared uncertainties [-]; none unless both are known and one of
  /// them is positive.
  [[nodiscard]] std::optional<double> normalized_difference() const;
};

/// Entry of a case in which the runs differ.
struct EntryPair
{
  std::string key, unit, first, second;
};

/// Distance between two paths Y(X) in the undeformed sheet, over the X that both cover.
struct PathDistance
{
  double X_begin, X_end; ///< [m]
  double rms;            ///< root mean square of the difference of Y [m]
  double largest;        ///< largest |difference of Y| [m]
  double largest_X;      ///< where it is [m]
};

/// Point of a path [m].
struct PathPoint
{
  double X, Y;
};

/// Distance between paths whose X does not decrease; points between those given are interpolated linearly. None if they
/// have no stretch of X in common.
[[nodiscard]] std::optional<PathDistance> path_distance(const std::vector<PathPoint> &first,
                                                        const std::vector<PathPoint> &second);

/// Two output directories of `latcon fracture`.
struct RunComparison
{
  std::string first, second;                                   ///< the directories
  std::string first_side = "lattice", second_side = "lattice"; ///< which broke, lattice or continuum
  std::string first_problem, second_problem; ///< rows that failed and make a run unfit as a measurement; else empty
  std::string first_pattern, second_pattern;
  std::vector<QuantityPair> quantities; ///< those that at least one run has
  std::vector<EntryPair> entries;
  std::optional<PathDistance> paths;
  double spacing = 0.; ///< lattice spacing d of the first run [m]

  [[nodiscard]] std::string text() const; ///< tables for a terminal
  /// All of it, full precision. @param output_directory from which `first_folder` and `second_folder` lead to the runs
  [[nodiscard]] std::string json(const std::string &output_directory) const;
  [[nodiscard]] std::string csv() const; ///< the quantities, full precision
};

/// Returns whether a directory holds a measured crack: the file crack.json.
[[nodiscard]] bool holds_crack(const std::string &directory);

/// Reads and compares two runs. @throws InputError for files that are missing or damaged
[[nodiscard]] RunComparison compare_runs(const std::string &first, const std::string &second);

} // namespace latcon::commands
