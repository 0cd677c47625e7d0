// All invalid entries of a case are reported together, each with its line, the allowed values and the nearest key.
#include "tests/verification/input/sample_case.h"

#include <limits>

namespace parameter_problems_test
{

using namespace sample_case;

TEST(Parameters, UnknownKeyNamesTheNearestAndAllOfItsSection)
{
  EXPECT_EQ(
    lattice_problem("set nearest neigbour area factor = 0.5"),
    "a.prm:3: Lattice/nearest neigbour area factor = 0.5: unknown key; nearest known key: Lattice/nearest "
    "neighbour area factor; known in Lattice: spacing, nearest neighbour area factor, rows, periodic, law, density");
  // Two swapped letters, then capitals, then a part of the name, then the right name in the wrong section.
  EXPECT_NE(lattice_problem("set rosw = 3").find("nearest known key: Lattice/rows;"), std::string::npos);
  EXPECT_NE(lattice_problem("set ROWS = 3").find("nearest known key: Lattice/rows;"), std::string::npos);
  EXPECT_NE(lattice_problem("set area factor = 3").find("nearest known key: Lattice/nearest neighbour area factor;"),
            std::string::npos);
  EXPECT_NE(lattice_problem("set seed = 3").find("nearest known key: Run/seed;"), std::string::npos);
  EXPECT_EQ(lattice_problem("set quite something else = 3").find("nearest known key"), std::string::npos);
}

TEST(Parameters, NearestKeyIsOfTheSameSectionIfBothFit)
{
  double a = 1.;
  double b = 1.;
  Parameters p;
  p.add("First", "height", a, Any(), "m", "one");
  p.add("Second", "height", b, Any(), "m", "another");
  p.read_overrides({"Second/heigth=1", "Secnd/height=1"});
  const std::vector<std::string> all = problems_of(p);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], "--set: Second/heigth = 1: unknown key; nearest known key: Second/height; known in Second: height");
  EXPECT_EQ(all[1], "--set: Secnd/height = 1: unknown subsection 'Secnd'; nearest known key: Second/height; known: "
                    "First, Second");
}

TEST(Parameters, UnknownSectionIsToldOnceWithTheNearest)
{
  EXPECT_EQ(problem(good + "subsection Fractrue\n  set rule = none\n  set more = 1\nend\n"),
            "a.prm:4: unknown subsection 'Fractrue'; nearest: Fracture; known: Lattice, Fracture, Run");
}

TEST(Parameters, WrongNumbersAreToldWithWhatIsAllowed)
{
  const std::string allowed = "; allowed: a number > 0 in m, nm, um, mm, cm, km";
  const auto spacing = [](const std::string &value)
  { return problem("subsection Lattice\nset spacing = " + value + "\nend"); };
  const std::string start = "a.prm:2: Lattice/spacing = ";
  EXPECT_EQ(spacing("abc"), start + "abc: not a number" + allowed);
  EXPECT_EQ(spacing(""), start + ": empty" + allowed);
  EXPECT_EQ(spacing("3 kg"), start + "3 kg: wrong unit: 'kg' where 'm' is wanted" + allowed);
  EXPECT_EQ(spacing("1 parsec"), start + "1 parsec: a number followed by something that is no unit" + allowed);
  EXPECT_EQ(spacing("1\u00a0m\u200b"),
            start + "1\\xc2\\xa0m\\xe2\\x80\\x8b: a number followed by something that is no unit" + allowed);
  EXPECT_EQ(spacing("1 2"), start + "1 2: a number followed by something that is no unit" + allowed);
  EXPECT_EQ(spacing("0"), start + "0: out of range" + allowed);
  EXPECT_EQ(spacing("-1 mm"), start + "-1 mm: out of range" + allowed);
  EXPECT_EQ(spacing("nan"), start + "nan: not a finite number" + allowed);
  EXPECT_EQ(spacing("inf"), start + "inf: not a finite number" + allowed);
  EXPECT_EQ(spacing("1e400"), start + "1e400: too large or too small for a double precision number" + allowed);
}

TEST(Parameters, RangesHoldAtTheirEnds)
{
  EXPECT_TRUE(Positive().contains(5e-324));
  EXPECT_FALSE(Positive().contains(0.));
  EXPECT_TRUE(NonNegative().contains(0.));
  EXPECT_FALSE(NonNegative().contains(-5e-324));
  EXPECT_FALSE(Above(1.).contains(1.));
  EXPECT_TRUE(AtLeast(1.).contains(1.));
  EXPECT_TRUE(Between(0., 1.).contains(0.));
  EXPECT_TRUE(Between(0., 1.).contains(1.));
  EXPECT_FALSE(Between(0., 1.).contains(1.0000000000000002));
  EXPECT_FALSE(Range({0., true}, {1., false}).contains(1.));
  EXPECT_FALSE(Any().contains(std::numeric_limits<double>::quiet_NaN()));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Range({0., true}, {infinity, true}).contains(infinity));
  EXPECT_FALSE(Any().contains(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ(Any().text(), "");
  EXPECT_EQ(Range({0., false}, {1., true}).text(), "> 0 and <= 1");
  EXPECT_EQ(Range({0., true}, {1., false}).text(), ">= 0 and < 1");
}

TEST(Parameters, WrongWholeNumbersAreTold)
{
  const std::string allowed = "; allowed: a whole number >= 2 and <= 4294967295";
  EXPECT_EQ(lattice_problem("set rows = 2.5"), "a.prm:3: Lattice/rows = 2.5: not a whole number" + allowed);
  EXPECT_EQ(lattice_problem("set rows = 1e3"), "a.prm:3: Lattice/rows = 1e3: not a whole number" + allowed);
  EXPECT_EQ(lattice_problem("set rows = 3 m"), "a.prm:3: Lattice/rows = 3 m: not a whole number" + allowed);
  EXPECT_EQ(lattice_problem("set rows = -"), "a.prm:3: Lattice/rows = -: not a whole number" + allowed);
  EXPECT_EQ(lattice_problem("set rows ="), "a.prm:3: Lattice/rows = : empty" + allowed);
  EXPECT_EQ(lattice_problem("set rows = 1"), "a.prm:3: Lattice/rows = 1: out of range" + allowed);
  EXPECT_EQ(lattice_problem("set rows = -5"), "a.prm:3: Lattice/rows = -5: beyond 0 to 4294967295" + allowed);
  EXPECT_EQ(lattice_problem("set rows = 4294967296"),
            "a.prm:3: Lattice/rows = 4294967296: beyond 0 to 4294967295" + allowed);
  EXPECT_EQ(problem(good, {"Run/steps=2147483648"}),
            "--set: Run/steps = 2147483648: beyond -2147483648 to 2147483647; allowed: a whole number");
  EXPECT_NE(problem(good, {"Run/seed=18446744073709551616"}).find("beyond 0 to 18446744073709551615"),
            std::string::npos);
  EXPECT_EQ(read(good, {"Run/steps=-2147483648"}).steps, std::numeric_limits<int>::min());
}

TEST(Parameters, WrongWordsAreToldWithTheNearest)
{
  EXPECT_EQ(lattice_problem("set periodic = yes"),
            "a.prm:3: Lattice/periodic = yes: not a word known here; allowed: one of false, true");
  EXPECT_EQ(lattice_problem("set law = Moony-Rivlin"),
            "a.prm:3: Lattice/law = Moony-Rivlin: not a word known here (perhaps "
            "mooney-rivlin); allowed: one of mooney-rivlin, linear");
  EXPECT_EQ(
    problem(good, {"Fracture/rule=behind tip"}),
    "--set: Fracture/rule = behind tip: not a word known here (perhaps behind-tip); allowed: one of none, behind-tip, "
    "retraction");
}

TEST(Parameters, WrongListsNameTheNumber)
{
  const std::string allowed = "; allowed: numbers separated by commas, each > 0";
  const auto stretches = [](const std::string &value) { return problem(good, {"Fracture/stretches=" + value}); };
  const std::string start = "--set: Fracture/stretches = ";
  EXPECT_EQ(stretches("1, x, 3"), start + "1, x, 3: number 2 in the list: not a number" + allowed);
  EXPECT_EQ(stretches("1, 2, 0"), start + "1, 2, 0: number 3 in the list: out of range" + allowed);
  EXPECT_EQ(stretches("1,,2"), start + "1,,2: number 2 in the list: empty" + allowed);
  EXPECT_EQ(stretches("1,"), start + "1,: number 2 in the list: empty" + allowed);
  EXPECT_TRUE(read(good, {"Fracture/stretches="}).stretches.empty());
}

TEST(Parameters, AutoIsAWordForNoNumber)
{
  EXPECT_FALSE(read(good, {"Run/time step=auto"}).time_step);
  EXPECT_EQ(problem(good, {"Run/time step=automatic"}),
            "--set: Run/time step = automatic: not a number; allowed: auto, or a number > 0 in s, us, ms, min, h");
}

TEST(Parameters, KeySetTwiceNamesBothPlaces)
{
  EXPECT_EQ(problem("subsection Lattice\n set spacing = 1\n set spacing = 2\nend\n"),
            "a.prm:3: Lattice/spacing = 2: set twice, first at a.prm:2 to 1");
  EXPECT_EQ(problem(good + good), "a.prm:5: Lattice/spacing = 1: set twice, first at a.prm:2 to 1");
  EXPECT_EQ(problem(good, {"Lattice/rows=3", "Lattice/rows=4"}), "--set: Lattice/rows = 4: set twice, first to 3");
}

TEST(Parameters, MissingRequiredEntryIsExplained)
{
  const std::string expected =
    ": Lattice/spacing: required, but not set; allowed: a number > 0 in m, nm, um, mm, cm, km; "
    "it is: Distance d of nearest sites";
  EXPECT_EQ(problem(""), "a.prm" + expected);
  EXPECT_EQ(problem("# nothing\n\n  \t\n"), "a.prm" + expected);
  EXPECT_TRUE(problems("", {"Lattice/spacing=1"}).empty());
}

TEST(Parameters, LinesAreCountedWithAnyLineEnds)
{
  for (const std::string end : {"\n", "\r\n", "\r"})
    EXPECT_EQ(problem("subsection Lattice" + end + end + "set spacing = 1" + end + "set rows = 1" + end + "end" + end),
              "a.prm:4: Lattice/rows = 1: out of range; allowed: a whole number >= 2 and <= 4294967295");
}

TEST(Parameters, WhatIsNoTextIsOneProblem)
{
  const std::vector<std::string> all = problems(good + std::string("x\0\ny\nz\n", 7));
  ASSERT_EQ(all.size(), 2u); // and nothing is read, so the required entry is missing
  EXPECT_EQ(all[0], "a.prm:4: not a text file: it holds zero bytes");
}

TEST(Parameters, CommentsBeginAfterABlank)
{
  EXPECT_EQ(problem("subsection Lattice\n  set spacing = 1.#QNAN\nend\n"),
            "a.prm:2: '#' begins a comment and needs a blank before it");
  EXPECT_EQ(lattice_problem("set rows = 3# of them"), "a.prm:3: '#' begins a comment and needs a blank before it");
}

TEST(Parameters, WholeNumbersWithoutASignEndWhereTheProgramStops)
{
  unsigned int steps = 0;
  Parameters p;
  p.add("A", "steps", steps, AtLeast(0.), "steps");
  p.read_overrides({"A/steps=4294967296"});
  const std::vector<std::string> all = problems_of(p);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NE(all[0].find("allowed: a whole number >= 0 and <= 4294967295"), std::string::npos) << all[0];
}

TEST(Parameters, NothingIsReadFromNestedSections)
{
  EXPECT_EQ(problem("subsection Lattice\n set spacing = 1\n subsection Run\n  set steps = x\n end\nend\n"),
            "a.prm:3: subsection 'Run' lies inside of 'Lattice', which begins on line 1; subsections do not nest here");
}

TEST(Parameters, RequiredTextsAndListsMustNotBeEmpty)
{
  std::string text;
  std::vector<double> list;
  Parameters p;
  p.add("A", "text", text, "a text", Presence::required);
  p.add("A", "list", list, Any(), "m", "a list", Presence::required);
  p.read_overrides({"A/text=", "A/list= "});
  const std::vector<std::string> all = problems_of(p);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], "--set: A/text = : empty; allowed: a text on one line");
  EXPECT_EQ(all[1].find("--set: A/list = : empty"), 0u);
}

TEST(Parameters, UnbalancedSectionsAreToldWithTheirLines)
{
  EXPECT_EQ(problem("subsection Lattice\n set spacing = 1\n"), "a.prm:1: subsection 'Lattice' has no 'end'");
  EXPECT_EQ(problem(good + "\nend\n"), "a.prm:5: 'end' without a 'subsection' that it could end");
  EXPECT_EQ(problem("subsection Lattice\n set spacing = 1\nsubsection Run\n set steps = 2\nend\n"),
            "a.prm:3: subsection 'Run' begins, but an 'end' is missing for 'Lattice', which begins on line 1");
  EXPECT_EQ(
    problem("subsection Lattice\n set spacing = 1\n subsection Deep\n  set x = 1\n  subsection Deeper\n  end\n "
            "end\nend\n"),
    "a.prm:3: subsection 'Deep' lies inside of 'Lattice', which begins on line 1; subsections do not nest here");
  EXPECT_EQ(problem("subsection Lattice\n set spacing = 1\nend now\n"),
            "a.prm:3: 'end' followed by 'now'; it stands alone on its line");
  EXPECT_EQ(problem(good + "subsection\nend\n"), "a.prm:4: unknown subsection ''; known: Lattice, Fracture, Run");
}

TEST(Parameters, LinesThatAreNotUnderstoodAreTold)
{
  const std::string allowed = "'; allowed: subsection NAME, set NAME = VALUE, end, # comment";
  EXPECT_EQ(lattice_problem("spacing = 3"), "a.prm:3: not understood: 'spacing = 3" + allowed);
  EXPECT_EQ(lattice_problem("settings = 3"), "a.prm:3: not understood: 'settings = 3" + allowed);
  EXPECT_EQ(lattice_problem("Set rows = 3"), "a.prm:3: not understood: 'Set rows = 3" + allowed);
  EXPECT_EQ(lattice_problem("set rows 3"), "a.prm:3: 'set rows 3' has no '='; allowed: set name = value");
  EXPECT_EQ(lattice_problem("include other.prm"), "a.prm:3: 'include' is not supported; a case is one file");
  EXPECT_EQ(problem("set spacing = 1\n" + good),
            "a.prm:1: spacing = 1: outside of any subsection; nearest known key: Lattice/spacing");
  EXPECT_EQ(lattice_problem("# comment \\"), "a.prm:3: a comment must not end in '\\', which continues a line");
}

TEST(Parameters, OverridesThatAreNotUnderstoodAreTold)
{
  for (const std::string text : {"Lattice/spacing", "", "=", "/", "nothing=1"})
    EXPECT_EQ(problem(good, {text}), "--set: not understood: '" + text + "'; allowed: --set Section/Name=value");
  for (const std::string text : {"spacing=1", "spacing=1/2", "spacin=1"})
    EXPECT_EQ(problem(good, {text}), "--set: not understood: '" + text +
                                       "'; nearest known key: Lattice/spacing; allowed: --set Section/Name=value");
  EXPECT_EQ(problem(good, {"Run/title=a#b"}),
            "--set: Run/title = a#b: '#' begins a comment; allowed: a text on one line");
  EXPECT_EQ(
    problem(good, {"Run/title=a\nb"}),
    "--set: Run/title = a\\x0ab: control characters and line breaks are not allowed; allowed: a text on one line");
  EXPECT_EQ(problem(good, {"Run/title=a\\"}),
            "--set: Run/title = a\\: '\\' at the end would continue the line; allowed: a text on one line");
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
