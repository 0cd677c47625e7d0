// Units are converted exactly where they are decimal, and refused where their dimension is wrong.
#include "verification/input/units.h"

#include <gtest/gtest.h>

#include <string>

namespace units_test
{

using namespace latcon;
using input::parse_unit;
using input::ParsedNumber;
using input::read_quantity;

double read(const std::string &text, const std::string &unit)
{
  const ParsedNumber quantity = read_quantity(text, unit);
  EXPECT_EQ(quantity.wrong, "") << text;
  return quantity.value;
}

std::string wrong(const std::string &text, const std::string &unit)
{
  return read_quantity(text, unit).wrong;
}

TEST(Units, PlainNumberIsInTheUnitWanted)
{
  EXPECT_EQ(read("0.000625", "m"), 0.000625);
  EXPECT_EQ(read("  +1.5e3\t", "kg/m^3"), 1500.);
  EXPECT_EQ(read("-.5", "1"), -0.5);
  EXPECT_EQ(read("5.", "1"), 5.);
}

TEST(Units, DecimalPrefixesCostNoRounding)
{
  EXPECT_EQ(read("0.625 mm", "m"), 0.000625);
  EXPECT_EQ(read("0.7mm", "m"), 0.0007); // 0.7 * 1e-3 is another number
  EXPECT_EQ(read("15 cm", "m"), 0.15);
  EXPECT_EQ(read("0.1 MPa", "Pa"), 1e5);
  EXPECT_EQ(read("5.56 ms", "s"), 0.00556);
  EXPECT_EQ(read("1.1e1 um", "m"), 1.1e-5);
  EXPECT_EQ(read("3 \xc2\xb5m", "m"), 3e-6);
  EXPECT_EQ(read("3 \xce\xbcm", "m"), 3e-6);
  EXPECT_EQ(read("1e-320 km", "m"), 1e-317);
}

TEST(Units, ProductsAndQuotients)
{
  EXPECT_EQ(read("1.2 g/cm^3", "kg/m^3"), 1200.);
  EXPECT_EQ(read("3 N/mm^2", "Pa"), 3e6);
  EXPECT_EQ(read("2 kJ/m^2", "J/m^2"), 2000.);
  EXPECT_EQ(read("2 N/m", "J/m^2"), 2.);
  EXPECT_EQ(read("7 m s^-1", "m/s"), 7.);
  EXPECT_EQ(read("7 m*s^-1", "m/s"), 7.);
  EXPECT_EQ(read("4 mN s/mm", "N s/m"), 4.);
  EXPECT_EQ(read("4 N/m s", "N s/m"), 4.); // a quotient divides by one factor only
  EXPECT_EQ(read("36 km/h", "m/s"), 10.);
  EXPECT_EQ(read("2 MHz", "1/s"), 2e6);
  EXPECT_EQ(read("30 deg", "rad"), 30. * (3.14159265358979323846 / 180.));
  EXPECT_EQ(read("5 %", "1"), 0.05);
  EXPECT_EQ(read("2 min", "s"), 120.);
  EXPECT_EQ(read("1 kg m/s^2", "N"), 1.);
}

TEST(Units, WrongDimensionNamesBothUnits)
{
  EXPECT_EQ(wrong("3 kg", "m"), "wrong unit: 'kg' where 'm' is wanted");
  EXPECT_EQ(wrong("3 m", "1"), "wrong unit: 'm' where a pure number is wanted");
  EXPECT_EQ(wrong("3 deg", "1"), "wrong unit: 'deg' where a pure number is wanted");
  EXPECT_EQ(wrong("3 m^2", "m"), "wrong unit: 'm^2' where 'm' is wanted");
}

TEST(Units, WhatIsNoUnitIsRefused)
{
  const std::string no_unit = "a number followed by something that is no unit";
  for (const std::string text :
       {"1 parsec", "1 2",    "1,5",     "1 mm x", "1 mm^",  "1 mm^x",          "1 m//s", "1 m/", "1 /m",
        "1 kkg",    "1 mmin", "1 1",     "1 m^10", "1 m^99", "1 m^99999999999", "0x10",   "1d5",  "1e",
        "1 m(s)",   "1 MM",   "1 m^2^2", "1 m^2s", "1;",     "1 \xff"})
    EXPECT_EQ(wrong(text, "m"), no_unit) << text;
}

TEST(Units, WhatIsNoNumberIsRefused)
{
  EXPECT_EQ(wrong("", "m"), "empty");
  for (const std::string text : {"mm", "- 1", "+-1", "--1", "++1", "+", "-", "e5", ".", "abc", "\xff"})
    EXPECT_EQ(wrong(text, "m"), "not a number") << text;
  for (const std::string text : {"nan", "-nan", "inf", "-inf", "infinity", "nan(1)"})
    EXPECT_EQ(wrong(text, "m"), "not a finite number") << text;
}

TEST(Units, OverflowIsRefused)
{
  const std::string overflow = "too large or too small for a double precision number";
  for (const std::string text : {"1e999", "-1e999", "1e-999", "1e308 km", "1e308 h", "1e99999999999999999999 mm"})
    EXPECT_EQ(wrong(text, text.find('h') == std::string::npos ? "m" : "s"), overflow) << text;
  EXPECT_EQ(read("1e310 mm", "m"), 1e307); // only its digits are beyond, not what it means
  EXPECT_EQ(read("0e999", "m"), 0.);
}

} // namespace units_test
