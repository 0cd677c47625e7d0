/// Text in columns of a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace latcon::support
{

/// Columns a text takes on the screen: its code points.
[[nodiscard]] std::size_t width_of(const std::string &text);

/// Breaks a text into lines of at most `width` columns, between words where that is possible. Control characters, which
/// would break a table, become question marks. At least one line, which may be empty.
[[nodiscard]] std::vector<std::string> wrapped(const std::string &text, std::size_t width);

} // namespace latcon::support
