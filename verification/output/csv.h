/// Tables of numbers and words as CSV (RFC 4180).
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace latcon::output
{

/// A field that holds `text`: quoted where commas, quotes or line breaks ask for it.
[[nodiscard]] std::string csv_field(const std::string &text);

/// A table with one header line. Numbers are written in full precision.
class Table
{
public:
  using Cell = std::variant<double, std::string>;

  /// @param columns names, with the unit in brackets where there is one: "k d", "phase velocity [m/s]"
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// @throws std::invalid_argument unless there is a cell for every column
  void add(std::vector<Cell> row);

  /// Appends the rows of a table. @throws std::invalid_argument unless it has the same columns
  void add(const Table &other);

  const std::vector<std::string> &columns() const { return columns_; }
  const std::vector<std::vector<Cell>> &rows() const { return rows_; }

  [[nodiscard]] std::string csv() const;

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

} // namespace latcon::output
