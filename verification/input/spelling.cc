#include "verification/input/case_text.h"

#include <algorithm>

namespace latcon::input
{

std::size_t typing_errors(std::string a, std::string b)
{
  // No known word is this long, and the cost is quadratic.
  constexpr std::size_t longest = 200;
  for (std::string *word : {&a, &b})
  {
    word->resize(std::min(word->size(), longest));
    for (char &c : *word)
      if (c >= 'A' && c <= 'Z')
        c = static_cast<char>(c - 'A' + 'a');
  }
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j)
    {
      if (i == 0 || j == 0)
      {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

bool could_mean(const std::string &given, const std::string &known)
{
  const std::size_t errors = typing_errors(given, known);
  // A short word must keep at least one of its letters.
  return (errors <= std::max<std::size_t>(2, known.size() / 3) && errors < known.size()) ||
         (given.size() >= 2 && known.compare(0, given.size(), given) == 0) ||
         (given.size() >= 4 && known.find(given) != std::string::npos);
}

std::string nearest_word(const std::string &given, const std::vector<std::string> &known)
{
  std::string nearest;
  for (const std::string &word : known)
    if (could_mean(given, word) && (nearest.empty() || typing_errors(given, word) < typing_errors(given, nearest)))
      nearest = word;
  return nearest;
}

std::string nearest_hint(const std::string &given, const std::vector<std::string> &known, const std::string &otherwise)
{
  const std::string nearest = nearest_word(given, known);
  return nearest.empty() ? otherwise : "; nearest: " + nearest;
}

} // namespace latcon::input
