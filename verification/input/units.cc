#include "verification/input/units.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace latcon::input
{

namespace
{

struct NamedUnit
{
  std::string_view name;
  Unit unit;
  bool takes_prefixes;
};

constexpr double pi = 3.14159265358979323846;

// Exponents of m, kg, s, rad.
constexpr NamedUnit named_units[] = {
  {"m", {{1, 0, 0, 0}, 0, 1.}, true},     {"g", {{0, 1, 0, 0}, -3, 1.}, true},
  {"s", {{0, 0, 1, 0}, 0, 1.}, true},     {"N", {{1, 1, -2, 0}, 0, 1.}, true},
  {"Pa", {{-1, 1, -2, 0}, 0, 1.}, true},  {"bar", {{-1, 1, -2, 0}, 5, 1.}, true},
  {"J", {{2, 1, -2, 0}, 0, 1.}, true},    {"W", {{2, 1, -3, 0}, 0, 1.}, true},
  {"Hz", {{0, 0, -1, 0}, 0, 1.}, true},   {"min", {{0, 0, 1, 0}, 0, 60.}, false},
  {"h", {{0, 0, 1, 0}, 0, 3600.}, false}, {"rad", {{0, 0, 0, 1}, 0, 1.}, false},
  {"1", {{0, 0, 0, 0}, 0, 1.}, false},    {"deg", {{0, 0, 0, 1}, 0, pi / 180.}, false},
  {"%", {{0, 0, 0, 0}, -2, 1.}, false},
};

struct Prefix
{
  std::string_view name;
  int power;
};

// Both code points that are used for the Greek letter denote micro.
constexpr Prefix prefixes[] = {{"n", -9}, {"u", -6}, {"\xc2\xb5", -6}, {"\xce\xbc", -6}, {"m", -3},
                               {"c", -2}, {"d", -1}, {"k", 3},         {"M", 6},         {"G", 9}};

// Units worth naming when one of their dimension is wanted; the first is the SI unit.
constexpr std::string_view usual_units[][6] = {{"m", "nm", "um", "mm", "cm", "km"},
                                               {"kg", "mg", "g", "", "", ""},
                                               {"s", "us", "ms", "min", "h", ""},
                                               {"rad", "deg", "", "", "", ""},
                                               {"Pa", "kPa", "MPa", "GPa", "bar", ""},
                                               {"N", "mN", "kN", "MN", "", ""},
                                               {"J", "mJ", "kJ", "MJ", "", ""},
                                               {"Hz", "kHz", "MHz", "", "", ""},
                                               {"m/s", "cm/s", "mm/s", "km/s", "km/h", ""},
                                               {"kg/m^3", "g/cm^3", "", "", "", ""},
                                               {"1", "%", "", "", "", ""}};

std::string_view without_blanks(const std::string_view text)
{
  const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::optional<Unit> single_unit(const std::string_view name)
{
  // Whole names first: "min" is a minute, not a milli-inch, and "Pa" is no prefix.
  for (const NamedUnit &candidate : named_units)
    if (name == candidate.name)
      return candidate.unit;
  for (const Prefix &prefix : prefixes)
    if (name.substr(0, prefix.name.size()) == prefix.name)
      for (const NamedUnit &candidate : named_units)
        if (candidate.takes_prefixes && name.substr(prefix.name.size()) == candidate.name)
        {
          Unit unit = candidate.unit;
          unit.power += prefix.power;
          return unit;
        }
  return {};
}

// The unit as a message should show it: "" is "no unit".
std::string in_quotes(const std::string_view unit)
{
  return unit.empty() ? "no unit" : "'" + std::string(unit) + "'";
}

} // namespace

std::optional<Unit> parse_unit(const std::string &text)
{
  const std::string_view all = text;
  Unit product;
  std::size_t at = 0;
  int sign = 1;
  bool factor_expected = true;
  while (at < all.size())
  {
    const char c = all[at];
    if (c == ' ' || c == '\t')
      ++at;
    else if (c == '*' || c == '/')
    {
      if (factor_expected)
        return {};
      sign = c == '/' ? -1 : 1;
      factor_expected = true;
      ++at;
    }
    else
    {
      const std::size_t length = std::min(all.find_first_of(" \t*/^", at), all.size()) - at;
      const std::optional<Unit> factor = single_unit(all.substr(at, length));
      if (!factor)
        return {};
      at += length;
      int exponent = 1;
      if (at < all.size() && all[at] == '^')
      {
        const auto [end, status] = std::from_chars(all.data() + at + 1, all.data() + all.size(), exponent);
        // Beyond a few no unit makes sense, and the powers of ten could overflow.
        if (status != std::errc() || std::abs(exponent) > 9)
          return {};
        at = static_cast<std::size_t>(end - all.data());
        if (at < all.size() && all.find_first_of(" \t*/", at) != at)
          return {};
      }
      exponent *= sign;
      for (std::size_t i = 0; i < product.dimension.size(); ++i)
        product.dimension[i] += exponent * factor->dimension[i];
      product.power += exponent * factor->power;
      product.factor *= std::pow(factor->factor, exponent);
      sign = 1;
      factor_expected = false;
      if (std::abs(product.power) > 100)
        return {};
    }
  }
  if (factor_expected)
    return {};
  return product;
}

std::string units_like(const std::string &unit)
{
  const std::optional<Unit> wanted = parse_unit(unit);
  for (const auto &family : usual_units)
    if (wanted && parse_unit(std::string(family[0]))->dimension == wanted->dimension)
    {
      std::string text = unit;
      for (const std::string_view &other : family)
        if (!other.empty() && other != unit)
          text += ", " + std::string(other);
      return text;
    }
  return unit + " and other units of that dimension";
}

ParsedNumber read_quantity(const std::string &text, const std::string &unit)
{
  ParsedNumber quantity;
  std::string_view rest = without_blanks(text);
  // A leading plus is common in data and unknown to from_chars.
  if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-' && rest[1] != '+')
    rest.remove_prefix(1);

  double plain = 0.;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), plain);
  if (status == std::errc::invalid_argument)
  {
    quantity.wrong = rest.empty() ? "empty" : "not a number";
    return quantity;
  }
  const std::string_view number = rest.substr(0, static_cast<std::size_t>(end - rest.data()));
  const std::string behind(without_blanks(rest.substr(number.size())));
  quantity.has_unit = !behind.empty();

  Unit given;
  if (quantity.has_unit)
  {
    const std::optional<Unit> parsed = parse_unit(behind);
    const char first = behind.front();
    const bool looks_like_unit = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') || first == '%' ||
                                 static_cast<unsigned char>(first) >= 0x80;
    if (!parsed || !looks_like_unit)
    {
      quantity.wrong = "a number followed by something that is no unit";
      return quantity;
    }
    given = *parsed;
    const std::optional<Unit> wanted = parse_unit(unit);
    if (!wanted || wanted->dimension != given.dimension)
    {
      quantity.wrong = "wrong unit: " + in_quotes(behind) + " where " +
                       (unit == "1" ? std::string("a pure number") : in_quotes(unit)) + " is wanted";
      return quantity;
    }
  }

  if (status == std::errc() && !std::isfinite(plain))
  {
    quantity.wrong = "not a finite number";
    return quantity;
  }

  // The power of ten is written into the digits, so that "0.625 mm" rounds once, as "0.000625" does.
  double value = plain;
  std::errc range = status;
  if (given.power != 0)
  {
    const std::size_t e = number.find_first_of("eE");
    long exponent = 0;
    if (e != std::string_view::npos)
    {
      const std::string digits(number.substr(e + 1));
      exponent = std::strtol(digits.c_str(), nullptr, 10); // saturates, and is then out of range below
      exponent = std::min(std::max(exponent, -1000000000L), 1000000000L);
    }
    const std::string shifted = std::string(number.substr(0, e)) + "e" + std::to_string(exponent + given.power);
    range = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value).ec;
  }
  value *= given.factor;
  if (range != std::errc() || !std::isfinite(value))
    quantity.wrong = "too large or too small for a double precision number";
  else
    quantity.value = value;
  return quantity;
}

} // namespace latcon::input
