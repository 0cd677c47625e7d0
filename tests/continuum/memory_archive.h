#pragma once

// Archives in memory: values that a class stores, by the names of the values and of the objects that contain them.

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace memory_archive
{
using Store = std::map<std::string, std::string>; // the bytes of each value

template <bool is_loading>
class Archive
{
public:
  static constexpr bool loads = is_loading;

  Archive(Store &store, std::string prefix) : store_(store), prefix_(std::move(prefix)) {}

  template <class T>
  void operator()(const std::string &name, T &value)
  {
    if constexpr (std::is_arithmetic_v<T>)
      bytes(name, &value, 1);
    else
    {
      Archive inside(store_, prefix_ + name + "/");
      value.archive(inside);
    }
  }
  template <class T>
  void operator()(const std::string &name, std::vector<T> &values)
  {
    if constexpr (loads)
      values.resize(store_.at(prefix_ + name).size() / sizeof(T));
    bytes(name, values.data(), values.size());
  }

  template <class Record>
  void records(const std::string &name, std::vector<Record> &list)
  {
    std::size_t n = list.size();
    (*this)(name + "/size", n);
    list.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      (*this)(name + "/" + std::to_string(i), list[i]);
  }

private:
  template <class T>
  void bytes(const std::string &name, T *values, const std::size_t n)
  {
    if constexpr (loads)
    {
      const std::string &stored = store_.at(prefix_ + name);
      ASSERT_EQ(stored.size(), n * sizeof(T)) << prefix_ << name;
      std::memcpy(values, stored.data(), stored.size());
    }
    else
      store_[prefix_ + name].assign(reinterpret_cast<const char *>(values), n * sizeof(T));
  }

  Store &store_;
  std::string prefix_;
};

template <class T>
Store stored(T &object)
{
  Store store;
  Archive<false> archive(store, "");
  object.archive(archive);
  return store;
}

template <class T>
void load(Store store, T &object)
{
  Archive<true> archive(store, "");
  object.archive(archive);
}
} // namespace memory_archive
