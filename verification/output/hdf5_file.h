/// The few things of HDF5 that checkpoints need: arrays of numbers and texts under paths, in one file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace latcon::output
{

/// What a file cannot give: no such path, another type or size, or no HDF5 file at all.
class Hdf5Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Types of the elements of an array; in files all are little-endian.
enum class ElementType
{
  float64,
  int32,
  int64,
  uint8,
  uint16,
  uint32,
  uint64
};

/// The one in which numbers of a type are kept.
template <class T>
constexpr ElementType element_type()
{
  static_assert(std::is_same_v<T, double> || std::is_integral_v<T>);
  if constexpr (std::is_same_v<T, double>)
    return ElementType::float64;
  else if constexpr (std::is_signed_v<T>)
  {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8);
    return sizeof(T) == 4 ? ElementType::int32 : ElementType::int64;
  }
  else
    return sizeof(T) == 1   ? ElementType::uint8
           : sizeof(T) == 2 ? ElementType::uint16
           : sizeof(T) == 4 ? ElementType::uint32
                            : ElementType::uint64;
}

/// A file that is made in memory, so that a full disk is met by who writes its bytes and never by HDF5. Groups of a
/// path are made as they are needed.
class Hdf5Image
{
public:
  Hdf5Image();
  ~Hdf5Image();
  Hdf5Image(const Hdf5Image &) = delete;
  Hdf5Image &operator=(const Hdf5Image &) = delete;

  /// Bytes before the HDF5 part that are left to the owner of the file; HDF5 calls them the user block.
  static constexpr std::size_t user_block = 512;

  /// @throws Hdf5Error if there is something at that path already, or memory is short
  void write(const std::string &path, ElementType type, const void *elements, std::size_t n);
  void write_text(const std::string &path, const std::string &text);

  /// The whole file, its user block zeros. Nothing can be written afterwards.
  std::string take_bytes();

private:
  std::int64_t file_;
};

/// A file that is read.
class Hdf5File
{
public:
  /// @throws Hdf5Error
  explicit Hdf5File(const std::string &path);
  ~Hdf5File();
  Hdf5File(const Hdf5File &) = delete;
  Hdf5File &operator=(const Hdf5File &) = delete;

  /// Number of elements of an array. @throws Hdf5Error also if the file is too small for it, or it lies in another
  std::size_t size(const std::string &path) const;

  /// Reads a whole array. @throws Hdf5Error unless it has this type and size
  void read(const std::string &path, ElementType type, void *elements, std::size_t n) const;
  /// @throws Hdf5Error unless it is one text that ends with its only zero byte
  std::string read_text(const std::string &path) const;

private:
  std::int64_t file_;
};

} // namespace latcon::output
