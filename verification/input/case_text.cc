#include "verification/input/case_text.h"

#include <algorithm>
#include <cctype>

#include <boost/algorithm/string.hpp>

namespace latcon::input
{
namespace
{

constexpr char blanks[] = " \t\r\n\v\f";

struct Line
{
  std::size_t number; // of the first line, if continued
  std::string text;   // without comment and without blanks around it
};

std::string place_of(const std::string &name, const std::size_t line)
{
  return name + ":" + std::to_string(line);
}

// Removes the word from the beginning of the line, in small or capital letters and followed by a blank or nothing.
// @return whether the line begins with it
bool take_word(std::string &line, const std::string &word)
{
  if (!boost::starts_with(line, word) && !boost::starts_with(line, boost::to_upper_copy(word)))
    return false;
  if (line.size() > word.size() && std::string(blanks).find(line[word.size()]) == std::string::npos)
    return false;
  line = trimmed(line.substr(word.size()));
  return true;
}

// Physical lines joined where they are continued, without comments; empty ones are left out.
std::vector<Line> logical_lines(const std::string &text, const std::string &name, CaseText &result)
{
  std::vector<Line> lines;
  std::size_t number = 0;
  std::size_t at = text.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0; // byte order mark
  Line line{0, ""};
  bool continued = false;
  while (at < text.size())
  {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string piece = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n')
      ++at;
    ++number;
    if (!continued)
      line = {number, ""};
    continued = !piece.empty() && piece.back() == '\\';
    const std::size_t comment = piece.find('#');
    if (comment != std::string::npos)
    {
      // 1.#QNAN, as some programs write what is no number, would be 1.
      if (comment > 0 && std::isspace(static_cast<unsigned char>(piece[comment - 1])) == 0)
        result.push_back(SyntaxProblem{place_of(name, number), "'#' begins a comment and needs a blank before it"});
      // deal.II would take the next line for a comment too, and lose what it sets without a word.
      if (continued)
        result.push_back(
          SyntaxProblem{place_of(name, number), "a comment must not end in '\\', which continues a line"});
      continued = false;
      piece.erase(comment);
    }
    else if (continued)
      piece.pop_back();
    line.text += piece;
    if (!continued)
    {
      line.text = trimmed(line.text);
      if (!line.text.empty())
        lines.push_back(line);
    }
  }
  if (continued && !trimmed(line.text).empty())
    lines.push_back({line.number, trimmed(line.text)});
  return lines;
}

} // namespace

std::string trimmed(const std::string &text)
{
  return boost::trim_copy_if(text, [](char c) { return std::string_view(blanks).find(c) != std::string_view::npos; });
}

std::string comma_separated(const std::vector<std::string> &words)
{
  return boost::join(words, ", ");
}

std::string unwritable(const std::string &text)
{
  for (const char c : text)
    if (c == '#' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return c == '#' ? "'#' begins a comment" : "control characters and line breaks are not allowed";
  if (!text.empty() && text.back() == '\\')
    return "'\\' at the end would continue the line";
  return "";
}

std::string printable(const std::string &text, const std::size_t longest)
{
  constexpr std::size_t kept_at_end = 20;
  const char digits[] = "0123456789abcdef";
  std::string shown = text;
  if (text.size() > longest)
  {
    const auto inside_character = [&text](const std::size_t i)
    { return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80; };
    std::size_t head = longest - std::min(longest, kept_at_end);
    std::size_t tail = text.size() - std::min(longest, kept_at_end);
    for (int i = 0; i < 3 && inside_character(head); ++i)
      --head;
    for (int i = 0; i < 3 && inside_character(tail); ++i)
      ++tail;
    shown = text.substr(0, head) + " ... " + text.substr(tail);
  }
  std::string result;
  for (std::size_t i = 0; i < shown.size();)
  {
    const auto c = static_cast<unsigned char>(shown[i]);
    std::size_t length = 1;
    if (c >= 0xc2 && c <= 0xdf)
      length = 2;
    else if (c >= 0xe0 && c <= 0xef)
      length = 3;
    else if (c >= 0xf0 && c <= 0xf4)
      length = 4;
    bool good = (length == 1 && c >= 0x20 && c < 0x7f) || (length > 1 && i + length <= shown.size());
    for (std::size_t k = 1; good && k < length; ++k)
      good = (static_cast<unsigned char>(shown[i + k]) & 0xc0) == 0x80;
    // U+0080 to U+009F steer terminals as control characters do. A no-break space looks like a space; U+200B to U+200F
    // and U+FEFF do not show.
    const std::string character = shown.substr(i, length);
    good = good && !(character >= "\xc2\x80" && character <= "\xc2\xa0") &&
           !(character >= "\xe2\x80\x8b" && character <= "\xe2\x80\x8f") && character != "\xef\xbb\xbf";
    if (good)
    {
      result += character;
      i += length;
    }
    else
    {
      result += {'\\', 'x', digits[c / 16], digits[c % 16]};
      ++i;
    }
  }
  return result;
}

std::optional<SyntaxProblem> zero_byte(const std::string &text, const std::string &name)
{
  const std::size_t zero = text.find('\0');
  if (zero == std::string::npos)
    return {};
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
  return SyntaxProblem{place_of(name, static_cast<std::size_t>(line)), "not a text file: it holds zero bytes", true};
}

CaseText read_prm(const std::string &text, const std::string &name)
{
  if (const auto problem = zero_byte(text, name))
    return {*problem};
  CaseText result;
  const std::vector<Line> lines = logical_lines(text, name, result);
  // With as many ends as beginnings, a section in a section is meant; otherwise an `end` was forgotten before it.
  std::ptrdiff_t surplus = 0;
  for (const Line &line : lines)
  {
    std::string rest = line.text;
    if (take_word(rest, "subsection"))
      ++surplus;
    else if (take_word(rest, "end"))
      --surplus;
  }

  std::vector<std::pair<std::string, std::size_t>> open; // sections, and the lines they begin on
  for (const Line &line : lines)
  {
    const std::string place = place_of(name, line.number);
    std::string rest = line.text;
    if (take_word(rest, "subsection"))
    {
      if (!open.empty())
      {
        const std::string where =
          "'" + printable(open.back().first) + "', which begins on line " + std::to_string(open.back().second);
        if (surplus > 0)
        {
          result.push_back(
            SyntaxProblem{place, "subsection '" + printable(rest) + "' begins, but an 'end' is missing for " + where});
          open.pop_back();
          --surplus;
        }
        else if (open.size() == 1)
          result.push_back(SyntaxProblem{place, "subsection '" + printable(rest) + "' lies inside of " + where +
                                                  "; subsections do not nest here"});
      }
      open.emplace_back(rest, line.number);
      if (open.size() == 1)
        result.push_back(SectionStart{place, rest});
    }
    else if (take_word(rest, "end"))
    {
      if (!rest.empty())
        result.push_back(
          SyntaxProblem{place, "'end' followed by '" + printable(rest) + "'; it stands alone on its line"});
      if (open.empty())
        result.push_back(SyntaxProblem{place, "'end' without a 'subsection' that it could end"});
      else
        open.pop_back();
    }
    else if (take_word(rest, "set"))
    {
      const std::size_t equals = rest.find('=');
      if (equals == std::string::npos)
        result.push_back(SyntaxProblem{place, "'set " + printable(rest) + "' has no '='; allowed: set name = value"});
      else if (open.size() <= 1)
        result.push_back(Assignment{place, open.empty() ? "" : open.back().first, trimmed(rest.substr(0, equals)),
                                    trimmed(rest.substr(equals + 1))});
    }
    else if (take_word(rest, "include"))
      result.push_back(SyntaxProblem{place, "'include' is not supported; a case is one file"});
    else
      result.push_back(SyntaxProblem{place, "not understood: '" + printable(line.text) +
                                              "'; allowed: subsection NAME, set NAME = VALUE, end, # comment"});
  }
  for (const auto &[section, line] : open)
    result.push_back(SyntaxProblem{place_of(name, line), "subsection '" + printable(section) + "' has no 'end'"});
  return result;
}

} // namespace latcon::input
