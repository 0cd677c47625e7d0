#pragma once

#include <map>
#include <string>

#include "verification/output/csv.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// What a claim found: a row for each thing checked, and the numbers behind them for plots and readers.
struct ClaimOutcome
{
  output::Results results;
  std::map<std::string, output::Table> tables; ///< by file name without ".csv"

  /// The table of that name, made with these columns if it is not there yet.
  output::Table &table(const std::string &name, const std::vector<std::string> &columns)
  {
    return tables.try_emplace(name, columns).first->second;
  }

  /// Appends what another claim, or the same claim about another subject, found.
  void add(const ClaimOutcome &other)
  {
    results.add(other.results);
    for (const auto &[name, rows] : other.tables)
      table(name, rows.columns()).add(rows);
  }

  /// Writes NAME.csv for each table into `folder`, which must exist. @throws OutputError
  void write_tables(const std::string &folder) const;
};

} // namespace latcon::claims
