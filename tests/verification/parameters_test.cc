// Every wrong input is told with its place, all at once; every good one comes back bit for bit.
#include "temporary_folder.h"

#include "verification/errors.h"
#include "verification/parameters.h"

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

using namespace verification;

namespace
{

enum class Rule
{
  none,
  behind_tip,
  retraction
};

// A case with one entry of each kind; `spacing` is required.
struct Sample
{
  double spacing = 0.;
  double area_factor = 0.6667;
  int steps = 100;
  unsigned int rows = 3;
  std::uint64_t seed = 7;
  bool periodic = false;
  std::string title = "sample";
  std::string law = "mooney-rivlin";
  Rule rule = Rule::none;
  std::vector<double> stretches = {1., 2.};
  std::optional<double> time_step;
  double density = 1.;

  void declare(Parameters &p)
  {
    p.add("Lattice", "spacing", spacing, Positive(), "m", "Distance d of nearest sites", Presence::required);
    p.add("Lattice", "nearest neighbour area factor", area_factor, Between(0., 1.), "1", "Share s of the area");
    p.add("Lattice", "rows", rows, AtLeast(2), "Rows of sites");
    p.add("Lattice", "periodic", periodic, "Whether the ends are joined");
    p.add("Lattice", "law", law, {"mooney-rivlin", "linear"}, "Law of the bonds");
    p.add("Lattice", "density", density, Positive(), "kg/m^2", "Mass per area");
    p.add("Fracture", "rule", rule,
          {{"none", Rule::none}, {"behind-tip", Rule::behind_tip}, {"retraction", Rule::retraction}},
          "Toughening rule");
    p.add("Fracture", "stretches", stretches, Above(0.), "1", "Stretches to visit");
    p.add("Run", "steps", steps, Any(), "Number of steps");
    p.add("Run", "seed", seed, Any(), "Seed of the noise");
    p.add("Run", "title", title, "Title of the output");
    p.add("Run", "time step", time_step, Positive(), "s", "Time step");
  }
};

const std::string good = "subsection Lattice\n  set spacing = 1\nend\n";

std::vector<std::string> problems_of(Parameters &p)
{
  try
  {
    p.finish();
  }
  catch (const InputError &error)
  {
    EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
    return error.problems();
  }
  return {};
}

// What is wrong with a case.
std::vector<std::string> problems(const std::string &text, const std::vector<std::string> &overrides = {},
                                  const std::string &name = "a.prm")
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(text, name);
  p.read_overrides(overrides);
  return problems_of(p);
}

std::string problem(const std::string &text, const std::vector<std::string> &overrides = {},
                    const std::string &name = "a.prm")
{
  const std::vector<std::string> all = problems(text, overrides, name);
  EXPECT_EQ(all.size(), 1u) << text << "\n" << (all.empty() ? "no problem" : InputError(all).what());
  return all.size() == 1 ? all[0] : "";
}

// The one problem of a case whose Lattice section is good but for a further line, which is line 3.
std::string lattice_problem(const std::string &line)
{
  return problem("subsection Lattice\n  set spacing = 1\n  " + line + "\nend\n");
}

Sample read(const std::string &text, const std::vector<std::string> &overrides = {}, const std::string &name = "a.prm")
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(text, name);
  p.read_overrides(overrides);
  p.finish();
  return sample;
}

std::uint64_t hash_of(const std::string &text, const std::vector<std::string> &overrides = {},
                      const std::string &name = "a.prm")
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(text, name);
  p.read_overrides(overrides);
  p.finish();
  return p.hash();
}

bool same_bits(const double a, const double b)
{
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

// Whether the parameters can be set up as in `declaration`, or the program is told of its mistake.
template <typename Declaration>
bool is_misuse(const Declaration &declaration)
{
  Parameters p;
  try
  {
    declaration(p);
  }
  catch (const std::logic_error &)
  {
    return true;
  }
  return false;
}

} // namespace

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
  EXPECT_EQ(sample.spacing, 0.000625);
  EXPECT_EQ(sample.area_factor, 0.5);
  EXPECT_EQ(sample.rows, 12u);
  EXPECT_TRUE(sample.periodic);
  EXPECT_EQ(sample.law, "linear");
  EXPECT_EQ(sample.density, 12.);
  EXPECT_EQ(sample.rule, Rule::behind_tip);
  EXPECT_EQ(sample.steps, -3);
  EXPECT_EQ(sample.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(sample.title, "a = b, \xc3\xbc");
  EXPECT_EQ(sample.time_step, 5e-6);
}

TEST(Parameters, MixedUnitsInAListAreRefused)
{
  EXPECT_EQ(problem(good + "subsection Fracture\n set stretches = 1.5, 250 %\nend\n"),
            "a.prm:5: Fracture/stretches = 1.5, 250 %: some numbers have a unit and some have none; give it to all of "
            "them or to none; allowed: numbers separated by commas, each > 0");
}

TEST(Parameters, DefaultsStayWhereNothingIsSet)
{
  const Sample sample = read(good);
  EXPECT_EQ(sample.spacing, 1.);
  EXPECT_EQ(sample.area_factor, 0.6667);
  EXPECT_EQ(sample.title, "sample");
  EXPECT_EQ(sample.stretches, (std::vector<double>{1., 2.}));
  EXPECT_FALSE(sample.time_step);
}

TEST(Parameters, OverridesWinOverTheFile)
{
  const Sample sample = read(good, {"Lattice/spacing=2 cm", " Run / title = x=y ", "Fracture/rule=retraction"});
  EXPECT_EQ(sample.spacing, 0.02);
  EXPECT_EQ(sample.title, "x=y");
  EXPECT_EQ(sample.rule, Rule::retraction);
}

TEST(Parameters, AnyLineEndsAndNoneAtTheEnd)
{
  EXPECT_EQ(read("subsection Lattice\r\nset spacing = 2\r\nend").spacing, 2.);
  EXPECT_EQ(read("# a comment must not swallow the file\rsubsection Lattice\rset spacing = 2\rend").spacing, 2.);
  EXPECT_EQ(read("\xef\xbb\xbfsubsection Lattice\nset spacing = 2\nend").spacing, 2.);
}

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
  const std::string allowed = "; allowed: a whole number >= 2";
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
              "a.prm:4: Lattice/rows = 1: out of range; allowed: a whole number >= 2");
}

TEST(Parameters, WhatIsNoTextIsOneProblem)
{
  const std::vector<std::string> all = problems(good + std::string("x\0\ny\nz\n", 7));
  ASSERT_EQ(all.size(), 2u); // and nothing is read, so the required entry is missing
  EXPECT_EQ(all[0], "a.prm:4: not a text file: it holds zero bytes");
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
  for (const std::string text : {"spacing=1", "Lattice/spacing", "", "=", "/", "spacing=1/2"})
    EXPECT_EQ(problem(good, {text}), "--set: not understood: '" + text + "'; allowed: --set Section/Name=value");
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

TEST(Parameters, KnowsWhatWasSet)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(good, "a.prm");
  p.read_overrides({"Run/steps=100"});
  EXPECT_TRUE(p.is_set("Lattice/spacing"));
  EXPECT_TRUE(p.is_set("Run/steps"));
  EXPECT_FALSE(p.is_set("Lattice/rows"));
}

TEST(Parameters, MisuseByTheProgramIsALogicError)
{
  double x = 1.;
  std::string s = "a";
  EXPECT_FALSE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Positive(), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("", "x", x, Positive(), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x/y", x, Positive(), "m", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Positive(), "mm", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Positive(), "deg", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Positive(), "foot", "x"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(1.), "m", "x"); }));
  EXPECT_FALSE(is_misuse([&](Parameters &p) { p.add("A", "x", x, Above(1.), "m", "x", Presence::required); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.add("A", "s", s, {"b", "c"}, "s"); }));
  EXPECT_TRUE(is_misuse([&](Parameters &p) { p.error("A/x", "not declared"); }));
  EXPECT_TRUE(is_misuse(
    [&](Parameters &p)
    {
      p.add("A", "x", x, Positive(), "m", "x");
      p.add("A", "x", x, Positive(), "m", "x");
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
      if (Positive().contains(value))
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
    written.law = random() % 2 == 0 ? "linear" : "mooney-rivlin";
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
    EXPECT_TRUE(same_bits(back.spacing, written.spacing));
    EXPECT_TRUE(same_bits(back.area_factor, written.area_factor));
    EXPECT_TRUE(same_bits(back.density, written.density));
    EXPECT_EQ(back.steps, written.steps);
    EXPECT_EQ(back.rows, written.rows);
    EXPECT_EQ(back.seed, written.seed);
    EXPECT_EQ(back.periodic, written.periodic);
    EXPECT_EQ(back.title, written.title);
    EXPECT_EQ(back.law, written.law);
    EXPECT_EQ(back.rule, written.rule);
    EXPECT_EQ(back.stretches, written.stretches);
    EXPECT_EQ(back.time_step, written.time_step);
    EXPECT_EQ(hash_of(text), p.hash());
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
  const TemporaryFolder folder;
  p.write(folder / "case.prm");
  EXPECT_EQ(content_of(folder / "case.prm"), text);
  EXPECT_THROW(p.write(folder / "missing/case.prm"), OutputError);
}

TEST(Parameters, DealIIReadsTheResolvedCaseAsWeDo)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(good + "subsection Run\nset title = a = \\ b\nend", "a.prm");
  p.finish();
  dealii::ParameterHandler handler;
  p.declare_in(handler);
  std::istringstream text(p.resolved_text());
  handler.parse_input(text, "case.prm");
  EXPECT_EQ(handler.get({"Lattice"}, "spacing"), "1");
  EXPECT_EQ(handler.get({"Run"}, "title"), "a = \\ b");
  EXPECT_EQ(handler.get_double({"Lattice"}, "nearest neighbour area factor"), 0.6667);
}

TEST(Parameters, HashChangesWithEveryValue)
{
  const std::uint64_t original = hash_of(good);
  for (const std::string change :
       {"Lattice/spacing=1.0000000000000002", "Lattice/nearest neighbour area factor=0.5", "Lattice/rows=4",
        "Lattice/periodic=true", "Lattice/law=linear", "Lattice/density=2", "Fracture/rule=retraction",
        "Fracture/stretches=2, 1", "Run/steps=101", "Run/seed=8", "Run/title=other", "Run/time step=1"})
    EXPECT_NE(hash_of(good, {change}), original) << change;
}

TEST(Parameters, HashKnowsNothingOfHowTheCaseIsWritten)
{
  const std::uint64_t original = hash_of(good, {"Lattice/rows=4", "Run/steps=5"});
  EXPECT_EQ(hash_of("subsection Run # first\n  set steps=5\nend\n\nsubsection Lattice\nset rows = 4\nend\n"
                    "subsection Lattice\nset spacing = 100 cm\nend"),
            original);
  EXPECT_EQ(hash_of(R"({"Run": {"steps": 5}, "Lattice": {"rows": 4, "spacing": 1.0}})", {}, "a.json"), original);
  EXPECT_EQ(hash_of(good, {"Lattice/rows=4", "Run/steps=5", "Run/seed=7"}), original) << "a default written out";
  // The hash is kept in files, so it must never change: FNV-1a of "A/x=0.5\n".
  double x = 0.5;
  Parameters p;
  p.add("A", "x", x, Any(), "1", "x");
  EXPECT_EQ(p.hash(), 0x366a6e15a41af97fULL);
}

TEST(Parameters, HashDoesNotDependOnTheOrderOfDeclaration)
{
  double x = 1.;
  double y = 2.;
  Parameters p;
  p.add("A", "x", x, Any(), "1", "x");
  p.add("A", "y", y, Any(), "1", "y");
  Parameters q;
  q.add("A", "y", y, Any(), "1", "y");
  q.add("A", "x", x, Any(), "1", "x");
  EXPECT_EQ(p.hash(), q.hash());
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
  EXPECT_EQ(sample.spacing, 0.000625);
  EXPECT_EQ(sample.area_factor, 0.5);
  EXPECT_EQ(sample.rows, 12u);
  EXPECT_TRUE(sample.periodic);
  EXPECT_EQ(sample.law, "linear");
  EXPECT_EQ(sample.density, 10.);
  EXPECT_EQ(sample.rule, Rule::behind_tip);
  EXPECT_EQ(sample.stretches, (std::vector<double>{1.5, 0.30000000000000004, 7.}));
  EXPECT_EQ(sample.steps, -3);
  EXPECT_EQ(sample.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(sample.title, "y");
}

TEST(Parameters, JsonProblemsAreToldWithTheirPath)
{
  const auto json = [](const std::string &more)
  { return problem(R"({"Lattice": {"spacing": 1}, )" + more + "}", {}, "a.json"); };
  EXPECT_EQ(json(R"("Run": {"steps": 1.5})"),
            "a.json:/Run/steps: Run/steps = 1.5: not a whole number; allowed: a whole number");
  EXPECT_EQ(json(R"("Run": {"stesp": 1})"),
            "a.json:/Run/stesp: Run/stesp = 1: unknown key; nearest known key: Run/steps; "
            "known in Run: steps, seed, title, time step");
  EXPECT_EQ(json(R"("Rum": {"steps": 1})"),
            "a.json:/Rum: unknown subsection 'Rum'; nearest: Run; known: Lattice, Fracture, Run");
  EXPECT_EQ(json(R"("Run": {"steps": 1, "steps": 2})"),
            "a.json:/Run/steps: Run/steps = 2: set twice, first at a.json:/Run/steps to 1");
  EXPECT_EQ(json(R"("Run": {"steps": null})"),
            "a.json:/Run/steps: null is not understood here; allowed: a number, a string, a "
            "boolean, or a list of those");
  EXPECT_EQ(
    json(R"("Run": {"steps": {"value": [1, {"a": 2}]}})"),
    "a.json:/Run/steps: an object is not understood here; allowed: a number, a string, a boolean, or a list of those");
  EXPECT_EQ(json(R"("Run": [1, [2], {"steps": 1}])"),
            "a.json:/Run: a list is not understood here; allowed: an object with the entries of the section");
  EXPECT_EQ(json(R"("Run": 1)"),
            "a.json:/Run: '1' is not understood here; allowed: an object with the entries of the section");
  EXPECT_EQ(json(R"("Fracture": {"stretches": [1, [2, 3], 4]})"),
            "a.json:/Fracture/stretches: a list in a list is not understood here; allowed: numbers, strings, booleans");
  EXPECT_EQ(json(R"("Fracture": {"stretches": [-1, null]})"),
            "a.json:/Fracture/stretches: null in a list is not understood here; allowed: numbers, strings, booleans");
  EXPECT_EQ(json(R"("Run": {"title": "a\u0000b"})"),
            "a.json:/Run/title: Run/title = a\\x00b: control characters and line "
            "breaks are not allowed; allowed: a text on one line");
  EXPECT_EQ(json(R"("Lattice": {"rows": 3}, "Lattice": {"rows": 4})"),
            "a.json:/Lattice/rows: Lattice/rows = 4: set twice, first at a.json:/Lattice/rows to 3");
}

TEST(Parameters, BrokenJsonIsToldWithItsLine)
{
  const std::string missing = "a.json: Lattice/spacing: required";
  for (const std::string text :
       {"", "{", "{\"Lattice\": {\"spacing\": }}", "[1, 2]", "7", "{}}", "\xff\xfe", "{\"a\": 1e999}"})
  {
    const std::vector<std::string> all = problems(text, {}, "a.json");
    ASSERT_EQ(all.size(), 2u) << text;
    EXPECT_EQ(all[0].find("a.json:"), 0u) << all[0];
    EXPECT_EQ(all[1].find(missing), 0u) << all[1];
  }
  EXPECT_EQ(problems("{\n\n  \"Lattice\": oops}", {}, "a.json")[0].find("a.json:3: not JSON: parse error at line 3"),
            0u);
}

TEST(Parameters, UnreadableFilesAreOneProblem)
{
  const TemporaryFolder folder;
  const auto read_problem = [](const std::string &path)
  {
    Sample sample;
    Parameters p;
    sample.declare(p);
    p.read_file(path);
    const std::vector<std::string> all = problems_of(p);
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? "" : all[0];
  };
  EXPECT_EQ(read_problem(folder / "none.prm"),
            (folder / "none.prm") + ": cannot read the case: No such file or directory");
  EXPECT_EQ(read_problem(folder.path()), folder.path() + ": cannot read the case: it is a folder");
  EXPECT_EQ(read_problem("/dev/zero"), "/dev/zero: cannot read the case: it is larger than 16 MiB, which no case is");
  EXPECT_NE(read_problem(""), "");
  std::ofstream(folder / "a.prm") << good << "set rows = 1\n";
  EXPECT_EQ(read_problem(folder / "a.prm").find((folder / "a.prm") + ":4: "), 0u);
}

TEST(Parameters, HostileTextGivesShortPrintableProblems)
{
  std::vector<std::string> texts = {std::string(1000, '\0'),
                                    "a\n\0b",
                                    std::string(1 << 20, 'x'),
                                    "set " + std::string(1 << 20, 'y') + " = 1",
                                    "subsection Lattice\nset " + std::string(1 << 20, '\xc3') + " = " +
                                      std::string(1 << 20, '\x1b') + "\nend",
                                    "subsection Lattice\nset spacing = " + std::string(1 << 20, '9') + "\nend",
                                    "subsection Lattice\nset spacing = 1 " + std::string(1 << 20, 'm') + "\nend",
                                    std::string(1 << 16, '\\') + "\n",
                                    "subsection",
                                    "set",
                                    "end",
                                    "=",
                                    "set =",
                                    "subsection \\",
                                    std::string(1 << 20, '['),
                                    std::string("{\"a\":") + std::string(1 << 16, '[')};
  for (int i = 0; i < 20000; ++i)
    texts[0] += "subsection Lattice\n";
  std::string deep;
  for (int i = 0; i < 20000; ++i)
    deep += "subsection Lattice\n";
  texts.push_back(deep);
  for (int i = 0; i < 20000; ++i)
    deep += "end\n";
  texts.push_back(deep);
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i)
  {
    std::string text = "{\"Lattice\": {}}\n" + good + "subsection Run\n set title = x # y\nend\n";
    for (int k = 0; k < 5; ++k)
      text[random() % text.size()] = static_cast<char>(random());
    texts.push_back(text);
  }
  for (const std::string &text : texts)
    for (const char *name : {"a.prm", "a.json"})
      for (const std::string &line : problems(text, {text.substr(0, 1000)}, name))
      {
        EXPECT_LT(line.size(), 1000u);
        for (const char c : line)
          ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
      }
}
