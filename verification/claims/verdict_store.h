/// Verdicts of earlier checks: a file for each hash of everything that they depend on.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verification/claims/claim.h"
#include "verification/claims/claim_inputs.h"
#include "verification/claims/rows.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// A complete check.
struct Verdicts
{
  output::Results results;
  std::map<std::string, std::string> tables;    ///< CSV texts by file name without ".csv"
  std::map<std::string, std::string> libraries; ///< size and time of the shared libraries of the check, by path
  std::string checked_at;                       ///< UTC, ISO 8601: "2026-11-21T16:20:05Z"

  Verdicts() = default;
  /// Verdicts of claims that were checked just now.
  explicit Verdicts(const ClaimOutcome &outcome);

  /// Writes NAME.csv for each table into `folder`, which must exist. @throws OutputError
  void write_tables(const std::string &folder) const;

  /// Returns why the verdicts do not hold for the libraries of this machine; empty: they do.
  /// @param may_be_updated accept libraries of the same names, which a release of Debian updates for security
  [[nodiscard]] std::string library_problem(bool may_be_updated) const;

  /// Returns why verdicts do not let a crack run, apart from rows that fail: a row of another claim, or a claim that
  /// judged nothing that a crack waits for; empty: none. @param required claims that the crack waits for
  [[nodiscard]] std::string acceptance_problem(const std::vector<Claim> &required) const;
};

/// A stored file that cannot be used; what() says why.
class UnusableVerdicts : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Returns verdicts as JSON: the key, time, program and libraries of the check, the rows as in results.json, the
/// tables.
[[nodiscard]] std::string verdicts_text(const VerdictKey &key, const Verdicts &verdicts);

/// Parses such a text. The verdict of a row follows from its numbers.
/// @throws UnusableVerdicts if the text is damaged or belongs to another key
[[nodiscard]] Verdicts read_verdicts(const VerdictKey &key, const std::string &text);

/// Returns $XDG_CACHE_HOME/latcon/verdicts, or ~/.cache/latcon/verdicts; none if the environment sets neither. Failing
/// verdicts are kept there as well, since the same inputs would fail again; any number of processes may read and write.
[[nodiscard]] std::optional<std::string> verdicts_folder_of_user();

/// Returns the file of a key in a folder: its hash and ".json".
[[nodiscard]] std::string verdicts_file(const std::string &folder, const VerdictKey &key);

/// Writes verdicts to their file in a folder, which is made if it is missing. @throws OutputError
void store_verdicts(const std::string &folder, const VerdictKey &key, const Verdicts &verdicts);

/// Returns the text of a file; none if there is no such file. @throws UnusableVerdicts if it cannot be read
[[nodiscard]] std::optional<std::string> stored_text(const std::string &file);

} // namespace latcon::claims
