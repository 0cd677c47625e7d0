/// Verdicts of claims, kept between runs under the hash of everything they depend on.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verification/claims/claim.h"
#include "verification/claims/claim_outcome.h"
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

/// The key of a check: the bytes of the running program, the shared libraries it has loaded (name, size, time of
/// change), which claims in which size, the number of MPI ranks, and the entries that the claims read.
/// @throws std::runtime_error if the program cannot read itself
[[nodiscard]] VerdictKey verdict_key(const input::Case &input, const std::vector<Claim> &claims, bool quick,
                                     unsigned int n_ranks);

/// A complete check.
struct Verdicts
{
  output::Results results;
  std::map<std::string, std::string> tables; ///< CSV texts by file name without ".csv"
  std::string checked_at;                    ///< when: UTC, ISO 8601, "2026-11-21T16:20:05Z"

  Verdicts() = default;
  /// What claims found just now.
  explicit Verdicts(const ClaimOutcome &outcome);

  /// Writes NAME.csv for each table into `folder`, which must exist. @throws OutputError
  void write_tables(const std::string &folder) const;
};

/// A stored file that cannot be used; what() says why.
class UnusableVerdicts : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Verdicts as JSON: the key, when and by what they were found, the rows as in results.json, the tables, and a checksum
/// over all of it.
[[nodiscard]] std::string verdicts_text(const VerdictKey &key, const Verdicts &verdicts);

/// The verdicts in such a text.
/// @throws UnusableVerdicts if the text is damaged, was changed, or belongs to another key
[[nodiscard]] Verdicts read_verdicts(const VerdictKey &key, const std::string &text);

/// A folder with a file HASH.json for each key. Verdicts that fail are kept like those that hold: the same inputs would
/// fail again. They are never removed. Any number of processes may read and write at once.
class VerdictStore
{
public:
  explicit VerdictStore(std::string folder) : folder_(std::move(folder)) {}

  /// $XDG_CACHE_HOME/latcon/verdicts, or ~/.cache/latcon/verdicts; none if the environment names neither.
  [[nodiscard]] static std::optional<std::string> folder_of_user();

  [[nodiscard]] std::string path(const VerdictKey &key) const;

  /// What the file of the key holds, unchecked, never an empty text; none if there is no such file.
  /// @throws UnusableVerdicts if it is there and cannot be read or is empty
  [[nodiscard]] std::optional<std::string> read(const VerdictKey &key) const;

  /// Puts a text in the place of the file of the key, whole at any moment.
  /// @throws OutputError
  void write(const VerdictKey &key, const std::string &text) const;

private:
  std::string folder_;
};

} // namespace latcon::claims
