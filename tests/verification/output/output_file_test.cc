// write_file, in addition to support/atomic_file.h.
#include "tests/support/temporary_folder.h"

#include "support/errors.h"
#include "verification/output/output_file.h"

#include <gtest/gtest.h>

namespace output_file_test
{

using namespace latcon;
using latcon::support::ExitCode;
using latcon::support::OutputError;
using output::write_file;

// Returns the error message of write_file; empty on success.
std::string complaint(const std::string &path, const std::string &text = "new")
{
  try
  {
    write_file(path, text);
  }
  catch (const OutputError &error)
  {
    EXPECT_EQ(error.exit_code(), ExitCode::output_failed);
    return error.what();
  }
  return "";
}

TEST(WriteFile, WritesAndReplaces)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, "old and longer");
  EXPECT_EQ(content_of(path), "old and longer");
  write_file(path, "new\n");
  EXPECT_EQ(content_of(path), "new\n");
}

TEST(WriteFile, MissingFolderIsNamedWithTheReason)
{
  const TemporaryFolder folder;
  const std::string path = folder / "missing/a.txt";
  EXPECT_EQ(complaint(path), "cannot write " + path + ": No such file or directory");
}

} // namespace output_file_test
