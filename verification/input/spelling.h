/// Suggestions for mistyped words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace latcon::input
{

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
