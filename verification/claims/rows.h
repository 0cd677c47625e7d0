/// Rows and tables of a claim.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "support/largest_error.h"
#include "verification/output/csv.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Results of a claim: a row per checked quantity, and tables for plots.
struct ClaimOutcome
{
  output::Results results;
  std::map<std::string, output::Table> tables; ///< by file name without ".csv"

  /// Returns the table of that name; creates it with these columns if it is missing.
  output::Table &table(const std::string &name, const std::vector<std::string> &columns)
  {
    return tables.try_emplace(name, columns).first->second;
  }

  /// Appends the results of another claim, or of the same claim for another subject.
  void add(const ClaimOutcome &other)
  {
    results.add(other.results);
    for (const auto &[name, rows] : other.tables)
      table(name, rows.columns()).add(rows);
  }
};

/// Number that could not be computed; it makes a row fail.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Numbers that a row compares; empty where a side does not apply.
struct Sides
{
  std::optional<double> lattice = {}, continuum = {}, theory = {};
};

/// Returns the sides of a row that compares both.
inline Sides of_both(double lattice, double continuum, std::optional<double> theory = {})
{
  return {lattice, continuum, theory};
}
/// Returns the sides of a row about the lattice alone.
inline Sides of_lattice(double value, std::optional<double> theory = {})
{
  return {value, {}, theory};
}
/// Returns the sides of a row about the continuum alone.
inline Sides of_continuum(double value, std::optional<double> theory = {})
{
  return {{}, value, theory};
}
/// Returns the sides of the lattice's largest error, whose reference is in theory.
inline Sides of_lattice(const support::LargestError &error)
{
  return {error.value(), {}, error.reference()};
}
/// Returns the sides of the continuum's largest error, whose reference is in theory.
inline Sides of_continuum(const support::LargestError &error)
{
  return {{}, error.value(), error.reference()};
}

/// Writes the rows of a claim about one subject or state, whose name precedes their quantities.
class Rows
{
public:
  /// @param claim its name @param where "NN, F = I: "
  Rows(output::Results &results, std::string claim, std::string where)
    : results_(results), claim_(std::move(claim)), where_(std::move(where))
  {
  }

  /// Returns a writer with more words before quantities.
  [[nodiscard]] Rows about(const std::string &more) const { return {results_, claim_, where_ + more}; }

  /// Adds a row.
  /// @param tolerance with its reason; none: the row is reported
  /// @param is_judged false: the row is reported, with or without a tolerance
  void add(const std::string &quantity, const std::string &unit, const Sides &sides, std::optional<double> error = {},
           output::Tolerance tolerance = {}, bool is_judged = true) const
  {
    if (!is_judged)
      tolerance.reset();
    results_.add({claim_, where_ + quantity, unit, sides.lattice, sides.continuum, sides.theory, error, tolerance});
  }
  void add(const std::string &quantity, const std::string &unit, const Sides &sides,
           const support::LargestError &largest, const output::Tolerance &tolerance = {}, bool is_judged = true) const
  {
    add(quantity, unit, sides, largest.error(), tolerance, is_judged);
  }

  /// Adds a row that fails.
  void add_not_computed(const std::string &quantity, const std::string &reason) const
  {
    results_.add(output::not_computed(claim_, where_ + quantity, reason));
  }

  /// See Results::attempt().
  bool attempt(const std::string &part, const std::function<void()> &compute) const
  {
    return results_.attempt(claim_, where_ + part, compute);
  }

private:
  output::Results &results_;
  std::string claim_, where_;
};

} // namespace latcon::claims
