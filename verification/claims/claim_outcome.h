#pragma once

#include <map>
#include <string>

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

} // namespace latcon::claims
