#include "verification/output/checkpoints.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>

#include "support/folder_lock.h"
#include "support/ranks.h"
#include "support/text_wrap.h"
#include "verification/input/case.h"
#include "verification/input/files.h"
#include "verification/input/options.h"
#include "verification/input/parameters.h"
#include "verification/output/output_file.h"
#include "verification/output/run_info.h"

namespace latcon::output
{
namespace
{

namespace fs = std::filesystem;

constexpr int schema = 5; // of the content of a file; other schemas cannot be read
constexpr std::size_t n_kept = 2;
constexpr std::size_t max_reported_differences = 3;
const std::string first_words = "latcon checkpoint, SHA-256 of the bytes from 512 on: ";

std::map<std::string, std::string> entries_of(const std::string &lines)
{
  std::map<std::string, std::string> entries;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);)
    if (const std::size_t middle = line.find(" = "); middle != std::string::npos)
      entries[line.substr(0, middle)] = line.substr(middle + 3);
  return entries;
}

// Describes the entries in which two cases differ.
std::string differences(const std::string &there, const std::string &here)
{
  const std::map<std::string, std::string> theirs = entries_of(there), ours = entries_of(here);
  std::vector<std::string> found;
  for (const auto &[key, value] : ours)
  {
    const auto other = theirs.find(key);
    if (other == theirs.end() || other->second != value)
      found.push_back(key + " = " + (other == theirs.end() ? "(none)" : other->second) + " in the checkpoint, " +
                      value + " in this case");
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(found.size(), max_reported_differences); ++i)
    text += (i > 0 ? "; " : "") + found[i];
  if (found.size() > max_reported_differences)
    text += "; and " + std::to_string(found.size() - max_reported_differences) + " more";
  return text.empty() ? "unknown entries" : text;
}

// Returns the hash in the first line of a file; empty if the file is not a checkpoint.
std::string hash_in(const fs::path &path)
{
  std::ifstream in(path, std::ios::binary);
  std::string line;
  std::getline(in, line);
  return in && line.rfind(first_words, 0) == 0 ? line.substr(first_words.size()) : "";
}

std::string name_of(std::size_t step)
{
  return support::formatted("checkpoint-%012zu.h5", step);
}

} // namespace

Checkpoints::Checkpoints(const input::Options &options, const input::Parameters &parameters, const input::Case &input,
                         std::string command)
  : folder_(fs::path(options.output_dir) / "checkpoints"), command_(std::move(command)),
    case_text_(input::case_lines(parameters)), case_hash_(input::sha256(case_text_)),
    step_interval_(input.checkpoint_steps), wall_interval_(input.checkpoint_interval),
    first_rank_(support::is_root_rank())
{
  if (!options.resume)
    return;
  std::string problems;
  CheckpointPlace best;
  if (first_rank_)
  {
    for (const fs::path &path : files())
    {
      CheckpointPlace place;
      const std::string problem = problem_of(path, place);
      if (!problem.empty())
        problems += (problems.empty() ? "" : "\n") + path.string() + ": " + problem;
      else if (best.file.empty() || place.step > best.step)
        best = place;
    }
  }
  best.file = support::broadcast(best.file.string());
  best.step = support::broadcast(best.step);
  best.time = support::broadcast(best.time);
  for (std::string *text : {&best.commit, &best.program_hash, &problems})
    *text = support::broadcast(*text);
  if (!best.file.empty())
  {
    found_ = best;
    last_step_asked_ = best.step;
  }
  else if (!problems.empty())
    throw support::InputError("there is no usable checkpoint; to start from the beginning omit --resume\n" + problems);
  if (first_rank_ && !problems.empty())
    std::fprintf(stderr, "latcon: %s\n", problems.c_str());
}

std::vector<fs::path> Checkpoints::files() const
{
  std::vector<fs::path> found;
  std::error_code none;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder_, none))
    if (entry.path().extension() == ".h5")
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Returns the reason why a file cannot be used; empty if it can.
std::string Checkpoints::problem_of(const fs::path &path, CheckpointPlace &place) const
{
  const std::string hash = hash_in(path);
  if (hash.empty())
    return "it is not a checkpoint";
  if (input::sha256_of_file(path, Hdf5Image::user_block) != hash)
    return "it was changed or damaged after it was written: its checksum does not match";
  try
  {
    const Hdf5File file(path);
    CheckpointReader archive(file);
    int its_schema = 0;
    archive("run/schema", its_schema);
    if (its_schema != schema)
      return "it has schema " + std::to_string(its_schema) + ", this program reads " + std::to_string(schema);
    std::string text;
    archive("run/command", text);
    if (text != command_)
      return "it was written by `latcon " + text + "`, this is `latcon " + command_ + "`";
    archive("run/case", text);
    if (text != case_text_)
      return "it was written for another case: " + differences(text, case_text_);
    archive("run/commit", place.commit);
    archive("run/program_hash", place.program_hash);
    archive("run/step", place.step);
    archive("run/time", place.time);
    place.file = path;
    return "";
  }
  catch (const std::exception &error) // of HDF5, or not enough memory for the stated size
  {
    return error.what();
  }
}

bool Checkpoints::resume(const std::function<void(CheckpointReader &)> &parts) const
{
  if (!found_)
    return false;
  try
  {
    const Hdf5File file(found_->file.string());
    CheckpointReader archive(file);
    parts(archive);
    return true;
  }
  // Any error of the parts is an error of the file, because the run itself has been set up.
  catch (const std::exception &error)
  {
    throw UnusableCheckpoint(found_->file.string() + ": it was not written by this run: " + error.what() +
                             "; to start from the beginning omit --resume");
  }
}

bool Checkpoints::due(std::size_t step)
{
  const bool by_steps = step_interval_ > 0 && step / step_interval_ > last_step_asked_ / step_interval_;
  last_step_asked_ = step;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - last_written_;
  // Clocks differ between ranks; the root rank decides.
  const bool by_time = wall_interval_ > 0. && support::broadcast(elapsed.count() >= wall_interval_ ? 1 : 0) != 0;
  return by_steps || by_time;
}

void Checkpoints::write(std::size_t step, double time, const std::function<void(CheckpointWriter &)> &parts)
{
  std::optional<Hdf5Image> image;
  if (first_rank_)
    image.emplace();
  CheckpointWriter archive(image ? &*image : nullptr);
  int its_schema = schema;
  archive("run/schema", its_schema);
  for (auto [name, text] : {std::pair<std::string, std::string>("run/program", program_version()),
                            {"run/commit", git_commit()},
                            {"run/program_hash", program_hash()},
                            {"run/command", command_},
                            {"run/case", case_text_},
                            {"run/case_hash", case_hash_}})
    archive(name, text);
  archive("run/step", step);
  archive("run/time", time);
  parts(archive);
  if (first_rank_)
  {
    std::string bytes = image->take_bytes();
    const std::string head = first_words + input::sha256(std::string_view(bytes).substr(Hdf5Image::user_block)) + "\n";
    bytes.replace(0, head.size(), head);
    std::error_code error;
    support::require_in_place(folder_);
    fs::create_directory(folder_, error); // not its parent: if the parent was removed, the run was removed
    if (error)
      throw support::OutputError(folder_.string(), error.message());
    write_file((folder_ / name_of(step)).string(), bytes);
    // The last checkpoint is complete now, so older ones can be deleted. Checkpoints of later steps belong to an
    // earlier run that continued beyond the step from which this run resumed.
    std::vector<fs::path> all = files();
    const auto written = std::find(all.begin(), all.end(), folder_ / name_of(step));
    const auto before = static_cast<std::size_t>(written - all.begin());
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i > before || i + n_kept <= before)
        fs::remove(all[i], error);
  }
  last_written_ = std::chrono::steady_clock::now();
}

} // namespace latcon::output
