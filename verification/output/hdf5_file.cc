#include "verification/output/hdf5_file.h"

#include <algorithm>
#include <map>
#include <type_traits>
#include <typeindex>

#include <hdf5.h>

namespace latcon::output
{
namespace
{

static_assert(std::is_same_v<hid_t, std::int64_t>);

using Handle = Hdf5Handle;

void require(herr_t status, const std::string &what)
{
  if (status < 0)
    throw Hdf5Error(what);
}

hid_t open_file(const std::string &path)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // no messages: exceptions report errors
  return H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
}

// Type of the elements in the file and in memory: the machines that latcon supports are little-endian.
hid_t type_of(const std::type_info &type)
{
  static const std::map<std::type_index, hid_t> types{
    {typeid(double), H5T_IEEE_F64LE},       {typeid(std::int32_t), H5T_STD_I32LE},
    {typeid(std::int64_t), H5T_STD_I64LE},  {typeid(std::uint8_t), H5T_STD_U8LE},
    {typeid(std::uint16_t), H5T_STD_U16LE}, {typeid(std::uint32_t), H5T_STD_U32LE},
    {typeid(std::uint64_t), H5T_STD_U64LE}};
  return types.at(type);
}

// Links to other files are not followed: arrays must be in the file itself.
herr_t refuse_other_file(const char *, const char *, const char *, const char *, unsigned *, hid_t, void *)
{
  return -1;
}

Handle open_array(hid_t file, const std::string &path)
{
  const std::string what = "it has no `" + path + "`";
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, what);
  require(H5Pset_elink_cb(access, refuse_other_file, nullptr), what);
  return {H5Dopen2(file, path.c_str(), access), H5Dclose, what};
}

// Returns the number of elements of a contiguous array inside the file. Checks the stated size against the file,
// because the caller allocates memory for it.
std::size_t size_of(hid_t file, hid_t array, const std::string &path)
{
  const std::string none = "`" + path + "` has no size";
  const Handle space(H5Dget_space(array), H5Sclose, none);
  const Handle type(H5Dget_type(array), H5Tclose, none);
  const Handle creation(H5Dget_create_plist(array), H5Pclose, none);
  if (H5Sget_simple_extent_type(space) != H5S_SIMPLE || H5Sget_simple_extent_ndims(space) != 1)
    throw Hdf5Error("`" + path + "` is not a one-dimensional array");
  if (H5Pget_layout(creation) != H5D_CONTIGUOUS || H5Pget_external_count(creation) != 0)
    throw Hdf5Error("`" + path + "` is not stored contiguously in the file");
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  hsize_t bytes = 0;
  if (n < 0 || H5Fget_filesize(file, &bytes) < 0)
    throw Hdf5Error(none);
  if (static_cast<hsize_t>(n) > bytes / std::max<std::size_t>(1, H5Tget_size(type)))
    throw Hdf5Error("`" + path + "` is larger than the file");
  return static_cast<std::size_t>(n);
}

void write_array(hid_t file, const std::string &path, hid_t type, const void *elements, std::size_t n)
{
  const std::string what = "cannot write `" + path + "`";
  const hsize_t extent = n;
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, what);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, what);
  require(H5Pset_create_intermediate_group(links, 1), what);
  const Handle array(H5Dcreate2(file, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, what);
  if (n > 0)
    require(H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements), what);
}

} // namespace

Hdf5Handle::Hdf5Handle(std::int64_t id, int (*close)(std::int64_t), const std::string &otherwise)
  : id_(id), close_(close)
{
  if (id < 0)
    throw Hdf5Error(otherwise);
}

Hdf5Image::Hdf5Image()
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string what = "HDF5 cannot create a file in memory";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  constexpr std::size_t increment = 1U << 20U;
  require(H5Pset_fapl_core(access, increment, 0), what);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  require(H5Pset_userblock(creation, user_block), what);
  file_.emplace(H5Fcreate("checkpoint", H5F_ACC_TRUNC, creation, access), H5Fclose, what);
}

void Hdf5Image::write(const std::string &path, const std::type_info &type, const void *elements, std::size_t n)
{
  write_array(*file_, path, type_of(type), elements, n);
}

void Hdf5Image::write_text(const std::string &path, const std::string &text)
{
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot write `" + path + "`");
  require(H5Tset_size(type, text.size() + 1), "cannot write `" + path + "`"); // including the terminating zero
  require(H5Tset_cset(type, H5T_CSET_UTF8), "cannot write `" + path + "`");
  write_array(*file_, path, type, text.c_str(), 1);
}

std::string Hdf5Image::take_bytes()
{
  const std::string what = "HDF5 cannot return the bytes of a file in memory";
  require(H5Fflush(*file_, H5F_SCOPE_GLOBAL), what);
  const ssize_t size = H5Fget_file_image(*file_, nullptr, 0);
  if (size < 0)
    throw Hdf5Error(what);
  // The image starts after the user block.
  std::string bytes(user_block + static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(*file_, &bytes[user_block], static_cast<std::size_t>(size)) != size)
    throw Hdf5Error(what);
  file_.reset();
  return bytes;
}

Hdf5File::Hdf5File(const std::string &path) : file_(open_file(path), H5Fclose, "it is not an HDF5 file") {}

std::size_t Hdf5File::size(const std::string &path) const
{
  return size_of(file_, open_array(file_, path), path);
}

void Hdf5File::read(const std::string &path, const std::type_info &type, void *elements, std::size_t n) const
{
  const Handle array = open_array(file_, path);
  const Handle stored(H5Dget_type(array), H5Tclose, "`" + path + "` has no type");
  if (H5Tequal(stored, type_of(type)) <= 0)
    throw Hdf5Error("`" + path + "` has another type");
  if (size_of(file_, array, path) != n)
    throw Hdf5Error("`" + path + "` has another size");
  if (n > 0)
    require(H5Dread(array, type_of(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, elements), "cannot read `" + path + "`");
}

std::string Hdf5File::read_text(const std::string &path) const
{
  const Handle array = open_array(file_, path);
  const Handle type(H5Dget_type(array), H5Tclose, "`" + path + "` has no type");
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    throw Hdf5Error("`" + path + "` is not a text");
  if (size_of(file_, array, path) != 1)
    throw Hdf5Error("`" + path + "` is not a single text");
  std::string text(H5Tget_size(type), '\0');
  require(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "cannot read `" + path + "`");
  if (text.find('\0') != text.size() - 1) // the terminating zero
    throw Hdf5Error("`" + path + "` has a zero byte before its end");
  text.pop_back();
  return text;
}

} // namespace latcon::output
