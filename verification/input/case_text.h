/// The two ways to write a case down, taken apart into assignments with the place of each.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace latcon::input
{

/// One value given to one entry; what the words mean is not known here.
struct Assignment
{
  std::string place;   ///< "FILE:LINE", or "FILE:/Section/Name" in JSON
  std::string section; ///< empty outside of any section
  std::string name;
  std::string value; ///< without blanks around it; lists with commas
};

/// The beginning of a section.
struct SectionStart
{
  std::string place;
  std::string section;
};

/// A line, or a piece of JSON, that cannot be understood.
struct SyntaxProblem
{
  std::string place;
  std::string text;
};

/// A case as it was written down, in the order of its lines (what is found missing at the end of the file comes last).
using CaseText = std::vector<std::variant<SectionStart, Assignment, SyntaxProblem>>;

/// What is wrong with a text that holds a zero byte, with the line of the first; nothing if it holds none.
/// @param name what the place calls the file
[[nodiscard]] std::optional<SyntaxProblem> zero_byte(const std::string &text, const std::string &name);

/// Takes deal.II's parameter format apart: `subsection X`, `set name = value`, `end` (or all of these words in
/// capitals), `#` comments, of a line of their own or after a blank, `\` at the end of a line to continue it. Line ends
/// may be those of any system. What follows a problem is still read.
/// @param text content of the file; text that is not (it holds zero bytes) gives one problem
/// @param name what the places call the file
[[nodiscard]] CaseText read_prm(const std::string &text, const std::string &name);

/// Takes JSON apart: an object of objects (the sections) of numbers, strings, booleans, and arrays of those. Repeated
/// keys are kept. The digits of numbers are kept as they are. Text that is not (it holds zero bytes) gives one problem.
[[nodiscard]] CaseText read_json(const std::string &text, const std::string &name);

/// A text without the blanks and line ends around it.
[[nodiscard]] std::string trimmed(const std::string &text);

/// Words with ", " between them.
[[nodiscard]] std::string comma_separated(const std::vector<std::string> &words);

/// Why a text cannot stand in a case file as a value; empty if it can.
[[nodiscard]] std::string unwritable(const std::string &text);

/// A text fit for a message: on one line, bytes that are not printable UTF-8 as `\xNN`, the middle left out if it has
/// more than `longest` bytes.
[[nodiscard]] std::string printable(const std::string &text, std::size_t longest = 80);

} // namespace latcon::input
