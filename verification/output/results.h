/// Results of claims: checked quantities, errors and verdicts.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace latcon::output
{

/// Verdict on one checked quantity.
enum class Verdict
{
  holds,   ///< the error is within the tolerance
  fails,   ///< the error is larger or missing, or a number of the row is not finite
  reported ///< informational: there is no tolerance
};

/// Returns the name of a verdict: "holds", "fails", "reported".
[[nodiscard]] std::string to_string(Verdict verdict);

/// Subject of a row, and so the meaning of its failure.
enum class RowKind
{
  claim,    ///< lattice, continuum and theory: the program, or the material, is not what the claim states
  ledger,   ///< energies of this run: its numbers are no measurement
  reference ///< this run with published values: its numbers are a measurement that differs
};

/// Returns the name of a kind: "claim", "ledger", "reference".
[[nodiscard]] std::string to_string(RowKind kind);

/// Largest error with which a row holds, and how it was derived; empty: the row is informational.
struct Tolerance : std::optional<double>
{
  Tolerance() = default;
  Tolerance(std::optional<double> value, std::string why = {}) : std::optional<double>(value), reason(std::move(why)) {}
  Tolerance(double value, std::string why = {}) : Tolerance(std::optional<double>(value), std::move(why)) {}
  Tolerance(std::nullopt_t) {}

  std::string reason; ///< in a few words: the terms that the tolerance covers, and how large they are
};

/// Returns a tolerance that was estimated from computations, limited by bounds that do not depend on them, so that
/// neither scatter nor an error of the solver loosens it. The reason states the bounds.
/// @param floor,ceiling 0 <= floor <= ceiling
/// @return not-a-number, with which every row fails, if the estimate is not-a-number
[[nodiscard]] Tolerance limited(double estimate, double floor, double ceiling, const std::string &reason);

/// Result for one checked quantity. Values that do not apply are empty.
struct Result
{
  std::string claim;               ///< name of the claim, e.g. "energy"
  std::string quantity;            ///< description of the compared quantity
  std::string unit;                ///< unit of lattice, continuum and theory; "1" for a pure number
  std::optional<double> lattice;   ///< measured on the lattice
  std::optional<double> continuum; ///< measured on the continuum
  std::optional<double> theory;    ///< from a closed formula or the literature
  std::optional<double> error;     ///< as defined by the claim, usually relative; smaller is better
  Tolerance tolerance = {};        ///< largest error with which the claim holds; empty: informational
  bool gate = false;               ///< whether a crack is refused if the row does not hold
  RowKind kind = RowKind::claim;

  /// Returns `reported` if there is no tolerance. Otherwise `holds` if there is an error, error <= tolerance, and all
  /// given numbers (lattice, continuum, theory, error, tolerance) are finite; otherwise `fails`.
  [[nodiscard]] Verdict verdict() const;
};

/// Returns a row that fails, with the reason, for rows of a claim that could not be computed.
/// @param quantity subject and quantity that could not be computed
[[nodiscard]] Result not_computed(const std::string &claim, const std::string &quantity, const std::string &reason);

/// Collection of all results of a run.
class Results
{
public:
  /// Appends a row.
  void add(Result result);

  /// Appends the rows of another collection, in their order.
  void add(const Results &others);

  /// Marks all rows that are judged as rows that a crack waits for.
  void mark_gate();

  /// Returns all rows, in the order in which they were added.
  [[nodiscard]] const std::vector<Result> &rows() const { return rows_; }

  /// Returns `fails` if a row fails, otherwise `holds` if a row was checked, otherwise `reported`.
  [[nodiscard]] Verdict verdict() const;

  /// Returns true if at least one row was checked and none fails.
  [[nodiscard]] bool all_hold() const { return verdict() == Verdict::holds; }

  /// Returns the number of rows with this verdict.
  [[nodiscard]] std::size_t count(Verdict verdict) const;

  /// Returns "CLAIM: QUANTITY" and kind of each row that fails, in order.
  [[nodiscard]] std::vector<std::pair<std::string, RowKind>> failed_rows() const;

  /// Returns "98 checks hold", "1 of 98 checks fails" or "nothing was checked".
  [[nodiscard]] std::string count_text() const;

  /// Returns count_text() with a line for each failure: claim, quantity, error, tolerance.
  /// @param most largest number of listed rows
  [[nodiscard]] std::string verdict_text(std::size_t most) const;

  /// Returns the rows as JSON: {"claims": [{"claim": ..., "quantity": ..., "unit": ..., "lattice": ..., "continuum":
  /// ..., "theory": ..., "error": ..., "tolerance": ..., "verdict": ..., "reason": ..., "gate": ..., "kind": ...},
  /// ...], "verdict": ...}. Doubles in full precision, empty values null, numbers that are not finite as the strings
  /// "nan", "inf",
  /// "-inf".
  [[nodiscard]] std::string json() const;

  /// Returns the rows of such a text; verdicts follow from the numbers.
  /// @throws nlohmann::json::exception, std::logic_error if it is no such text
  [[nodiscard]] static Results read(const std::string &json);

  /// Returns the rows as CSV (RFC 4180, one header line, columns as in json()). Empty values are empty fields.
  [[nodiscard]] std::string csv() const;

  /// Writes results.json and results.csv into `folder`, which must exist. @throws OutputError
  void write(const std::string &folder) const;

  /// Calls `compute`. If it throws, adds the row not_computed() with the message of the exception, because a claim does
  /// not hold if a part of it could not be checked. Propagates exceptions that the user or the machine must resolve:
  /// Error, std::system_error, and std::bad_alloc. Collective functions must throw on all ranks.
  /// @return true if `compute` did not throw
  bool attempt(const std::string &claim, const std::string &quantity, const std::function<void()> &compute);

  /// Prints an aligned table, at most 120 columns wide, values with seven significant digits. Long names are wrapped.
  void print(std::ostream &out) const;

private:
  std::vector<Result> rows_;
};

} // namespace latcon::output
