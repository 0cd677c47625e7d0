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
#include <optional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "verification/output/hdf5_file.h"

namespace latcon::output
{
namespace archive_detail
{

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

/// Archive that calls a function with each number of a record.
template <bool loading, class Visit>
class NumberArchive
{
public:
  static constexpr bool loads = loading;
  explicit NumberArchive(const Visit &visit) : visit_(visit) {}

  template <class T>
  void operator()(const std::string &, T &value)
  {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::uint64_t>)
      visit_(value);
    else if constexpr (is_matrix<T>)
      std::for_each(value.data(), value.data() + value.size(), visit_);
    else
      value.archive(*this);
  }

private:
  const Visit &visit_;
};

/// Common base of both archives, which decomposes objects into arrays and texts.
template <class Archive>
class Base
{
public:
  /// Archives a number, a matrix of fixed size, an object with archive(), or a range of such objects, whose size must be
  /// the same for saving and loading.
  template <class T>
  void operator()(const std::string &name, T &value)
  {
    if constexpr (std::is_same_v<T, bool>)
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
    else if constexpr (HasArchive<T, Archive>::value)
    {
      const std::string outer = prefix_;
      prefix_ += name + "/";
      value.archive(self());
      prefix_ = outer;
    }
    else
      objects(name, value);
  }

  /// Archives a text.
  void operator()(const std::string &name, std::string &text) { self().text(name, text); }

  /// Archives a number or none, as a list.
  template <class T>
  void operator()(const std::string &name, std::optional<T> &value)
  {
    std::vector<T> values;
    if (value)
      values.push_back(*value);
    (*this)(name, values);
    require(values.size() <= 1, name, "is more than one value");
    value = values.empty() ? std::nullopt : std::optional<T>(values.front());
  }

  /// Archives a list of numbers or of matrices, or objects.
  template <class T>
  void operator()(const std::string &name, std::vector<T> &values)
  {
    if constexpr (std::is_arithmetic_v<T>)
    {
      if constexpr (Archive::loads)
        values.resize(self().size(name));
      self().elements(name, values.data(), values.size());
    }
    else if constexpr (is_matrix<T>)
    {
      constexpr auto per_element = static_cast<std::size_t>(T::SizeAtCompileTime);
      static_assert(sizeof(T) == per_element * sizeof(double));
      if constexpr (Archive::loads)
      {
        const std::size_t n = self().size(name);
        require(n % per_element == 0, name, "ends with an incomplete element");
        values.resize(n / per_element);
      }
      self().elements(name, values.empty() ? nullptr : values.front().data(), per_element * values.size());
    }
    else
      objects(name, values);
  }

  /// Archives the concatenated numbers of lists, and the size of each.
  template <class Number>
  void operator()(const std::string &name, std::vector<std::vector<Number>> &all)
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

  /// Archives many small objects as one list of real numbers. Their archive() may contain only numbers and objects of
  /// numbers.
  template <class Record>
  void records(const std::string &name, std::vector<Record> &all)
  {
    std::size_t per_record = 0;
    Record any{};
    for_each_number(any, [&](const auto &) { ++per_record; });
    std::vector<double> values;
    for (Record &record : all)
      for_each_number(record, [&](const auto &number) { values.push_back(static_cast<double>(number)); });
    (*this)(name, values);
    require(values.size() % per_record == 0, name, "ends with an incomplete element");
    all.resize(values.size() / per_record);
    auto next = values.begin();
    for (Record &record : all)
      for_each_number(record,
                      [&](auto &number)
                      {
                        using Number = std::decay_t<decltype(number)>;
                        require(std::is_same_v<Number, double> ||
                                  (*next >= 0. && *next <= 0x1p53 && std::floor(*next) == *next),
                                name, "has a part where a whole number should be");
                        number = static_cast<Number>(*next++);
                      });
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

  template <class Record, class Visit>
  static void for_each_number(Record &record, const Visit &visit)
  {
    NumberArchive<Archive::loads, Visit> archive(visit);
    record.archive(archive);
  }

  template <class Range>
  void objects(const std::string &name, Range &range)
  {
    std::size_t n = range.size();
    (*this)(name + "/n", n);
    require(range.size() == n, name, "has another number of objects");
    std::size_t i = 0;
    for (auto &element : range)
      (*this)(name + "/" + std::to_string(i++), element);
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
      image_->write(prefix_ + name, typeid(T), values, n);
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
    file_.read(prefix_ + name, typeid(T), values, n);
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
