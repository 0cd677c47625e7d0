#include <cmath>
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
  std::vector<double> list;

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("number", number);
    archive("list", list);
  }
  bool operator==(const Inner &other) const { return number == other.number && list == other.list; }
};

using Bonds = std::vector<lattice::BrokenBond>;

class Archive : public testing::Test
{
protected:
  // Archives an object under the name "a".
  template <class SomeArchive, class T>
  static void visit(SomeArchive &archive, T &object)
  {
    if constexpr (std::is_same_v<T, Bonds>)
      archive.records("a", object);
    else
      archive("a", object);
  }

  std::string file_of(Hdf5Image &image)
  {
    const std::string path = folder_ / "file.h5";
    std::ofstream(path, std::ios::binary) << image.take_bytes();
    return path;
  }
  template <class T>
  std::string written(T object)
  {
    Hdf5Image image;
    CheckpointWriter archive(&image);
    visit(archive, object);
    return file_of(image);
  }
  template <class T>
  static T read(const std::string &path, T object)
  {
    const Hdf5File file(path);
    CheckpointReader archive(file);
    visit(archive, object);
    return object;
  }
  // @param before value of the object before it is read
  template <class T>
  void expect_back(const T &saved, const T &before = {})
  {
    EXPECT_EQ(read(written(saved), before), saved);
  }

  TemporaryFolder folder_;
};

TEST_F(Archive, GivesBackWhatItWasGivenBitForBit)
{
  expect_back(true);
  expect_back(-3);
  expect_back(4000000000U);
  expect_back(std::numeric_limits<std::uint64_t>::max());
  expect_back(std::nextafter(0.1, 1.));
  expect_back(std::string("a line\nand \xc3\xa9"));
  expect_back(Eigen::Matrix2d({{1., 2.}, {3., 4.}}), Eigen::Matrix2d::Zero().eval());
  const std::vector<double> reals{-0., std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};
  expect_back(reals);
  EXPECT_TRUE(std::signbit(read(written(reals), std::vector<double>())[0]));
  expect_back(std::vector<std::uint8_t>{0, 255});
  expect_back(std::vector<std::uint16_t>{65535, 1});
  expect_back(std::vector<Eigen::Vector2d>{{1., 2.}, {3., 4.}, {5., 6.}});
  expect_back(std::vector<std::vector<double>>{{1., 2.}, {}, {3.}});
  expect_back(std::optional<std::size_t>(7));
  expect_back(std::optional<std::size_t>(), {5});
  expect_back(Inner{8., {9., 10.}});
  expect_back(std::array<Inner, 2>{Inner{11., {}}, Inner{12., {13.}}});
  expect_back(std::deque<Inner>{{}, {14., {15.}}}, std::deque<Inner>(2));
  const Bonds bonds{{{5, 2, 6}, 1e-3, {0.1, 0.2}, 3.05, 1e-7}, {{7, 3, 8}, 2e-3, {0.3, 0.4}, 3.06, 2e-7}};
  const Bonds back = read(written(bonds), Bonds());
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(std::tie(back[i].near, back[i].kind, back[i].far, back[i].time, back[i].midpoint, back[i].stretch),
              std::tie(bonds[i].near, bonds[i].kind, bonds[i].far, bonds[i].time, bonds[i].midpoint, bonds[i].stretch));
    EXPECT_EQ(back[i].energy, bonds[i].energy);
  }
  EXPECT_TRUE(read(written(Bonds()), Bonds(3)).empty());
}

TEST_F(Archive, LeavesTheUserBlockToTheOwnerOfTheFile)
{
  const std::string path = written(Inner{1., {2.}});
  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary) << std::string(Hdf5Image::user_block, 'x');
  EXPECT_EQ(read(path, Inner()), (Inner{1., {2.}}));
}

TEST_F(Archive, RefusesWhatDoesNotFit)
{
  const Hdf5File file(written(Inner{1., {2., 3.}}));
  CheckpointReader archive(file);
  double number = 0.;
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

// Handmade files with the names of archived objects.
class HostileArchive : public Archive
{
protected:
  template <class T>
  void put(const std::string &name, const std::vector<T> &values)
  {
    image_->write(name, typeid(T), values.data(), values.size());
  }
  // Expects that the file with what was put is refused; the next file begins.
  template <class T>
  void expect_refused(const char *what, const T &object)
  {
    const std::string path = file_of(*image_);
    image_.emplace();
    EXPECT_THROW(read(path, object), Hdf5Error) << what;
  }

  std::optional<Hdf5Image> image_{std::in_place};
};

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
