#include <array>
#include <deque>
#include <fstream>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "lattice/fracture.h"
#include "tests/support/temporary_folder.h"
#include "verification/output/archive.h"

namespace checkpoint_test
{

using namespace latcon;

using namespace output;

struct Inner
{
  double number = 0.;

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("number", number);
  }
};

using Bonds = std::vector<lattice::BrokenBond>;

// Handmade files with the names of archived objects. What runs archive comes back: resume_test.py.
class HostileArchive : public testing::Test
{
protected:
  template <class T>
  void put(const std::string &name, const std::vector<T> &values)
  {
    image_->write(name, typeid(T), values.data(), values.size());
  }
  // Writes the file with what was put; the next file begins.
  std::string written()
  {
    const std::string path = folder_ / "file.h5";
    std::ofstream(path, std::ios::binary) << image_->take_bytes();
    image_.emplace();
    return path;
  }
  // Expects that such a file is refused where an object with the name "a" is read.
  template <class T>
  void expect_refused(const char *what, T object)
  {
    const Hdf5File file(written());
    CheckpointReader archive(file);
    const auto read = [&]
    {
      if constexpr (std::is_same_v<T, Bonds>)
        archive.records("a", object);
      else
        archive("a", object);
    };
    EXPECT_THROW(read(), Hdf5Error) << what;
  }

  TemporaryFolder folder_;
  std::optional<Hdf5Image> image_{std::in_place};
};

TEST_F(HostileArchive, DoesNotFit)
{
  put<double>("a/number", {1.});
  put<double>("a/list", {2., 3.});
  const Hdf5File file(written());
  CheckpointReader archive(file);
  double number = 0.;
  archive("a/number", number);
  EXPECT_EQ(number, 1.);
  EXPECT_THROW(archive("a/other", number), Hdf5Error);
  std::uint64_t whole = 0;
  EXPECT_THROW(archive("a/number", whole), Hdf5Error);
  EXPECT_THROW(archive("a/list", number), Hdf5Error);
  std::string text;
  EXPECT_THROW(archive("a/number", text), Hdf5Error);
  std::array<Inner, 3> three;
  EXPECT_THROW(archive("a", three), Hdf5Error);
  std::ofstream(folder_ / "text") << "no such thing";
  EXPECT_THROW(Hdf5File(folder_ / "text"), Hdf5Error);
  EXPECT_THROW(Hdf5File(folder_ / "none"), Hdf5Error);
}

TEST_F(HostileArchive, IsRefused)
{
  constexpr std::uint64_t endless = std::numeric_limits<std::uint64_t>::max(), many = std::uint64_t{1} << 60U;
  put<double>("a", {1., std::numeric_limits<double>::quiet_NaN()});
  expect_refused("a number that is not finite", std::vector<double>());
  put<std::uint8_t>("a", {2});
  expect_refused("a truth value that is neither", false);
  put<std::uint64_t>("a", {1, 2});
  expect_refused("two optional numbers", std::optional<std::size_t>());
  put<double>("a", {1., 2., 3.});
  expect_refused("a part of a point", std::vector<Eigen::Vector2d>());
  for (const std::vector<std::uint64_t> &sizes : {std::vector<std::uint64_t>{1, endless}, {1}})
  {
    put<double>("a/values", {1., 2.});
    put<std::uint64_t>("a/sizes", sizes);
    expect_refused("lists longer or shorter than their values", std::vector<std::vector<double>>());
  }
  put<std::uint64_t>("a/n", {many});
  expect_refused("a number of objects from the file", std::deque<Inner>(3));
  put<double>("a", std::vector<double>(9, 1.));
  expect_refused("a part of a record", Bonds());
  for (const double number : {-1., 0.5, 1e300})
  {
    put<double>("a", std::vector<double>(8, number));
    expect_refused("no whole number", Bonds());
  }
  image_->write_text("a", std::string("one\0two", 7));
  expect_refused("a text that ends early", std::string());
}

} // namespace checkpoint_test
