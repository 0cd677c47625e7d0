// All invalid entries of a case are reported together, each with its line, the allowed values and the nearest key.
#include "tests/verification/input/sample_case.h"
#include "tests/verification/input/sentences.h"

#include <limits>

namespace parameter_problems_test
{

using namespace sample_case;

using Problem = testing::TestWithParam<sentences::Sentence>;

TEST_P(Problem, IsSaidInASentence)
{
  const auto &[kind, input, message] = GetParam();
  if (kind == "line")
    EXPECT_EQ(lattice_problem(input), message);
  else if (kind == "set")
    EXPECT_EQ(problem(good, {sentences::unescaped(input)}), message);
  else if (kind == "json")
    EXPECT_EQ(problem(R"({"Lattice": {"spacing": 1}, )" + input + "}", {}, "a.json"), message);
  else
    EXPECT_EQ(problem((kind == "+text" ? good : "") + sentences::unescaped(input)), message);
}

INSTANTIATE_TEST_SUITE_P(Sentences, Problem,
                         testing::ValuesIn(sentences::of({"line", "set", "json", "text", "+text"})));

TEST(Parameters, ValuesAtTheEndsOfTheirRangesAreRead)
{
  EXPECT_EQ(read(good, {"Run/steps=-2147483648"}).steps, std::numeric_limits<int>::min());
  EXPECT_TRUE(read(good, {"Fracture/stretches="}).stretches.empty());
  EXPECT_FALSE(read(good, {"Run/time step=auto"}).time_step);
  EXPECT_TRUE(problems("", {"Lattice/spacing=1"}).empty());
  EXPECT_EQ(problem(good, {"Lattice/rows=3", "Lattice/rows=4"}), "--set: Lattice/rows = 4: set twice, first to 3");
}

TEST(Parameters, NearestKeyIsOfTheSameSectionIfBothFit)
{
  double a = 1.;
  double b = 1.;
  Parameters p;
  p.add("First", "height", a, any_number, "m", "one");
  p.add("Second", "height", b, any_number, "m", "another");
  p.read_overrides({"Second/heigth=1", "Secnd/height=1"});
  const std::vector<std::string> all = problems_of(p);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], "--set: Second/heigth = 1: unknown key; nearest known key: Second/height; known in Second: height");
  EXPECT_EQ(all[1], "--set: Secnd/height = 1: unknown subsection 'Secnd'; nearest known key: Second/height; known: "
                    "First, Second");
}

TEST(Parameters, RangesHoldAtTheirEnds)
{
  EXPECT_TRUE(Above(0.).contains(5e-324));
  EXPECT_FALSE(Above(0.).contains(0.));
  EXPECT_TRUE(Range(0.).contains(0.));
  EXPECT_FALSE(Range(0.).contains(-5e-324));
  EXPECT_FALSE(Above(1.).contains(1.));
  EXPECT_TRUE(Range(1.).contains(1.));
  EXPECT_TRUE(Range(0., 1.).contains(0.));
  EXPECT_TRUE(Range(0., 1.).contains(1.));
  EXPECT_FALSE(Range(0., 1.).contains(1.0000000000000002));
  EXPECT_FALSE(Range({0., true}, {1., false}).contains(1.));
  EXPECT_FALSE(any_number.contains(std::numeric_limits<double>::quiet_NaN()));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Range({0., true}, {infinity, true}).contains(infinity));
  EXPECT_FALSE(any_number.contains(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ(any_number.text(), "");
  EXPECT_EQ(Range({0., false}, {1., true}).text(), "> 0 and <= 1");
  EXPECT_EQ(Range({0., true}, {1., false}).text(), ">= 0 and < 1");
}

TEST(Parameters, AllProblemsAreToldAtOnce)
{
  const std::vector<std::string> all = problems("subsection Lattice\n"
                                                "  set rows = 1\n"
                                                "  set lwa = linear\n"
                                                "  nonsense\n"
                                                "end\n"
                                                "subsection Rum\n"
                                                "end\n",
                                                {"Run/steps=x", "Run/seeed=1"});
  ASSERT_EQ(all.size(), 7u);
  const char *places[] = {
    "a.prm:2: ", "a.prm:3: ", "a.prm:4: ", "a.prm:6: ", "--set: ", "--set: ", "a.prm: Lattice/spacing"};
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i].find(places[i]), 0u) << all[i];
}

TEST(Parameters, EndlessProblemsAreCounted)
{
  std::string text = good;
  for (int i = 0; i < 10000; ++i)
    text += "nonsense\n";
  const std::vector<std::string> all = problems(text);
  ASSERT_EQ(all.size(), 51u);
  EXPECT_EQ(all[50], "... and 9950 more problems");
}

TEST(Parameters, ChecksOfSeveralEntriesNameWhereTheyWereSet)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(good, "a.prm");
  p.read_overrides({"Lattice/rows=4"});
  p.error("Lattice/spacing", "too wide", {"Lattice/rows", "Run/steps"});
  p.error("Lattice/rows", "too many");
  p.error("Run/steps", "too few");
  const std::vector<std::string> all = problems_of(p);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], "a.prm:2: Lattice/spacing = 1: too wide; with Lattice/rows = 4 (--set), Run/steps = 100 (default)");
  EXPECT_EQ(all[1], "--set: Lattice/rows = 4: too many");
  EXPECT_EQ(all[2], "default: Run/steps = 100: too few");
}

TEST(Parameters, ChecksOfWrongEntriesAreDropped)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text("subsection Lattice\nset rows = x\nend\n", "a.prm");
  p.error("Run/steps", "follows from the missing spacing", {"Lattice/spacing"});
  p.error("Run/steps", "follows from the wrong rows", {"Lattice/rows"});
  p.error("Lattice/rows", "follows from itself");
  EXPECT_EQ(problems_of(p).size(), 2u);
  EXPECT_EQ(sample.rows, 3u);
}

} // namespace parameter_problems_test
