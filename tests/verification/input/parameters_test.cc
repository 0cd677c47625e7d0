// Good input comes back bit for bit, and the resolved case says what it was.
#include "tests/verification/input/sample_case.h"

#include <cstring>
#include <limits>
#include <random>

namespace parameters_test
{

using namespace sample_case;

static Sample other_than_default()
{
  return {0.000625,
          0.5,
          -3,
          12,
          std::numeric_limits<std::uint64_t>::max(),
          true,
          "a = b, \xc3\xbc",
          Law::linear,
          Rule::behind_tip,
          {1.5, 2.5},
          5e-6,
          12.};
}

TEST(Parameters, FillsEveryKindOfEntry)
{
  const Sample sample = read("# a comment\n"
                             "subsection Lattice\n"
                             "  set spacing = 0.625 mm # and another\n"
                             "  set nearest neighbour area factor=0.5\n"
                             "\tset rows = +12\n"
                             "  set periodic = true\n"
                             "  set law = linear\n"
                             "  set density = 1.2 g/cm^2\n"
                             "end\n"
                             "SUBSECTION Fracture\n"
                             "  SET rule = behind-tip\n"
                             "  set stretches = 150 %, \\\n"
                             "                  250 %\n"
                             "END\n"
                             "subsection Run\n"
                             "  set steps = -3\n"
                             "  set seed = 18446744073709551615\n"
                             "  set title = a = b, \xc3\xbc\n"
                             "  set time step = 5 us\n"
                             "end\n");
  EXPECT_EQ(values(sample), values(other_than_default()));
}

TEST(Parameters, AnyLineEndsAndNoneAtTheEnd)
{
  EXPECT_EQ(read("subsection Lattice\r\nset spacing = 2\r\nend").spacing, 2.);
  EXPECT_EQ(read("# a comment must not swallow the file\rsubsection Lattice\rset spacing = 2\rend").spacing, 2.);
  EXPECT_EQ(read("\xef\xbb\xbfsubsection Lattice\nset spacing = 2\nend").spacing, 2.);
}

TEST(Parameters, MisuseByTheProgramIsALogicError)
{
  double x = 1.;
  Rule rule = Rule::retraction;
  EXPECT_FALSE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(0.), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("", "x", x, Above(0.), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x/y", x, Above(0.), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(0.), "mm", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(0.), "deg", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(0.), "foot", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(1.), "m", "x"); }));
  EXPECT_FALSE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(1.), "m", "x", Presence::required); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "s", rule, {{"b", Rule::none}}, "s"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.error("A/x", "not declared"); }));
  EXPECT_TRUE(is_misuse(
    [&](Parameters &p)
    {
      p.add("A", "x", x, Above(0.), "m", "x");
      p.add("A", "x", x, Above(0.), "m", "x");
    }));
}

TEST(Parameters, ResolvedCaseReadsBackBitForBit)
{
  std::mt19937_64 random(3);
  const auto number = [&random]
  {
    for (;;)
    {
      const std::uint64_t pattern = random() & 0x7fffffffffffffffULL;
      double value = 0.;
      std::memcpy(&value, &pattern, sizeof(value));
      if (Above(0.).contains(value))
        return value;
    }
  };
  for (int i = 0; i < 200; ++i)
  {
    Sample written;
    written.spacing = number();
    written.area_factor = static_cast<double>(random() % 1000003) / 1000003.;
    written.steps = static_cast<int>(random());
    written.rows = 2 + static_cast<unsigned int>(random() % 1000);
    written.seed = random();
    written.periodic = random() % 2 == 0;
    written.title = i % 3 == 0 ? "" : "title \xc3\xbc = \\ \"" + std::to_string(i);
    written.law = random() % 2 == 0 ? Law::linear : Law::mooney_rivlin;
    written.rule = random() % 2 == 0 ? Rule::retraction : Rule::behind_tip;
    written.stretches.assign(random() % 4, number());
    written.time_step = number();
    if (i % 2 == 0)
      written.time_step.reset();
    written.density = 5e-324;
    Parameters p;
    written.declare(p);
    const std::string text = p.resolved_text();
    const Sample back = read(text);
    EXPECT_EQ(values(back), values(written));
    EXPECT_EQ(lines_of(text), p.lines());
  }
}

TEST(Parameters, ResolvedCaseIsDocumentedAndInSI)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text("subsection Lattice\n set spacing = 0.7 mm\nend\n", "a.prm");
  p.finish();
  const std::string text = p.resolved_text();
  EXPECT_NE(text.find("set spacing"), std::string::npos);
  EXPECT_NE(text.find("= 7e-04"), std::string::npos) << text;
  EXPECT_NE(text.find("# Distance d of nearest sites [m] (> 0; required)"), std::string::npos) << text;
  EXPECT_EQ(text.find("# default"), std::string::npos) << "a required entry has none, the others are at theirs";
  EXPECT_LT(text.find("subsection Lattice"), text.find("subsection Fracture")) << "not in the order of declaration";
}

TEST(Parameters, LinesDoNotDependOnHowTheCaseIsWritten)
{
  const std::string original = lines_of(good, {"Lattice/rows=4", "Run/steps=5"});
  EXPECT_EQ(lines_of("subsection Run # first\n  set steps=5\nend\n\nsubsection Lattice\nset rows = 4\nend\n"
                     "subsection Lattice\nset spacing = 100 cm\nend"),
            original);
  EXPECT_EQ(lines_of(R"({"Run": {"steps": 5}, "Lattice": {"rows": 4, "spacing": 1.0}})", {}, "a.json"), original);
  EXPECT_EQ(lines_of(good, {"Lattice/rows=4", "Run/steps=5", "Run/seed=7"}), original) << "a default written out";
  // Hashes of the lines are kept in files, so they must never change.
  double x = 0.5, y = 2.;
  Parameters p;
  p.add("A", "x", x, any_number, "1", "x");
  p.add("B", "y", y, any_number, "m", "y");
  EXPECT_EQ(p.lines(), "A/x = 0.5\nB/y = 2\n");
  EXPECT_EQ(p.lines("A"), "B/y = 2\n");
}

TEST(Parameters, JsonFillsEveryKindOfEntry)
{
  const Sample sample = read(R"({
    // comments are allowed
    "Lattice": {"spacing": "0.625 mm", "nearest neighbour area factor": 0.5, "rows": 12, "periodic": true,
                "law": "linear", "density": 1e1},
    "Fracture": {"rule": "behind-tip", "stretches": [1.5, 0.30000000000000004, "7"]},
    "Run": {"steps": -3, "seed": 18446744073709551615, "title": "x", "time step": "auto"}
  })",
                             {"Run/title=y"}, "a.json");
  Sample expected = other_than_default();
  expected.title = "y";
  expected.stretches = {1.5, 0.30000000000000004, 7.};
  expected.time_step = {};
  expected.density = 10.;
  EXPECT_EQ(values(sample), values(expected));
}

} // namespace parameters_test
