/// Archives to which objects save their state and from which they load it.
///
/// A class with a state has one function for both directions:
///
///     template <class Archive> void archive(Archive &archive)
///     {
///       archive("time", time_);
///       archive("displacement", displacement_);
///     }
///
/// so that saving and loading cannot differ. The class only uses that an archive is called with names and values, and
/// that `Archive::loads` is true if it loads. If an object is distributed over MPI ranks, all ranks call its archive():
/// to save, the root rank passes the complete values (values of other ranks are ignored); to load, every rank gets the
/// complete values and keeps its part.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "verification/output/hdf5_file.h"

namespace latcon::output
{
namespace archive_detail
{

template <class T>
struct IsVector : std::false_type
{
};
template <class T, class Allocator>
struct IsVector<std::vector<T, Allocator>> : std::true_type
{
};

template <class T>
struct IsOptional : std::false_type
{
};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type
{
};

template <class T, class Archive, class = void>
struct HasArchive : std::false_type
{
};
template <class T, class Archive>
struct HasArchive<T, Archive, std::void_t<decltype(std::declval<T &>().archive(std::declval<Archive &>()))>>
  : std::true_type
{
};

template <class T>
constexpr bool is_matrix = std::is_base_of_v<Eigen::MatrixBase<T>, T>;

/// Values of the members of many records, by member name.
struct Columns
{
  std::map<std::string, std::vector<double>> reals;
  std::map<std::string, std::vector<std::uint64_t>> wholes;
};

/// Archive that copies the members of one record to or from row `row` of columns.
/// @tparam Read function of the name of a column and of its values, which it reads for the first row
template <bool loading, class Read>
class RecordArchive
{
public:
  static constexpr bool loads = loading;
  RecordArchive(Columns &columns, std::size_t row, const Read &read) : columns_(columns), row_(row), read_(read) {}

  template <class T>
  void operator()(const std::string &name, T &value)
  {
    if constexpr (std::is_same_v<T, double>)
      exchange(columns_.reals, name, value);
    else if constexpr (std::is_same_v<T, std::size_t> || std::is_same_v<T, std::uint64_t>)
      exchange(columns_.wholes, name, value);
    else if constexpr (is_matrix<T>)
      for (Eigen::Index i = 0; i < value.size(); ++i)
        exchange(columns_.reals, name + "_" + std::to_string(i), value.data()[i]);
    else
    {
      static_assert(HasArchive<T, RecordArchive>::value, "a record consists of numbers and of records");
      const std::string outer = prefix_;
      prefix_ += name + "_";
      value.archive(*this);
      prefix_ = outer;
    }
  }

private:
  template <class Number>
  void exchange(std::map<std::string, std::vector<Number>> &columns, const std::string &name, Number &value)
  {
    std::vector<Number> &column = columns[prefix_ + name];
    if constexpr (loading)
    {
      if (row_ == 0)
        read_(prefix_ + name, column);
      value = column.at(row_);
    }
    else
      column.push_back(value);
  }

  Columns &columns_;
  std::size_t row_;
  const Read &read_;
  std::string prefix_;
};

/// Common base of both archives, which decomposes objects into arrays and texts.
template <class Archive>
class Base
{
public:
  /// Archives a number, a text, a matrix of fixed size, a vector of numbers or of such matrices, an optional number, a
  /// vector of vectors of numbers, an object with archive(), or a range of such objects. The size of a range must be
  /// the same for saving and loading.
  template <class T>
  void operator()(const std::string &name, T &value)
  {
    if constexpr (std::is_same_v<T, std::string>)
      self().text(name, value);
    else if constexpr (std::is_same_v<T, bool>)
    {
      std::uint8_t byte = value ? 1 : 0;
      self().elements(name, &byte, 1);
      require(byte <= 1, name, "is not a truth value");
      value = byte != 0;
    }
    else if constexpr (std::is_arithmetic_v<T>)
      self().elements(name, &value, 1);
    else if constexpr (is_matrix<T>)
      self().elements(name, value.data(), static_cast<std::size_t>(value.size()));
    else if constexpr (IsOptional<T>::value)
      optional(name, value);
    else if constexpr (HasArchive<T, Archive>::value)
    {
      const std::string outer = prefix_;
      prefix_ += name + "/";
      value.archive(self());
      prefix_ = outer;
    }
    else
      several(name, value);
  }

  /// Archives many small objects as columns. Their archive() may contain only numbers and objects of numbers.
  template <class Record>
  void records(const std::string &name, std::vector<Record> &all)
  {
    std::size_t n = all.size();
    (*this)(name + "/n", n);
    if constexpr (Archive::loads)
      all.clear();
    Columns columns;
    // Columns that have this size are not larger than the file.
    const auto read = [&](const std::string &column, auto &values)
    {
      (*this)(name + "/" + column, values);
      require(values.size() == n, name + "/" + column, "has a length other than `n`");
    };
    for (std::size_t row = 0; row < n; ++row)
    {
      if constexpr (Archive::loads)
        all.emplace_back();
      RecordArchive<Archive::loads, decltype(read)> archive(columns, row, read);
      all[row].archive(archive);
    }
    if constexpr (!Archive::loads)
    {
      for (auto &[column, values] : columns.reals)
        (*this)(name + "/" + column, values);
      for (auto &[column, values] : columns.wholes)
        (*this)(name + "/" + column, values);
    }
  }

protected:
  void require(bool holds, const std::string &name, const std::string &problem) const
  {
    if (!holds)
      throw Hdf5Error("`" + prefix_ + name + "` " + problem);
  }

  std::string prefix_; // of the current object

private:
  Archive &self() { return static_cast<Archive &>(*this); }

  template <class T>
  void optional(const std::string &name, std::optional<T> &value)
  {
    std::vector<T> values;
    if (value)
      values.push_back(*value);
    (*this)(name, values);
    require(values.size() <= 1, name, "is more than one value");
    value = values.empty() ? std::nullopt : std::optional<T>(values.front());
  }

  // Archives concatenated values, and the size of each vector.
  template <class Number>
  void vectors(const std::string &name, std::vector<std::vector<Number>> &all)
  {
    std::vector<Number> values;
    std::vector<std::uint64_t> sizes;
    for (const std::vector<Number> &one : all)
    {
      values.insert(values.end(), one.begin(), one.end());
      sizes.push_back(one.size());
    }
    (*this)(name + "/values", values);
    (*this)(name + "/sizes", sizes);
    all.clear();
    auto next = values.begin();
    for (const std::uint64_t size : sizes)
    {
      require(size <= static_cast<std::uint64_t>(values.end() - next), name + "/sizes", "exceed the number of values");
      all.emplace_back(next, next + static_cast<std::ptrdiff_t>(size));
      next += static_cast<std::ptrdiff_t>(size);
    }
    require(next == values.end(), name + "/sizes", "are less than the number of values");
  }

  template <class Range>
  void several(const std::string &name, Range &range)
  {
    using T = typename Range::value_type;
    if constexpr (IsVector<Range>::value && std::is_arithmetic_v<T>)
    {
      if constexpr (Archive::loads)
        range.resize(self().size(name));
      self().elements(name, range.data(), range.size());
    }
    else if constexpr (IsVector<Range>::value && is_matrix<T>)
    {
      constexpr auto per_element = static_cast<std::size_t>(T::SizeAtCompileTime);
      static_assert(sizeof(T) == per_element * sizeof(double));
      if constexpr (Archive::loads)
      {
        const std::size_t n = self().size(name);
        require(n % per_element == 0, name, "ends with an incomplete element");
        range.resize(n / per_element);
      }
      self().elements(name, range.empty() ? nullptr : range.front().data(), per_element * range.size());
    }
    else if constexpr (IsVector<Range>::value && IsVector<T>::value)
      vectors(name, range);
    else
    {
      std::size_t n = range.size();
      (*this)(name + "/n", n);
      require(range.size() == n, name, "has another number of objects");
      std::size_t i = 0;
      for (T &element : range)
        (*this)(name + "/" + std::to_string(i++), element);
    }
  }
};

} // namespace archive_detail

/// Archive that saves to a file in memory. @throws Hdf5Error if there is not enough memory
class CheckpointWriter : public archive_detail::Base<CheckpointWriter>
{
public:
  static constexpr bool loads = false;

  /// @param image destination on the root rank; null on other ranks
  explicit CheckpointWriter(Hdf5Image *image) : image_(image) {}

  template <class T>
  void elements(const std::string &name, const T *values, std::size_t n)
  {
    if (image_ != nullptr)
      image_->write(prefix_ + name, element_type<T>(), values, n);
  }
  void text(const std::string &name, const std::string &text)
  {
    if (image_ != nullptr)
      image_->write_text(prefix_ + name, text);
  }

private:
  Hdf5Image *image_;
};

/// Archive that loads from a file. Sizes are those of the stored arrays, never numbers read from the file. An object
/// that expects a size, or uses a number as an index, must check it in its archive().
/// @throws Hdf5Error if an array or text is missing or of another type or size, or if a real number is not finite
class CheckpointReader : public archive_detail::Base<CheckpointReader>
{
public:
  static constexpr bool loads = true;
  explicit CheckpointReader(const Hdf5File &file) : file_(file) {}

  template <class T>
  void elements(const std::string &name, T *values, std::size_t n)
  {
    file_.read(prefix_ + name, element_type<T>(), values, n);
    if constexpr (std::is_same_v<T, double>)
      require(std::all_of(values, values + n, [](double value) { return std::isfinite(value); }), name,
              "is not finite");
  }
  std::size_t size(const std::string &name) const { return file_.size(prefix_ + name); }
  void text(const std::string &name, std::string &text) { text = file_.read_text(prefix_ + name); }

private:
  const Hdf5File &file_;
};

} // namespace latcon::output
