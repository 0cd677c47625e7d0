#include "verification/output/output_file.h"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <system_error>

#include <fnmatch.h>

#include "support/atomic_file.h"
#include "support/errors.h"

namespace latcon::output
{
namespace
{

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// Files written by the libraries of both sides.
const Names frames{"lattice.pvd", "lattice-*.vtp", "motion.pvd", "motion-*.vtp", "continuum.pvd", "continuum_*.vtu",
                   "continuum_*.pvtu", "near_tip.vti", "near_tip_folded.vti",
                   // of the claim running-crack
                   "crack-nn-nnn-lattice.pvd", "crack-nn-nnn-lattice-*.vtp", "crack-nn-nnn-local.pvd",
                   "crack-nn-nnn-local_*.vtu", "crack-nn-nnn-gradient.pvd", "crack-nn-nnn-gradient_*.vtu",
                   "crack-nn-lattice.pvd", "crack-nn-lattice-*.vtp", "crack-nn-local.pvd", "crack-nn-local_*.vtu",
                   "crack-nn-gradient.pvd", "crack-nn-gradient_*.vtu"};

Names names_in(const fs::path &folder)
{
  std::ifstream in(folder / output_list_name);
  Names names;
  for (std::string line; std::getline(in, line);)
    if (!line.empty())
      names.insert(line);
  return names;
}

void write_names(const fs::path &folder, const Names &names)
{
  std::string text;
  for (const std::string &name : names)
    text += name + "\n";
  support::write_atomically(folder / output_list_name, text, support::Sync::yes);
}

// Whether a file has a name of the list, in which `*` represents digits and dots.
bool is_in(const Names &names, const fs::path &file)
{
  const auto fits = [&file](std::string name)
  {
    if (const std::size_t star = name.find('*'); star != std::string::npos)
      name.replace(star, 1, "+([0-9.])");
    return fnmatch(name.c_str(), file.filename().c_str(), FNM_EXTMATCH) == 0;
  };
  return std::any_of(names.begin(), names.end(), fits);
}

// Moves the files of these names, but for `keep`, to a folder that is made for them. @return it; empty: there are none
fs::path move_aside(const fs::path &folder, const Names &names, const fs::path &keep)
{
  try
  {
    std::vector<fs::path> files; // the list is not in itself
    std::error_code none;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder))
      if (entry.is_regular_file() && !entry.is_symlink() && is_in(names, entry.path()) &&
          !fs::equivalent(entry.path(), keep, none))
        files.push_back(entry.path());
    if (files.empty())
      return {};
    // Last, since it tells whose the others are.
    std::partition(files.begin(), files.end(), [](const fs::path &file) { return file.filename() != "run.json"; });
    fs::path aside = folder / "earlier-run"; // or the first name that is free
    for (int i = 2; fs::exists(fs::symlink_status(aside)); ++i)
      aside = folder / ("earlier-run-" + std::to_string(i));
    fs::create_directory(aside);
    for (const fs::path &file : files)
      fs::rename(file, aside / file.filename());
    write_names(aside, names);
    return aside;
  }
  catch (const fs::filesystem_error &error)
  {
    throw support::OutputError(folder.string(),
                               std::string("files that would be replaced cannot be moved: ") + error.what());
  }
}

// Files of names that were not in the list are not latcon's: they are moved aside.
void add_to_list(const fs::path &folder, const Names &added)
{
  Names names = names_in(folder), further;
  std::set_difference(added.begin(), added.end(), names.begin(), names.end(), std::inserter(further, further.end()));
  if (further.empty())
    return;
  if (const fs::path aside = move_aside(folder, further, {}); !aside.empty())
    std::cerr << "latcon: files in " << folder.string() << " that latcon did not write are now in " << aside.string()
              << std::endl;
  names.merge(further);
  write_names(folder, names);
}

} // namespace

bool is_listed_output(const fs::path &file)
{
  return is_in(names_in(file.parent_path()), file);
}

void begin_output_list(const fs::path &folder)
{
  add_to_list(folder, frames);
}

void write_file(const std::string &path, const std::string &text)
{
  const fs::path file = path, folder = file.parent_path();
  if (std::error_code none; fs::exists(folder / output_list_name, none))
    add_to_list(folder, {file.filename().string()});
  support::write_atomically(path, text, support::Sync::yes);
}

void write_files(const TextFiles &files)
{
  for (const auto &[path, text] : files)
    write_file(path, text);
}

fs::path archive_earlier_output(const fs::path &folder, const fs::path &keep)
{
  const fs::path checkpoints = folder / "checkpoints", aside = folder / "checkpoints.old";
  std::error_code error;
  fs::directory_iterator files(checkpoints, error);
  // First, so that a run that is killed between leaves no checkpoint without the frames before it.
  if (std::any_of(begin(files), end(files), [](const auto &file) { return file.path().extension() == ".h5"; }))
  {
    fs::remove_all(aside, error);
    fs::rename(checkpoints, aside, error);
    if (error)
      throw support::OutputError(aside.string(), error.message());
  }
  return move_aside(folder, names_in(folder), keep);
}

} // namespace latcon::output
