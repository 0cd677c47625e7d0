#include "verification/output/results.h"

#include "support/errors.h"
#include "support/full_precision.h"
#include "support/text_wrap.h"
#include "verification/output/csv.h"
#include "verification/output/output_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>
#include <ostream>
#include <system_error>

namespace latcon::output
{

namespace
{

using Value = std::optional<double>;
using Json = nlohmann::ordered_json;

// Returns the columns of a row by their names. JSON has no numbers that are not finite, and null means that there is no
// value.
Json columns_of(const Result &row)
{
  const auto number = [](const Value &value) {
    return !value ? Json() : std::isfinite(*value) ? Json(*value) : Json(support::full_precision(*value));
  };
  return {{"claim", row.claim},
          {"quantity", row.quantity},
          {"unit", row.unit},
          {"lattice", number(row.lattice)},
          {"continuum", number(row.continuum)},
          {"theory", number(row.theory)},
          {"error", number(row.error)},
          {"tolerance", number(row.tolerance)},
          {"verdict", to_string(row.verdict())},
          {"reason", row.tolerance.reason},
          {"gate", row.gate},
          {"kind", to_string(row.kind)}};
}

// Reads a number of columns_of().
Value value_of(const nlohmann::json &number)
{
  if (number.is_null())
    return {};
  return number.is_string() ? std::stod(number.get<std::string>()) : number.get<double>();
}

std::string table_number(const Value &value, const int digits)
{
  return value ? support::formatted("%.*g", digits, *value) : "";
}

} // namespace

std::string to_string(const Verdict verdict)
{
  return verdict == Verdict::holds ? "holds" : verdict == Verdict::reported ? "reported" : "fails";
}

std::string to_string(const RowKind kind)
{
  return kind == RowKind::claim ? "claim" : kind == RowKind::ledger ? "ledger" : "reference";
}

Verdict Result::verdict() const
{
  if (!tolerance)
    return Verdict::reported;
  for (const Value *number : {&lattice, &continuum, &theory, &error, static_cast<const Value *>(&tolerance)})
    if (const Value &value = *number; value && !std::isfinite(*value))
      return Verdict::fails;
  return error && *error <= *tolerance ? Verdict::holds : Verdict::fails;
}

Tolerance limited(const double estimate, const double floor, const double ceiling, const std::string &reason)
{
  const double value = estimate < floor ? floor : estimate > ceiling ? ceiling : estimate; // NaN stays
  return {value, reason + " (at least " + table_number(floor, 3) + ", at most " + table_number(ceiling, 3) + ")"};
}

Result not_computed(const std::string &claim, const std::string &quantity, const std::string &reason)
{
  return {claim,
          quantity + ": not computed: " + reason,
          "1",
          {},
          {},
          {},
          std::numeric_limits<double>::quiet_NaN(),
          {0., "it must be computed"}};
}

void Results::add(Result result)
{
  rows_.push_back(std::move(result));
}

void Results::add(const Results &others)
{
  const std::vector<Result> copy = others.rows_; // `others` may be this object
  rows_.insert(rows_.end(), copy.begin(), copy.end());
}

void Results::mark_gate()
{
  for (Result &row : rows_)
    row.gate = row.tolerance.has_value();
}

bool Results::attempt(const std::string &claim, const std::string &quantity, const std::function<void()> &compute)
{
  try
  {
    compute();
    return true;
  }
  catch (const std::exception &error)
  {
    if (dynamic_cast<const support::Error *>(&error) != nullptr ||
        dynamic_cast<const std::bad_alloc *>(&error) != nullptr ||
        dynamic_cast<const std::system_error *>(&error) != nullptr)
      throw;
    add(not_computed(claim, quantity, error.what()));
    return false;
  }
}

Verdict Results::verdict() const
{
  Verdict all = Verdict::reported;
  for (const Result &row : rows_)
    if (row.verdict() == Verdict::fails)
      return Verdict::fails;
    else if (row.verdict() == Verdict::holds)
      all = Verdict::holds;
  return all;
}

std::size_t Results::count(const Verdict verdict) const
{
  return static_cast<std::size_t>(
    std::count_if(rows_.begin(), rows_.end(), [verdict](const Result &row) { return row.verdict() == verdict; }));
}

std::vector<std::pair<std::string, RowKind>> Results::failed_rows() const
{
  std::vector<std::pair<std::string, RowKind>> failed;
  for (const Result &row : rows_)
    if (row.verdict() == Verdict::fails)
      failed.emplace_back(row.claim + ": " + row.quantity, row.kind);
  return failed;
}

std::string Results::count_text() const
{
  const std::size_t failing = count(Verdict::fails), judged = failing + count(Verdict::holds);
  if (judged == 0)
    return "nothing was checked";
  const std::string checks = std::to_string(judged) + (judged == 1 ? " check" : " checks");
  if (failing == 0)
    return checks + (judged == 1 ? " holds" : " hold");
  return std::to_string(failing) + " of " + checks + (failing == 1 ? " fails" : " fail");
}

std::string Results::verdict_text(const std::size_t most) const
{
  const std::size_t failing = count(Verdict::fails);
  std::string text = count_text() + (failing > 0 ? ":\n" : "\n");
  std::size_t named = 0;
  for (const Result &row : rows_)
    if (row.verdict() == Verdict::fails && named++ < most)
      text += "  " + row.claim + ": " + row.quantity + ": error " +
              (!row.error               ? "none"
               : std::isnan(*row.error) ? "not measured"
                                        : table_number(row.error, 3)) +
              ", tolerance " + table_number(row.tolerance, 3) + "\n";
  if (failing > most)
    text += "  and " + std::to_string(failing - most) + " more, see results.csv\n";
  return text;
}

std::string Results::json() const
{
  Json document{{"claims", Json::array()}, {"verdict", to_string(verdict())}};
  for (const Result &row : rows_)
    document["claims"].push_back(columns_of(row));
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Results Results::read(const std::string &json)
{
  const nlohmann::json document = nlohmann::json::parse(json);
  Results results;
  for (const nlohmann::json &row : document.at("claims"))
    results.add({row.at("claim"),
                 row.at("quantity"),
                 row.at("unit"),
                 value_of(row.at("lattice")),
                 value_of(row.at("continuum")),
                 value_of(row.at("theory")),
                 value_of(row.at("error")),
                 {value_of(row.at("tolerance")), row.at("reason")},
                 row.at("gate")});
  return results;
}

std::string Results::csv() const
{
  std::vector<std::string> names;
  const Json empty = columns_of({});
  for (const auto &[name, value] : empty.items())
    names.push_back(name);
  Table table(std::move(names));
  for (const Result &row : rows_)
  {
    std::vector<Table::Cell> cells;
    for (const Json &value : columns_of(row))
      if (value.is_number())
        cells.emplace_back(value.get<double>());
      else
        cells.emplace_back(value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump());
    table.add(std::move(cells));
  }
  return table.csv();
}

void Results::write(const std::string &folder) const
{
  const std::filesystem::path path(folder);
  write_file((path / "results.json").string(), json());
  write_file((path / "results.csv").string(), csv());
}

void Results::print(std::ostream &out) const
{
  constexpr std::size_t n_columns = 8;
  constexpr std::size_t n_words =
    2; // columns of words on the left, which may be wrapped; numbers and the verdict follow
  constexpr std::size_t widest = 120;
  constexpr std::size_t gap = 2;
  using Cells = std::array<std::string, n_columns>;

  std::vector<Cells> table;
  table.push_back({"claim", "quantity [unit]", "lattice", "continuum", "theory", "error", "tolerance", "verdict"});
  for (const Result &row : rows_)
    table.push_back({row.claim, row.quantity + " [" + row.unit + "]", table_number(row.lattice, 7),
                     table_number(row.continuum, 7), table_number(row.theory, 7), table_number(row.error, 3),
                     table_number(row.tolerance, 3), to_string(row.verdict())});

  std::array<std::size_t, n_columns> width{};
  for (const Cells &cells : table)
    for (std::size_t i = 0; i < n_columns; ++i)
      width[i] = std::max(width[i], support::width_of(cells[i]));
  // Numbers are never truncated, so the words share the remaining width: the claim has a fixed limit, the quantity gets
  // the rest.
  width[0] = std::min<std::size_t>(width[0], 20);
  std::size_t others = 0;
  for (std::size_t i = 0; i < n_columns; ++i)
    others += (i == 1 ? 0 : width[i]) + (i == 0 ? 0 : gap);
  width[1] = std::min(width[1], widest - others);

  for (std::size_t r = 0; r < table.size(); ++r)
  {
    std::array<std::vector<std::string>, n_columns> lines;
    std::size_t n_lines = 1;
    for (std::size_t i = 0; i < n_columns; ++i)
    {
      lines[i] = support::wrap_text(table[r][i], width[i]);
      n_lines = std::max(n_lines, lines[i].size());
    }
    for (std::size_t l = 0; l < n_lines; ++l)
    {
      std::string line;
      for (std::size_t i = 0; i < n_columns; ++i)
      {
        const std::string cell = l < lines[i].size() ? lines[i][l] : "";
        const bool is_number = i >= n_words && i + 1 < n_columns; // of ASCII alone
        line += std::string(gap * (i > 0) + (is_number ? width[i] - cell.size() : 0), ' ');
        line += is_number ? cell : support::padded(cell, width[i]);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out << line << '\n';
    }
    if (r == 0)
      out << std::string(others + width[1], '-') << '\n';
  }
}

} // namespace latcon::output
