#include "support/text_wrap.h"

#include <algorithm>

namespace latcon::support
{

std::size_t width_of(const std::string &text)
{
  return static_cast<std::size_t>(std::count_if(
    text.begin(), text.end(), [](const char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string &text, const std::size_t width)
{
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

std::vector<std::string> wrap_text(const std::string &text, const std::size_t width)
{
  std::vector<std::string> lines(1);
  std::size_t columns = 0;
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t end = std::min(text.find(' ', at + 1), text.size()); // a word with its leading blank
    std::string word = text.substr(at, end - at);
    at = end;
    if (columns > 0 && columns + width_of(word) > width)
    {
      lines.emplace_back();
      columns = 0;
    }
    if (columns == 0 && word.front() == ' ')
      word.erase(0, 1);
    for (const char c : word)
    {
      const bool begins_character = (static_cast<unsigned char>(c) & 0xc0) != 0x80;
      if (begins_character && columns == width)
      {
        lines.emplace_back();
        columns = 0;
      }
      columns += begins_character ? 1 : 0;
      // Control characters (line breaks, escape sequences) would break the table.
      lines.back() += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  return lines;
}

} // namespace latcon::support
