// write_file leaves either the old file or the new one, and says why when it is the old one.
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
#include <sys/stat.h>
#include <unistd.h>

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

TEST(AtomicFile, WritesAndReplaces)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, std::string("old and longer"));
  EXPECT_EQ(content_of(path), "old and longer");
  write_file(path, [](std::ostream &out) { out << "new\n"; });
  EXPECT_EQ(content_of(path), "new\n");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(AtomicFile, WritesMoreThanOneBlockAndEveryByte)
{
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 3000000; ++i)
    text += static_cast<char>(i % 256);
  write_file(folder / "large", text);
  EXPECT_TRUE(content_of(folder / "large") == text);
}

TEST(AtomicFile, ReplacesAPartLeftByAKilledRun)
{
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt.part") << "the longer half of something else";
  write_file(folder / "a.txt", std::string("whole"));
  EXPECT_EQ(content_of(folder / "a.txt"), "whole");
}

TEST(AtomicFile, MissingFolderIsNamedWithTheReason)
{
  const TemporaryFolder folder;
  const std::string path = folder / "missing/a.txt";
  EXPECT_EQ(complaint(path), "cannot write " + path + ": No such file or directory");
}

TEST(AtomicFile, FullDiskLeavesTheOldFile)
{
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, std::string("old"));
  // The part goes to a device that is always full.
  ASSERT_EQ(symlink("/dev/full", (path + ".part").c_str()), 0);
  EXPECT_EQ(complaint(path), "cannot write " + path + ": No space left on device");
  EXPECT_EQ(content_of(path), "old");
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(path + ".part")));
}

TEST(AtomicFile, UnwritableFolderLeavesTheOldFile)
{
  // Not even root may create a file here.
  EXPECT_NE(complaint("/proc/latcon_test"), "");
  if (geteuid() == 0)
    return;
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, std::string("old"));
  ASSERT_EQ(chmod(folder.path().c_str(), 0500), 0);
  EXPECT_EQ(complaint(path), "cannot write " + path + ": Permission denied");
  EXPECT_EQ(content_of(path), "old");
  ASSERT_EQ(chmod(folder.path().c_str(), 0700), 0);
}

TEST(AtomicFile, NeverReplacesADeviceOrAFolder)
{
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub");
  EXPECT_EQ(complaint(folder / "sub"), "cannot write " + (folder / "sub") + ": it is a folder");
  // A pipe of the test's own stands for every device: code that failed this test as root would destroy a real one.
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(complaint(pipe), "cannot write " + pipe + ": it is not a regular file");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(AtomicFile, WriterThatFailsOrThrowsLeavesTheOldFile)
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
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
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
