/// Text layout in terminal columns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace latcon::support
{

/// Returns the number of terminal columns of a UTF-8 text: its code points.
[[nodiscard]] std::size_t width_of(const std::string &text);

/// Returns a text with blanks behind it, as wide as `width` or wider.
[[nodiscard]] std::string padded(const std::string &text, std::size_t width);

/// Returns at most 511 characters of numbers in a format of std::printf().
template <class... Numbers>
[[nodiscard]] std::string formatted(const char *format, Numbers... numbers)
{
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), format, numbers...);
  return text.data();
}

/// Returns texts and numbers one after the other, as a stream writes them.
template <class... Parts>
[[nodiscard]] std::string text_of(const Parts &...parts)
{
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Breaks a text into lines of at most `width` columns, between words where possible. Replaces control characters,
/// which would break a table, by question marks. Returns at least one line, which may be empty.
[[nodiscard]] std::vector<std::string> wrap_text(const std::string &text, std::size_t width);

} // namespace latcon::support
