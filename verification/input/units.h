/// Units of measurement: parsing of "0.625 mm" where metres are expected.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace latcon::input
{

/// Unit of measurement in terms of SI units: factor * 10^power m^dimension[0] kg^dimension[1] s^dimension[2]
/// rad^dimension[3]. The power of ten is kept apart so that decimal prefixes cost no rounding. Angles have a dimension
/// of their own here, so that degrees are not taken for a pure number.
struct Unit
{
  std::array<int, 4> dimension{}; ///< exponents of metre, kilogram, second, radian
  int power = 0;                  ///< of ten
  double factor = 1.;             ///< for units that are no power of ten of the SI unit: degree, minute, hour
};

/// Parses products and quotients of m, g, s, min, h, rad, deg, N, Pa, bar, J, W, Hz, 1 and %, with prefixes n u m
/// c d k M G where they are usual, and exponents: "mm", "kg/m^3", "N s/m", "N*s/m", "m s^-1". A quotient divides by one
/// factor only.
/// @return nothing if the text is not a unit
[[nodiscard]] std::optional<Unit> parse_unit(const std::string &text);

/// Units of the same dimension, for a message: for "m" it is "m, nm, um, mm, cm, km".
[[nodiscard]] std::string units_like(const std::string &unit);

/// Result of reading a number with a unit.
struct ParsedNumber
{
  double value = 0.;     ///< in the requested SI unit
  bool has_unit = false; ///< whether the text had a unit
  std::string wrong;     ///< error in the text; `value` is valid only if this is empty
};

/// Reads a finite number, followed by a unit or not.
/// @param text the number, e.g. "0.625 mm", "1e-3", "0.1MPa"; a plain number is in `unit`
/// @param unit the expected SI unit, which parse_unit() gives power 0 and factor 1
[[nodiscard]] ParsedNumber read_quantity(const std::string &text, const std::string &unit);

} // namespace latcon::input
