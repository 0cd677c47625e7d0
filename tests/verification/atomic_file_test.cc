// What write_file adds to support/atomic_file.h: writers, the exit code of what fails, numbers as text.
#include "temporary_folder.h"

#include "verification/atomic_file.h"
#include "verification/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <ostream>
#include <random>

using verification::ExitCode;
using verification::full_precision;
using verification::OutputError;
using verification::write_file;

namespace
{

// What write_file says when it cannot write; empty if it could.
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

std::uint64_t bits(const double value)
{
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof(value));
  return result;
}

} // namespace

TEST(WriteFile, WritesAndReplaces)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, std::string("old and longer"));
  EXPECT_EQ(content_of(path), "old and longer");
  write_file(path, [](std::ostream &out) { out << "new\n"; });
  EXPECT_EQ(content_of(path), "new\n");
}

TEST(WriteFile, MissingFolderIsNamedWithTheReason)
{
  const TemporaryFolder folder;
  const std::string path = folder / "missing/a.txt";
  EXPECT_EQ(complaint(path), "cannot write " + path + ": No such file or directory");
}

TEST(WriteFile, WriterThatFailsOrThrowsLeavesTheOldFile)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, std::string("old"));
  EXPECT_THROW(write_file(path,
                          [](std::ostream &out)
                          {
                            out << "half";
                            out.setstate(std::ios::failbit);
                          }),
               OutputError);
  EXPECT_THROW(write_file(path,
                          [](std::ostream &out)
                          {
                            out << "half";
                            throw std::runtime_error("stop");
                          }),
               std::runtime_error);
  EXPECT_EQ(content_of(path), "old");
}

TEST(FullPrecision, IsShortAndReadsBackBitForBit)
{
  EXPECT_EQ(full_precision(0.1), "0.1");
  EXPECT_EQ(full_precision(-0.), "-0");
  EXPECT_EQ(full_precision(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(full_precision(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(full_precision(-std::numeric_limits<double>::infinity()), "-inf");
  std::mt19937_64 random(1);
  for (int i = 0; i < 10000; ++i)
  {
    const std::uint64_t pattern = random();
    double value = 0.;
    std::memcpy(&value, &pattern, sizeof(value));
    if (std::isfinite(value))
    {
      EXPECT_EQ(bits(std::strtod(full_precision(value).c_str(), nullptr)), pattern);
    }
  }
}
