/// What was checked, what came out, and whether it holds.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace latcon::output
{

/// Outcome of one checked quantity.
enum class Verdict
{
  holds,   ///< the error is within the tolerance
  fails,   ///< it is not, or it is missing, or a number of the row is not finite
  reported ///< no tolerance was set: for information
};

/// The word for a verdict: "holds", "fails", "reported".
[[nodiscard]] std::string to_string(Verdict verdict);

/// One checked quantity. Values that do not apply are left empty.
struct Result
{
  std::string claim;               ///< name of the claim, e.g. "energy"
  std::string quantity;            ///< what was compared, in words
  std::string unit;                ///< unit of lattice, continuum and theory; "1" for a pure number
  std::optional<double> lattice;   ///< measured on the lattice
  std::optional<double> continuum; ///< measured on the continuum
  std::optional<double> theory;    ///< from a closed formula or the literature
  std::optional<double> error;     ///< as the claim defines it, usually relative; smaller is better
  std::optional<double> tolerance; ///< largest error with which the claim holds; empty for information only

  /// Reported without a tolerance. With one it holds if the error is there, error <= tolerance, and every number that
  /// is given, of lattice, continuum, theory, error, and tolerance, is finite.
  [[nodiscard]] Verdict verdict() const;
};

/// Row of a claim in place of those that could not be computed: it fails, and gives the reason.
/// @param quantity subject and what was to be computed, in words
[[nodiscard]] Result not_computed(const std::string &claim, const std::string &quantity, const std::string &reason);

/// All results of a run.
class Results
{
public:
  /// Appends a row.
  void add(Result result);

  /// Appends the rows of another collection, in their order.
  void add(const Results &others);

  /// All rows, in the order in which they came.
  [[nodiscard]] const std::vector<Result> &rows() const { return rows_; }

  /// "fails" if a row fails, else "holds" if a row was checked, else "reported": nothing was checked, so nothing is
  /// shown.
  [[nodiscard]] Verdict verdict() const;

  /// Whether at least one row was checked and none fails.
  [[nodiscard]] bool all_hold() const { return verdict() == Verdict::holds; }

  /// Number of rows that have this verdict.
  [[nodiscard]] std::size_t count(Verdict verdict) const;

  /// How the checks came out: "98 checks hold", or how many fail and, a line each, which: claim, quantity, error,
  /// tolerance. @param most rows that are named; of more the number alone
  [[nodiscard]] std::string verdict_text(std::size_t most) const;

  /// The rows as JSON: {"claims": [{"claim": ..., "quantity": ..., "unit": ..., "lattice": ..., "continuum": ...,
  /// "theory": ..., "error": ..., "tolerance": ..., "verdict": ...}, ...], "verdict": ...}. Doubles in full precision,
  /// empty values null, numbers that are not finite as the strings "nan", "inf", "-inf".
  [[nodiscard]] std::string json() const;

  /// The rows as CSV (RFC 4180, one header line, columns as in json()). Empty values are empty fields.
  [[nodiscard]] std::string csv() const;

  /// Writes results.json and results.csv into `folder`, which must exist. @throws OutputError
  void write(const std::string &folder) const;

  /// Calls `compute`. If that throws, adds the row not_computed() with the text of the exception: a claim of which a
  /// part could not be checked does not hold. What the user or the machine must set right passes through: exceptions of
  /// the kinds Error, std::system_error, and std::bad_alloc. What is collective must throw on all ranks.
  /// @return whether it did not throw
  bool attempt(const std::string &claim, const std::string &quantity, const std::function<void()> &compute);

  /// Prints an aligned table, at most 120 columns wide, values with seven significant digits. Long names are wrapped.
  void print(std::ostream &out) const;

private:
  std::vector<Result> rows_;
};

} // namespace latcon::output
