#include "verification/output/csv.h"

#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "support/full_precision.h"

namespace latcon::output
{
namespace
{

// Returns a field that contains the text, quoted if it has commas, quotes or line breaks.
std::string csv_field(const std::string &text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::ostringstream field;
  field << std::quoted(text, '"', '"');
  return field.str();
}

} // namespace

void Table::add(std::vector<Cell> row)
{
  if (row.size() != columns_.size())
    throw std::invalid_argument("a row of " + std::to_string(row.size()) + " cells in a table of " +
                                std::to_string(columns_.size()) + " columns");
  rows_.push_back(std::move(row));
}

void Table::add(const Table &other)
{
  if (other.columns_ != columns_)
    throw std::invalid_argument("tables with different columns cannot be concatenated");
  rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end());
}

std::string Table::csv() const
{
  std::string text;
  const auto end_line = [&text] { text.back() = '\n'; };
  for (const std::string &column : columns_)
    text += csv_field(column) + ',';
  end_line();
  for (const std::vector<Cell> &row : rows_)
  {
    for (const Cell &cell : row)
      if (const auto *word = std::get_if<std::string>(&cell))
        text += csv_field(*word) + ',';
      else if (const auto *number = std::get_if<double>(&cell))
        text += support::full_precision(*number) + ',';
      else
        text += std::to_string(std::get<std::uint64_t>(cell)) + ',';
    end_line();
  }
  return text;
}

} // namespace latcon::output
