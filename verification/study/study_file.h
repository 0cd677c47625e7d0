/// Study files: the runs of a sweep, and what is claimed of them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace latcon::study
{

/// Entries of a case and their values, in the order in which they were first given.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// The entry that the seeds of a run stand for.
inline constexpr const char *seed_entry = "Lattice/noise seed";

/// Gives entries of `settings` the values that `others` has for them, and adds those that are not there yet.
void override_settings(Settings &settings, const Settings &others);

/// A case that is run once with each of its seeds.
struct StudyRun
{
  std::string name; ///< letters, digits, `.`, `_`, `-`: the first part of a folder's name
  std::string about;
  Settings own;                     ///< what this run changes of the base case
  Settings all;                     ///< these, after those of the whole study
  std::vector<std::uint64_t> seeds; ///< of the noise; distinct, at least one
};

/// How a row is judged. Each but `reported` is the key of that name in the file, blanks for underscores.
enum class Rule
{
  reported, ///< not at all
  is,       ///< every seed has the pattern
  is_near,  ///< |mean / bound - 1| <= tolerance
  above,    ///< mean >= bound
  below,    ///< mean <= bound
  rises,    ///< means rise along `against`
  falls,    ///< means fall along `against`
  bracket   ///< one pattern at small values of `against`, another at large ones
};

/// One statement about one quantity of one or more runs.
struct StudyRow
{
  std::string place;             ///< in the file, for messages
  std::vector<std::string> runs; ///< at least one
  std::string quantity;
  Rule rule = Rule::reported;
  std::string pattern;      ///< of `is`
  std::string from, to;     ///< of `bracket`: at small and at large values
  double bound = 0.;        ///< of `is near`, `above`, `below`, in the SI unit of the quantity
  std::string bound_run;    ///< the run whose mean is the bound instead; empty if there is none
  double tolerance = 0.;    ///< of `is near`, relative
  std::string against;      ///< "zeta" or an entry `Section/Name`; empty if there is none
  std::string against_unit; ///< SI unit of `against`, "1" for a pure number
  std::string unit() const; ///< SI unit of the quantity; "1" for the pattern, whose number is a share
};

/// What a source states, and the rows that test it.
struct StudyClaim
{
  std::string claim; ///< in few words
  std::string paper; ///< what the source says; empty if there is none
  std::string note;
  std::vector<StudyRow> rows;
};

/// A study, for one of its two sizes.
struct Study
{
  std::string file; ///< as messages call it
  std::string title;
  std::string base;  ///< path of the case
  Settings settings; ///< of the whole study, for all runs
  std::vector<StudyRun> runs;
  std::vector<std::string> left_out; ///< runs of the file that the quick version does without
  std::vector<StudyClaim> claims;
  std::vector<std::string> checks;   ///< see study_checks()
  std::vector<std::string> pictures; ///< runs whose sheet and near-tip field are shown

  /// @throws std::logic_error for a name that is none of `runs`
  const StudyRun &run(const std::string &name) const;
};

/// Names of the shipped studies, sorted: those in the folder of data.
[[nodiscard]] std::vector<std::string> shipped_studies();

/// What a user may name as a study, in words.
[[nodiscard]] std::string study_choices();

/// Path of the study that a user names: a file, or a shipped study without folder and ending.
[[nodiscard]] std::string study_path(const std::string &name);

/// Reads a study (docs/reference.md, "Studies").
/// @param text content of the file
/// @param path name of the file; the base case is relative to its folder
/// @param quick whether to take the small version
/// @throws InputError with all problems: keys that are unknown or missing, values of another type or out of range,
///         runs, quantities and case entries that are not known; each with the file and the place in it
[[nodiscard]] Study read_study(const std::string &text, const std::string &path, bool quick);

/// The same from the file. @throws InputError also if it cannot be read
[[nodiscard]] Study read_study_file(const std::string &path, bool quick);

} // namespace latcon::study
