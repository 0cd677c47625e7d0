#pragma once

#include <algorithm>
#include <fstream>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Invalid inputs and their messages, from problems.txt.
namespace sentences
{

struct Sentence
{
  std::string kind, input, message;
  friend std::ostream &operator<<(std::ostream &out, const Sentence &own)
  {
    return out << own.kind << ' ' << own.input;
  }
};

/// Replaces \n, \t, \r by the characters.
inline std::string unescaped(const std::string &text)
{
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    const std::size_t letter =
      text[i] == '\\' && i + 1 < text.size() ? std::string("ntr").find(text[i + 1]) : std::string::npos;
    result += letter == std::string::npos ? text[i] : "\n\t\r"[letter];
    i += letter == std::string::npos ? 0 : 1;
  }
  return result;
}

/// The entries of an input, which semicolons separate.
inline std::vector<std::string> entries(const std::string &input)
{
  std::vector<std::string> all;
  std::istringstream parts(input);
  for (std::string part; std::getline(parts >> std::ws, part, ';');)
    all.push_back(part);
  return all;
}

/// Those of some kinds.
inline std::vector<Sentence> of(const std::vector<std::string> &kinds)
{
  std::ifstream file(PROBLEMS);
  std::vector<Sentence> all;
  bool is_wanted = false;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("  ", 0) == 0 && is_wanted)
      all.back().message = line.substr(2);
    else if (!line.empty() && line[0] != '#' && line[0] != ' ')
    {
      const std::string kind = line.substr(0, line.find(' '));
      is_wanted = std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
      if (is_wanted)
        all.push_back({kind, line.substr(line.find(' ') + 1), ""});
    }
  EXPECT_GT(all.size(), 10u);
  return all;
}

} // namespace sentences
