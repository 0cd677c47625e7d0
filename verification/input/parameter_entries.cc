// Declaration, reading and writing of each kind of entry; parameters.cc processes the entries.
#include "verification/input/parameters.h"

#include "support/full_precision.h"
#include "verification/input/case_text.h"
#include "verification/input/units.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

namespace latcon::input
{

namespace
{

void require(const bool condition, const std::string &message)
{
  if (!condition)
    throw std::logic_error("parameters: " + message);
}

std::string allowed_numbers(const std::string &what, const Range &range, const std::string &unit)
{
  return what + (range.text().empty() ? "" : " " + range.text()) + (unit == "1" ? "" : " in " + units_like(unit));
}

// Reads a number with a unit or without, or says what is wrong with it.
ParsedNumber number_in(const std::string &text, const Range &range, const std::string &unit)
{
  ParsedNumber quantity = read_quantity(text, unit);
  if (quantity.wrong.empty() && !range.contains(quantity.value))
    quantity.wrong = "out of range";
  return quantity;
}

} // namespace

bool Range::contains(const double value) const
{
  return std::isfinite(value) && (value > lower.value || (lower.included && value == lower.value)) &&
         (value < upper.value || (upper.included && value == upper.value));
}

std::string Range::text() const
{
  std::string text;
  if (std::isfinite(lower.value))
    text = (lower.included ? ">= " : "> ") + support::full_precision(lower.value);
  if (std::isfinite(upper.value))
    text +=
      (text.empty() ? "" : " and ") + std::string(upper.included ? "<= " : "< ") + support::full_precision(upper.value);
  return text;
}

Declaration &Parameters::declare(Entry entry)
{
  const std::string key = entry.key();
  for (const std::string &part : {entry.section, entry.name})
    require(!part.empty() && part == trimmed(part) && part.find_first_of("/=#\\\r\n") == std::string::npos,
            "'" + key + "' is no key");
  require(keys_.count(key) == 0, key + " is declared twice");
  require(entry.unit.empty() ||
            (parse_unit(entry.unit) && parse_unit(entry.unit)->power == 0 && parse_unit(entry.unit)->factor == 1.),
          key + " has '" + entry.unit + "' for its unit, which is no SI unit");
  entry.default_text = entry.write();
  if (entry.presence == Presence::optional)
  {
    const std::string wrong = entry.read(entry.default_text);
    require(wrong.empty() && unwritable(entry.default_text).empty(),
            "the default of " + key + ", '" + entry.default_text + "', is not allowed: " + wrong +
              unwritable(entry.default_text));
  }
  keys_[key] = entries_.size();
  return entries_.emplace_back(std::move(entry));
}

template <typename Number>
Declaration &Parameters::add(const std::string &section, const std::string &name, Number &member, const Range &range,
                             const std::string &unit, const std::string &documentation, const Presence presence)
{
  constexpr bool may_be_auto = std::is_same_v<Number, std::optional<double>>;
  std::string rule = range.text();
  if (may_be_auto)
    rule += rule.empty() ? "a number, or auto" : ", or auto";
  Entry entry{{section, name, documentation, unit, rule, presence, ValueType::number, range},
              allowed_numbers(may_be_auto ? "auto, or a number" : "a number", range, unit)};
  entry.may_be_auto = may_be_auto;
  entry.read = [&member, range, unit](const std::string &text) -> std::string
  {
    if (may_be_auto && text == "auto")
    {
      member = Number();
      return "";
    }
    const ParsedNumber quantity = number_in(text, range, unit);
    if (quantity.wrong.empty())
      member = quantity.value;
    return quantity.wrong;
  };
  entry.write = [&member]
  {
    const std::optional<double> value = member;
    return value ? support::full_precision(*value) : "auto";
  };
  return declare(std::move(entry));
}

template Declaration &Parameters::add(const std::string &, const std::string &, double &, const Range &,
                                      const std::string &, const std::string &, Presence);
template Declaration &Parameters::add(const std::string &, const std::string &, std::optional<double> &, const Range &,
                                      const std::string &, const std::string &, Presence);

Declaration &Parameters::add(const std::string &section, const std::string &name, std::vector<double> &member,
                             const Range &range, const std::string &unit, const std::string &documentation)
{
  const std::string list = std::string("numbers separated by commas") + (range.text().empty() ? "" : ", each");
  const std::string rule = list + (range.text().empty() ? "" : " ") + range.text();
  Entry entry{{section, name, documentation, unit, rule, Presence::optional, ValueType::numbers, range},
              allowed_numbers(list, range, unit)};
  entry.read = [&member, range, unit](const std::string &text) -> std::string
  {
    std::vector<double> values;
    std::size_t n_with_unit = 0;
    for (std::size_t at = 0; !text.empty() && at <= text.size();)
    {
      const std::size_t end = std::min(text.find(',', at), text.size());
      const ParsedNumber quantity = number_in(text.substr(at, end - at), range, unit);
      if (!quantity.wrong.empty())
        return "number " + std::to_string(values.size() + 1) + " in the list: " + quantity.wrong;
      values.push_back(quantity.value);
      n_with_unit += quantity.has_unit ? 1 : 0;
      at = end + 1;
    }
    // In "1, 2, 3 mm" the first two would be metres, which nobody means.
    if (n_with_unit != 0 && n_with_unit != values.size())
      return "some numbers have a unit and some have none; give it to all of them or to none";
    member = values;
    return "";
  };
  entry.write = [&member]
  {
    std::vector<std::string> texts;
    texts.reserve(member.size());
    for (const double value : member)
      texts.push_back(support::full_precision(value));
    return comma_separated(texts);
  };
  return declare(std::move(entry));
}

template <typename Integer, typename>
Declaration &Parameters::add(const std::string &section, const std::string &name, Integer &member, const Range &range,
                             const std::string &documentation)
{
  std::string rule = allowed_numbers("a whole number", range, "1");
  constexpr Integer largest = std::numeric_limits<Integer>::max();
  std::optional<std::uint64_t> largest_whole;
  if (std::is_unsigned_v<Integer> && range.contains(2. * static_cast<double>(largest)))
  {
    rule += (range.text().empty() ? " <= " : " and <= ") + std::to_string(largest);
    largest_whole = largest;
  }
  Entry entry{
    {section, name, documentation, "", rule, Presence::optional, ValueType::whole_number, range, largest_whole}, rule};
  entry.read = [&member, range](const std::string &text) -> std::string
  {
    std::string digits = text;
    if (digits.size() > 1 && digits[0] == '+')
      digits.erase(0, 1);
    const std::size_t first = digits.size() > 1 && digits[0] == '-' ? 1 : 0;
    if (digits.empty())
      return "empty";
    if (digits.find_first_not_of("0123456789", first) != std::string::npos)
      return "not a whole number";
    Integer value = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), value).ec != std::errc())
      return "beyond " + std::to_string(std::numeric_limits<Integer>::min()) + " to " +
             std::to_string(std::numeric_limits<Integer>::max());
    if (!range.contains(static_cast<double>(value)))
      return "out of range";
    member = value;
    return "";
  };
  entry.write = [&member] { return std::to_string(member); };
  return declare(std::move(entry));
}

template Declaration &Parameters::add(const std::string &, const std::string &, int &, const Range &,
                                      const std::string &);
template Declaration &Parameters::add(const std::string &, const std::string &, unsigned int &, const Range &,
                                      const std::string &);
template Declaration &Parameters::add(const std::string &, const std::string &, std::uint64_t &, const Range &,
                                      const std::string &);

Declaration &Parameters::add_words(const std::string &section, const std::string &name,
                                   const std::vector<std::string> &words, const std::function<void(std::size_t)> &set,
                                   const std::function<std::size_t()> &get, const std::string &documentation,
                                   const ValueType type)
{
  const std::string rule = "one of " + comma_separated(words);
  Entry entry{{section, name, documentation, "", rule, Presence::optional, type}, rule};
  entry.words = words;
  entry.read = [words, set](const std::string &text) -> std::string
  {
    const auto found = std::find(words.begin(), words.end(), text);
    if (found == words.end())
    {
      const std::string nearest = nearest_word(text, words);
      return "not a word known here" + (nearest.empty() ? "" : " (perhaps " + nearest + ")");
    }
    set(static_cast<std::size_t>(found - words.begin()));
    return "";
  };
  entry.write = [words, get]
  {
    const std::size_t i = get();
    return i < words.size() ? words[i] : std::string();
  };
  return declare(std::move(entry));
}

Declaration &Parameters::add(const std::string &section, const std::string &name, bool &member,
                             const std::string &documentation)
{
  return add_words(
    section, name, {"false", "true"}, [&member](const std::size_t i) { member = i == 1; },
    [&member] { return std::size_t(member ? 1 : 0); }, documentation, ValueType::boolean);
}

Declaration &Parameters::add(const std::string &section, const std::string &name, std::string &member,
                             const std::string &documentation)
{
  Entry entry{{section, name, documentation, "", "", Presence::optional, ValueType::text}, "a text on one line"};
  entry.read = [&member](const std::string &text) -> std::string
  {
    if (text != trimmed(text))
      return "blanks around it would be lost";
    member = text;
    return "";
  };
  entry.write = [&member] { return member; };
  return declare(std::move(entry));
}

} // namespace latcon::input
