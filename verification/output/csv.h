/// Tables of numbers and words as CSV (RFC 4180).
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace latcon::output
{

/// Table with one header line. Numbers are written in full precision.
class Table
{
public:
  using Cell = std::variant<double, std::uint64_t, std::string>;

  /// Creates an empty table. @param columns names, with the unit in brackets if there is one: "k d", "phase velocity
  /// [m/s]"
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Appends a row. @throws std::invalid_argument unless there is a cell for every column
  void add(std::vector<Cell> row);

  /// Appends the rows of a table. @throws std::invalid_argument if its columns differ
  void add(const Table &other);

  const std::vector<std::string> &columns() const { return columns_; }
  const std::vector<std::vector<Cell>> &rows() const { return rows_; }

  [[nodiscard]] std::string csv() const;

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

} // namespace latcon::output
