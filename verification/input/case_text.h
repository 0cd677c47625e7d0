/// Parser for .prm and .json case files: assignments and their positions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace latcon::input
{

/// One assignment of a value to an entry, not yet interpreted.
struct Assignment
{
  std::string place;   ///< "FILE:LINE", or "FILE:/Section/Name" in JSON
  std::string section; ///< empty outside of any section
  std::string name;
  std::string value; ///< without blanks around it; lists with commas
};

/// Beginning of a section.
struct SectionStart
{
  std::string place;
  std::string section;
};

/// Line, or piece of JSON, that cannot be parsed.
struct SyntaxProblem
{
  std::string place;
  std::string text;
  bool ends_case = false; ///< what follows was not parsed, so missing entries mean nothing
};

/// Parsed case in the order of its lines; problems found at the end of the file come last.
using CaseText = std::vector<std::variant<SectionStart, Assignment, SyntaxProblem>>;

/// Problem of a text that holds a zero byte, with the line of the first; none if it holds none.
/// @param name name of the file in positions
[[nodiscard]] std::optional<SyntaxProblem> zero_byte(const std::string &text, const std::string &name);

/// Parses deal.II's parameter format: `subsection X`, `set name = value`, `end` (or all of these words in
/// capitals), `#` comments, of a line of their own or after a blank, `\` at the end of a line to continue it. Line ends
/// may be those of any system. Parsing continues after a problem.
/// @param text content of the file; text that is not (it holds zero bytes) gives one problem
/// @param name name of the file in positions
[[nodiscard]] CaseText read_prm(const std::string &text, const std::string &name);

/// Parses JSON: an object of objects (the sections) of numbers, strings, booleans, and arrays of those. Repeated
/// keys are kept. The digits of numbers are kept as they are. Text that is not (it holds zero bytes) gives one problem.
[[nodiscard]] CaseText read_json(const std::string &text, const std::string &name);

/// Returns a text without leading and trailing blanks and line ends.
[[nodiscard]] std::string trimmed(const std::string &text);

/// Joins words with ", ".
[[nodiscard]] std::string comma_separated(const std::vector<std::string> &words);

/// Reason why a text cannot be a value in a case file; empty if it can.
[[nodiscard]] std::string unwritable(const std::string &text);

/// Formats a text for a message: on one line, bytes that are not printable UTF-8 as `\xNN`, the middle omitted if it
/// has more than `longest` bytes.
[[nodiscard]] std::string printable(const std::string &text, std::size_t longest = 80);

// Suggestions for mistyped words.

/// Number of letters inserted, deleted, replaced, or swapped with their neighbour between two words (optimal string
/// alignment, the restricted Damerau-Levenshtein distance), ignoring case. Only the first 200 bytes count.
[[nodiscard]] std::size_t typing_errors(std::string a, std::string b);

/// Returns whether a known word may have been meant by a given one: few typing errors, or a part of it.
[[nodiscard]] bool could_mean(const std::string &given, const std::string &known);

/// Returns the known word nearest to the given one, the first of several; empty if none may have been meant.
[[nodiscard]] std::string nearest_word(const std::string &given, const std::vector<std::string> &known);

/// Returns "; nearest: WORD" for a message, or `otherwise` if there is none.
[[nodiscard]] std::string nearest_hint(const std::string &given, const std::vector<std::string> &known,
                                       const std::string &otherwise = "");

} // namespace latcon::input
