#include "verification/output/output_file.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace output_list_test
{

using namespace latcon;

using namespace output;
namespace fs = std::filesystem;

std::string content(const fs::path &path)
{
  return content_of(path.string());
}

class OutputList : public testing::Test
{
protected:
  // Writes a file of a run, and a file of a library or a user.
  void written(const std::string &name, const std::string &text = "run") { write_file((folder / name).string(), text); }
  void put(const std::string &name, const std::string &text = "user") { std::ofstream(folder / name) << text; }
  bool has(const std::string &name) const { return fs::exists(folder / name); }

  TemporaryFolder temporary;
  fs::path folder = temporary.path();
};

TEST_F(OutputList, NamesWhatWasWrittenOnceAndSorted)
{
  written("before.csv"); // no list yet
  begin_output_list(folder);
  written("crack.csv");
  written("a.json");
  written("crack.csv", "again");
  EXPECT_TRUE(is_listed_output(folder / "crack.csv"));
  EXPECT_TRUE(is_listed_output(folder / "lattice-0012.vtp"));
  EXPECT_TRUE(is_listed_output(folder / "continuum_0001.2.vtu"));
  for (const char *name : {"before.csv", "lattice-.vtp", "lattice-mine.vtp", "notes.txt", "crack.csv.bak"})
    EXPECT_FALSE(is_listed_output(folder / name)) << name;
  const std::string first = content(folder / output_list_name);
  begin_output_list(folder);
  EXPECT_EQ(content(folder / output_list_name), first);
  EXPECT_LT(first.find("a.json\n"), first.find("crack.csv\n"));
  EXPECT_EQ(first.find("crack.csv\n"), first.rfind("crack.csv\n"));
}

TEST_F(OutputList, FilesOfTheRunBeforeAreMovedAndNoOthers)
{
  fs::create_directory(folder / "earlier-run"); // of the user
  put("earlier-run/crack.csv");
  begin_output_list(folder);
  written("crack.csv", "first");
  put("lattice-0000.vtp", "first");
  put("lattice-0001.vtp", "first");
  put("lattice-mine.vtp");
  put("notes.txt");
  fs::create_directory(folder / "crack.csv.d");
  fs::create_symlink(folder / "notes.txt", folder / "lattice-0002.vtp");
  EXPECT_EQ(archive_earlier_output(folder, {}), folder / "earlier-run-2");
  for (const char *name : {"crack.csv", "lattice-0000.vtp", "lattice-0001.vtp"})
  {
    EXPECT_FALSE(has(name)) << name;
    EXPECT_EQ(content(folder / "earlier-run-2" / name), "first") << name;
  }
  for (const char *name : {"lattice-mine.vtp", "notes.txt", "crack.csv.d", "lattice-0002.vtp"})
    EXPECT_TRUE(has(name)) << name;

  EXPECT_EQ(archive_earlier_output(folder, {}), fs::path()); // nothing is left to move

  put("earlier-run-2/mine.txt");
  begin_output_list(folder);
  written("crack.csv", "second");
  EXPECT_EQ(archive_earlier_output(folder, {}), folder / "earlier-run-3");
  EXPECT_EQ(content(folder / "earlier-run-3/crack.csv"), "second");
  EXPECT_FALSE(has("earlier-run-3/lattice-0000.vtp"));
  EXPECT_EQ(content(folder / "earlier-run/crack.csv"), "user");
  // The files of the first run remain.
  EXPECT_EQ(content(folder / "earlier-run-2/crack.csv"), "first");
  EXPECT_TRUE(has("earlier-run-2/lattice-0000.vtp"));
  EXPECT_TRUE(has("earlier-run-2/mine.txt"));
}

} // namespace output_list_test
