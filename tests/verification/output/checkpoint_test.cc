#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <tuple>

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
};

struct Everything
{
  bool truth = false;
  int sign = 0;
  unsigned int count = 0;
  std::uint64_t large = 0;
  double number = 0.;
  std::string text;
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  std::vector<double> reals;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
  std::vector<Eigen::Vector2d> points;
  std::vector<std::vector<double>> lists;
  std::optional<std::size_t> some, none;
  Inner inner;
  std::array<Inner, 2> two;
  std::deque<Inner> queue{{}, {}, {}};
  std::vector<lattice::BrokenBond> bonds, no_bonds;

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("truth", truth);
    archive("sign", sign);
    archive("count", count);
    archive("large", large);
    archive("number", number);
    archive("text", text);
    archive("matrix", matrix);
    archive("reals", reals);
    archive("bytes", bytes);
    archive("words", words);
    archive("points", points);
    archive("lists", lists);
    archive("some", some);
    archive("none", none);
    archive("inner", inner);
    archive("two", two);
    archive("queue", queue);
    archive.records("bonds", bonds);
    archive.records("no_bonds", no_bonds);
  }
};

Everything example()
{
  Everything all;
  all.truth = true;
  all.sign = -3;
  all.count = 4000000000U;
  all.large = std::numeric_limits<std::uint64_t>::max();
  all.number = std::nextafter(0.1, 1.);
  all.text = "a line\nand \xc3\xa9";
  all.matrix << 1., 2., 3., 4.;
  all.reals = {-0., std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};
  all.bytes = {0, 255};
  all.words = {65535, 1};
  all.points = {{1., 2.}, {3., 4.}, {5., 6.}};
  all.lists = {{1., 2.}, {}, {3.}};
  all.some = 7;
  all.inner = {8., {9., 10.}};
  all.two = {Inner{11., {}}, Inner{12., {13.}}};
  all.queue[2] = {14., {15.}};
  all.bonds = {{{5, 2, 6}, 1e-3, {0.1, 0.2}, 3.05, 1e-7}, {{7, 3, 8}, 2e-3, {0.3, 0.4}, 3.06, 2e-7}};
  return all;
}

// All of it, with objects by their parts.
auto values(const Everything &all)
{
  std::vector<std::pair<double, std::vector<double>>> objects{{all.inner.number, all.inner.list}};
  for (const Inner &one : all.two)
    objects.emplace_back(one.number, one.list);
  for (const Inner &one : all.queue)
    objects.emplace_back(one.number, one.list);
  std::vector<std::tuple<std::size_t, std::size_t, std::size_t, double, double, double, double, double>> records;
  for (const auto *bonds : {&all.bonds, &all.no_bonds})
    for (const lattice::BrokenBond &bond : *bonds)
      records.emplace_back(bond.near, bond.kind, bond.far, bond.time, bond.midpoint.x(), bond.midpoint.y(),
                           bond.stretch, bond.energy);
  return std::tuple(all.truth, all.sign, all.count, all.large, all.number, all.text, all.matrix, all.reals, all.bytes,
                    all.words, all.points, all.lists, all.some, all.none, objects, records);
}

class Archive : public testing::Test
{
protected:
  // Writes a file with one object under the name "all".
  template <class T>
  std::string written(T &object)
  {
    Hdf5Image image;
    CheckpointWriter archive(&image);
    archive("all", object);
    const std::string path = folder_ / "file.h5";
    std::ofstream(path, std::ios::binary) << image.take_bytes();
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(Archive, GivesBackWhatItWasGivenBitForBit)
{
  Everything saved = example(), loaded;
  loaded.none = 5;
  loaded.no_bonds.resize(3);
  const Hdf5File file(written(saved));
  CheckpointReader archive(file);
  archive("all", loaded);
  EXPECT_EQ(values(loaded), values(saved));
  EXPECT_TRUE(std::signbit(loaded.reals[0]));
}

TEST_F(Archive, LeavesTheUserBlockToTheOwnerOfTheFile)
{
  Everything saved = example(), loaded;
  const std::string path = written(saved);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file << std::string(Hdf5Image::user_block, 'x');
  }
  const Hdf5File file(path);
  CheckpointReader archive(file);
  archive("all", loaded);
  EXPECT_EQ(loaded.text, saved.text);
}

TEST_F(Archive, RefusesWhatDoesNotFit)
{
  Inner saved{1., {2., 3.}};
  const Hdf5File file(written(saved));
  CheckpointReader archive(file);
  double number = 0.;
  EXPECT_THROW(archive("all/other", number), Hdf5Error);
  std::uint64_t whole = 0;
  EXPECT_THROW(archive("all/number", whole), Hdf5Error);
  EXPECT_THROW(archive("all/list", number), Hdf5Error);
  std::string text;
  EXPECT_THROW(archive("all/number", text), Hdf5Error);
  std::array<Inner, 3> three;
  EXPECT_THROW(archive("all", three), Hdf5Error);
}

// Handmade files with the names of archived objects.
class HostileArchive : public testing::Test
{
protected:
  template <class T>
  void put(const std::string &name, const std::vector<T> &values)
  {
    image_->write(name, typeid(T), values.data(), values.size());
  }
  // Expects that the file with what was put is refused; the next file begins.
  template <class T>
  void expect_refused(const char *what, T object)
  {
    SCOPED_TRACE(what);
    const std::string path = folder_ / "file.h5";
    std::ofstream(path, std::ios::binary) << image_->take_bytes();
    image_.emplace();
    const Hdf5File file(path);
    CheckpointReader archive(file);
    if constexpr (std::is_same_v<T, std::vector<lattice::BrokenBond>>)
      EXPECT_THROW(archive.records("a", object), Hdf5Error);
    else
      EXPECT_THROW(archive("a", object), Hdf5Error);
  }

  std::optional<Hdf5Image> image_{std::in_place};
  TemporaryFolder folder_;
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
  expect_refused("a part of a record", std::vector<lattice::BrokenBond>());
  for (const double number : {-1., 0.5, 1e300})
  {
    put<double>("a", std::vector<double>(8, number));
    expect_refused("no whole number", std::vector<lattice::BrokenBond>());
  }
  image_->write_text("a", std::string("one\0two", 7));
  expect_refused("a text that ends early", std::string());
}

TEST_F(Archive, RefusesAFileThatIsNotHdf5)
{
  const std::string path = folder_ / "file.h5";
  std::ofstream(path) << "no such thing";
  EXPECT_THROW(Hdf5File{path}, Hdf5Error);
  EXPECT_THROW(Hdf5File{path + ".none"}, Hdf5Error);
}

} // namespace checkpoint_test
