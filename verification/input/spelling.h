/// What a mistyped word was meant to be.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace latcon::input
{

/// How many letters were inserted, lost, wrong, or swapped with their neighbour between one word and the other (optimal
/// string alignment, the restricted Damerau-Levenshtein distance); capitals count as small letters. Only the first 200
/// bytes count.
[[nodiscard]] std::size_t typing_errors(std::string a, std::string b);

/// Whether a word is near enough to a known one to have been meant: few typing errors, or a part of it.
[[nodiscard]] bool could_mean(const std::string &given, const std::string &known);

/// The known word nearest to the given one; the first of several; empty if none could be meant.
[[nodiscard]] std::string nearest_word(const std::string &given, const std::vector<std::string> &known);

} // namespace latcon::input
