/// Minimal interface to HDF5 for checkpoints: arrays of numbers and texts under paths, in one file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <typeinfo>

namespace latcon::output
{

/// Error of an HDF5 file: not an HDF5 file, missing path, or another type or size.
class Hdf5Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Owner of a handle of HDF5.
class Hdf5Handle
{
public:
  /// @throws Hdf5Error with this text if the handle is invalid
  Hdf5Handle(std::int64_t id, int (*close)(std::int64_t), const std::string &otherwise);
  ~Hdf5Handle() { close_(id_); }
  Hdf5Handle(const Hdf5Handle &) = delete;
  Hdf5Handle &operator=(const Hdf5Handle &) = delete;
  operator std::int64_t() const { return id_; }

private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// HDF5 file in memory, so that a full disk is an error of the caller, who writes the bytes, and never of HDF5. Creates
/// the groups of a path when necessary.
class Hdf5Image
{
public:
  Hdf5Image();

  /// Size of the HDF5 user block: bytes before the HDF5 part, for use by the caller.
  static constexpr std::size_t user_block = 512;

  /// Writes an array of real numbers, or of integers, little-endian.
  /// @throws Hdf5Error if the path already exists, or if there is not enough memory
  void write(const std::string &path, const std::type_info &type, const void *elements, std::size_t n);
  void write_text(const std::string &path, const std::string &text);

  /// Returns the whole file, with zeros in its user block. Nothing can be written afterwards.
  std::string take_bytes();

private:
  std::optional<Hdf5Handle> file_; // none once its bytes are taken
};

/// HDF5 file for reading.
class Hdf5File
{
public:
  /// @throws Hdf5Error
  explicit Hdf5File(const std::string &path);

  /// Returns the number of elements of an array. @throws Hdf5Error, also if the array is larger than the file or stored
  /// in another file
  std::size_t size(const std::string &path) const;

  /// Reads a whole array. @throws Hdf5Error if the type or size differs
  void read(const std::string &path, const std::type_info &type, void *elements, std::size_t n) const;
  /// Reads a text. @throws Hdf5Error unless it is a single text whose only zero byte is at its end
  std::string read_text(const std::string &path) const;

private:
  Hdf5Handle file_;
};

} // namespace latcon::output
