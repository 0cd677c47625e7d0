// Units are converted exactly where they are decimal, and refused where their dimension is wrong.
#include "verification/input/units.h"

#include "tests/verification/input/sentences.h"

#include <cstdlib>

namespace units_test
{

using namespace latcon;

TEST(Units, AreConvertedOrRefused)
{
  for (const sentences::Sentence &own : sentences::of({"quantity"}))
  {
    const std::size_t colon = own.input.find(": ");
    const input::ParsedNumber found =
      input::read_quantity(sentences::unescaped(own.input.substr(colon + 2)), own.input.substr(0, colon));
    const bool has_value = own.message[0] == '=';
    EXPECT_EQ(found.wrong, has_value ? "" : own.message) << own;
    if (has_value)
    {
      EXPECT_EQ(found.value, std::strtod(own.message.c_str() + 1, nullptr)) << own;
    }
  }
  EXPECT_EQ(input::read_quantity("1 \xff", "m").wrong, "a number followed by something that is no unit");
  EXPECT_EQ(input::read_quantity("\xff", "m").wrong, "not a number");
}

} // namespace units_test
