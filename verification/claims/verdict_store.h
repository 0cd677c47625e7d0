/// Cache of verdicts, by the hash of everything they depend on.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verification/bridge/laws.h"
#include "verification/claims/claim.h"
#include "verification/claims/rows.h"
#include "verification/input/case.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Everything that verdicts depend on, in one text, and its hash.
struct VerdictKey
{
  explicit VerdictKey(std::string inputs);

  std::string text; ///< a line for each input
  std::string hash; ///< SHA-256 of the text, 64 hexadecimal digits
};

/// Returns the key of a check: hash of the program, claims and their size, laws that are judged, number of MPI ranks,
/// and the entries that the claims read; of claims that are about the program alone the first two. The shared libraries
/// of the check are kept with its verdicts.
/// @throws std::runtime_error if the program cannot read itself
[[nodiscard]] VerdictKey verdict_key(const input::Case &input, const std::vector<Claim> &claims,
                                     const bridge::Laws &laws, bool quick, unsigned int n_ranks);

/// A complete check.
struct Verdicts
{
  output::Results results;
  std::map<std::string, std::string> tables; ///< CSV texts by file name without ".csv"
  std::string checked_at;                    ///< UTC, ISO 8601: "2026-11-21T16:20:05Z"

  Verdicts() = default;
  /// Verdicts of claims that were checked just now.
  explicit Verdicts(const ClaimOutcome &outcome);

  /// Writes NAME.csv for each table into `folder`, which must exist. @throws OutputError
  void write_tables(const std::string &folder) const;
};

/// Returns why verdicts do not let a crack run, apart from rows that fail: a row of another claim, or a claim that
/// judged nothing that a crack waits for. The same for verdicts that were just computed and for cached ones.
/// @param required claims that the crack waits for @return a message; empty: none
[[nodiscard]] std::string acceptance_problem(const output::Results &results, const std::vector<Claim> &required);

/// A stored file that cannot be used; what() says why.
class UnusableVerdicts : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Returns verdicts as JSON: the key, time and program of the check, the rows as in results.json, the tables, and a
/// checksum of the document.
[[nodiscard]] std::string verdicts_text(const VerdictKey &key, const Verdicts &verdicts);

/// Parses such a text.
/// @param libraries_may_be_updated accept libraries of the same names, which a release of Debian updates for security
/// @throws UnusableVerdicts if the text is damaged, was changed, or belongs to another key
[[nodiscard]] Verdicts read_verdicts(const VerdictKey &key, const std::string &text,
                                     bool libraries_may_be_updated = false);

/// Folder with a file HASH.json per key. Failing verdicts are kept as well, since the same inputs would fail again.
/// Files are never removed. Any number of processes may read and write at once.
class VerdictStore
{
public:
  explicit VerdictStore(std::string folder) : folder_(std::move(folder)) {}

  /// Returns $XDG_CACHE_HOME/latcon/verdicts, or ~/.cache/latcon/verdicts; none if the environment sets neither.
  [[nodiscard]] static std::optional<std::string> folder_of_user();

  [[nodiscard]] std::string path(const VerdictKey &key) const;

  /// Reads the file of the key, unchecked; none if there is no such file.
  /// @throws UnusableVerdicts if the file cannot be read or is empty
  [[nodiscard]] std::optional<std::string> read(const VerdictKey &key) const;

  /// Replaces the file of the key atomically.
  /// @throws OutputError
  void write(const VerdictKey &key, const std::string &text) const;

  /// Waits while another process checks the claims of the key, so that the runs of a study or of a job array check them
  /// once. The wait is at most ten minutes, and none where folders cannot be created or locked: then both check.
  /// @return turn of this process, which ends with the object
  [[nodiscard]] std::shared_ptr<void> wait_for_turn(const VerdictKey &key) const;

private:
  std::string folder_;
};

/// Returns the text of verdicts that were packed with the program, in verdicts/ of its data folder; empty if there are
/// none for the key, a row of them fails, or a library of the check is not here.
[[nodiscard]] std::string shipped_verdicts(const VerdictKey &key);

} // namespace latcon::claims
