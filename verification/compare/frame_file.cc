#include "verification/compare/frame_file.h"

#include <algorithm>
#include <cmath>

#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include "support/errors.h"
#include "support/full_precision.h"
#include "verification/compare/quiet_vtk.h"

namespace latcon::compare
{
namespace
{

namespace fs = std::filesystem;

Side other(Side side)
{
  return side == Side::lattice ? Side::continuum : Side::lattice;
}

std::string extension(const fs::path &path)
{
  return path.extension().string();
}

bool is_frame_of(const fs::path &path, Side side)
{
  return side == Side::lattice ? extension(path) == ".vtp" : extension(path) == ".vtu" || extension(path) == ".pvtu";
}

std::string kinds_of(Side side)
{
  return side == Side::lattice ? ".vtp" : ".vtu or .pvtu";
}

[[noreturn]] void fail(const fs::path &path, const std::string &problem)
{
  throw support::InputError(path.string() + ": " + problem);
}

void require_side(const fs::path &path, Side side)
{
  if (is_frame_of(path, side))
    return;
  if (is_frame_of(path, other(side)))
    fail(path, "a " + to_string(other(side)) + " frame where a " + to_string(side) +
                 " frame is expected: give the lattice first, then the continuum");
  fail(path, "not a " + to_string(side) + " frame: give a " + kinds_of(side) + " file, a .pvd or an output directory");
}

struct Entry
{
  double time;
  fs::path path;
};

std::vector<Entry> read_series(const fs::path &path)
{
  QuietVtk quiet;
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  if (root == nullptr)
    fail(path, "not XML, or truncated");
  vtkXMLDataElement *const collection = root->FindNestedElementWithName("Collection");
  if (collection == nullptr)
    fail(path, "not a series of frames: it has no element Collection");
  std::vector<Entry> entries;
  for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i)
  {
    vtkXMLDataElement *const data_set = collection->GetNestedElement(i);
    double time = 0.;
    const char *const file = data_set->GetAttribute("file");
    if (file == nullptr || data_set->GetScalarAttribute("timestep", time) != 1 || !std::isfinite(time))
      fail(path, "a DataSet lacks its timestep or its file");
    entries.push_back({time, path.parent_path() / file});
  }
  if (entries.empty())
    fail(path, "contains no frames");
  std::stable_sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) { return a.time < b.time; });
  return entries;
}

FrameFile pick(const fs::path &series, Side side, std::optional<double> time)
{
  const std::vector<Entry> entries = read_series(series);
  FrameFile frame;
  for (const Entry &entry : entries)
    frame.times.push_back(entry.time);
  const double wanted = time.value_or(entries.back().time);
  std::vector<Entry> found;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(found),
               [&](const Entry &entry) { return is_same_time(entry.time, wanted); });
  if (found.empty())
  {
    std::vector<double> nearest = frame.times;
    std::stable_sort(nearest.begin(), nearest.end(),
                     [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
    nearest.resize(std::min<std::size_t>(nearest.size(), 3));
    std::sort(nearest.begin(), nearest.end());
    fail(series, "no frame at " + support::full_precision(wanted) + "; the nearest are at " + list_of_times(nearest));
  }
  if (found.size() > 1)
    fail(series, std::to_string(found.size()) + " files at the time " + support::full_precision(wanted) +
                   ": give one of these files");
  frame.path = found.front().path;
  frame.time = found.front().time;
  frame.chosen = time.has_value();
  require_side(frame.path, side);
  if (!fs::is_regular_file(frame.path))
    fail(frame.path, "does not exist, but " + series.string() + " refers to it");
  return frame;
}

} // namespace

std::string to_string(Side side)
{
  return side == Side::lattice ? "lattice" : "continuum";
}

bool is_same_time(double one, double other)
{
  return std::abs(one - other) <= time_tolerance * std::max(std::abs(one), std::abs(other));
}

FrameFile find_frame(const std::string &name, Side side, std::optional<double> time)
{
  const fs::path path(name);
  if (fs::is_directory(path))
  {
    const fs::path series = path / (to_string(side) + ".pvd");
    if (fs::is_regular_file(series))
      return pick(series, side, time);
    const bool swapped = fs::is_regular_file(path / (to_string(other(side)) + ".pvd"));
    fail(path,
         "contains no " + series.filename().string() +
           (swapped ? ", but a " + to_string(other(side)) + ".pvd: give the lattice first, then the continuum" : ""));
  }
  if (!fs::is_regular_file(path))
    fail(path, "no such file");
  if (extension(path) == ".pvd")
    return pick(path, side, time);
  require_side(path, side);
  FrameFile frame;
  frame.path = path;
  frame.chosen = time.has_value();
  return frame;
}

std::string list_of_times(const std::vector<double> &times)
{
  constexpr std::size_t ends = 4; // shown at each end of a long list
  std::string text;
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    if (times.size() > 2 * ends + 1 && i == ends)
    {
      text += ", ...";
      i = times.size() - ends;
    }
    text += (i == 0 ? "" : ", ") + support::full_precision(times[i]);
  }
  return text;
}

} // namespace latcon::compare
