// JSON, files that cannot be read, and hostile text: every problem has its place and is short and printable.
#include "tests/verification/input/sample_case.h"

#include "tests/support/temporary_folder.h"
#include "verification/input/case_text.h"

#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace parameter_files_test
{

using namespace sample_case;

TEST(Parameters, BrokenJsonIsToldWithItsLine)
{
  const std::string missing = "a.json: Lattice/spacing: required";
  for (const std::string text : {"", "{", "{\"Lattice\": {\"spacing\": }}", "{}}", "\xff\xfe", "{\"a\": 1e999}"})
    EXPECT_NE(problem(text, {}, "a.json").find(": not JSON: "), std::string::npos) << text;
  for (const std::string text : {"[1, 2]", "7"})
  {
    const std::vector<std::string> all = problems(text, {}, "a.json");
    ASSERT_EQ(all.size(), 2u) << text;
    EXPECT_EQ(all[0].find("a.json:"), 0u) << all[0];
    EXPECT_EQ(all[1].find(missing), 0u) << all[1];
  }
  for (const auto &[name, zero] :
       {std::pair(std::string("a.json:1"), R"({"Lattice": {"spacing": 1}})" + std::string("\0{}", 3)),
        {"a.prm:4", good + std::string("x\0\ny\nz\n", 7)}})
    EXPECT_EQ(problem(zero, {}, name.substr(0, name.size() - 2)), name + ": not a text file: it holds zero bytes");
  EXPECT_EQ(problem(R"({"Lattice": {"spacing": 1}, "Run": {"steps": 1.5}})", {}, "A.JSON").find("A.JSON:/Run/steps: "),
            0u);
  EXPECT_EQ(problem("{\n\n  \"Lattice\": oops}", {}, "a.json").find("a.json:3: not JSON: parse error at line 3"), 0u);
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
  const std::string missing = read_problem(folder / "missing-file.prm");
  EXPECT_EQ(missing.find((folder / "missing-file.prm") + ": cannot read the case: No such file or directory; shipped"),
            0u)
    << missing;
  EXPECT_EQ(read_problem(folder.path()), folder.path() + ": cannot read the case: it is a folder");
  EXPECT_EQ(read_problem("/dev/zero"), "/dev/zero: cannot read the case: it is larger than 16 MiB");
  EXPECT_NE(read_problem(""), "");
  std::ofstream(folder / "a.prm") << good << "set rows = 1\n";
  EXPECT_EQ(read_problem(folder / "a.prm").find((folder / "a.prm") + ":4: "), 0u);
}

// No character is cut, wherever the middle begins and ends; bytes that are none are shown.
TEST(Parameters, LongTextLosesItsMiddleBetweenCharacters)
{
  std::string text;
  for (int i = 0; i < 50; ++i)
    text += "\xf0\x9f\xa6\x86";
  for (int shift = 0; shift < 4; ++shift)
  {
    const std::string shown = printable(std::string(shift, 'a') + text + std::string(shift, 'b'));
    EXPECT_EQ(shown.find("\\x"), std::string::npos) << shown;
    EXPECT_LE(shown.size(), 85u);
    EXPECT_GT(shown.size(), 78u);
  }
  EXPECT_EQ(printable(std::string(200, '\x80')).size(), 4u * (60 - 3 + 20 - 3) + 5u);
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

} // namespace parameter_files_test
