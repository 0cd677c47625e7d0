/// Study files: runs of a parameter sweep, and claims about them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace latcon::study
{

/// Entries of a case with their values, in the order of their first occurrence.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Entry that the seeds of a run set.
inline constexpr const char *seed_entry = "Lattice/noise seed";

/// Overrides values in `settings` by those in `others`, and adds missing entries.
void override_settings(Settings &settings, const Settings &others);

/// Run of a study: a case that is run once per seed.
struct StudyRun
{
  std::string name; ///< letters, digits, `.`, `_`, `-`: first part of the name of its folders
  std::string about;
  Settings own;                     ///< changes of this run to the base case
  Settings all;                     ///< settings of the study, overridden by `own`
  std::vector<std::uint64_t> seeds; ///< seeds of the noise: distinct, at least one
  bool is_swept = false;            ///< true for a combination of the values of sweeps, and between those
  std::size_t level = 0;            ///< of refinement; 0: in the file
  bool on_continuum = false;        ///< true: the finite elements break, not the lattice
};

/// Rule of a row. Each rule except `reported` is the key of that name in the file, with blanks for underscores.
enum class Rule
{
  reported,      ///< no rule: informational
  is,            ///< every seed has the pattern
  is_near,       ///< |mean / bound - 1| <= tolerance
  above,         ///< mean >= bound
  below,         ///< mean <= bound
  rises,         ///< means rise along `against`
  falls,         ///< means fall along `against`
  bracket,       ///< one pattern at small values of `against`, another at large values
  onset_exponent ///< |exponent of fit_onset() along `against` - bound| <= tolerance, with 95 % confidence
};

/// Returns true for the rules about runs along an abscissa, which need `against` and two runs or more.
[[nodiscard]] constexpr bool is_along(Rule rule)
{
  return rule == Rule::rises || rule == Rule::falls || rule == Rule::bracket || rule == Rule::onset_exponent;
}

/// Statement about one quantity of one or more runs.
struct StudyRow
{
  std::string place;             ///< position in the file, for messages
  std::vector<std::string> runs; ///< at least one
  std::string quantity;
  Rule rule = Rule::reported;
  std::string pattern;  ///< of `is`
  std::string from, to; ///< of `bracket`: patterns at small and at large values
  /// Of `is near`, `above`, `below`, in the SI unit of the quantity; the exponent of `onset exponent`.
  double bound = 0.;
  std::string bound_run;    ///< run whose mean is the bound instead; empty if there is none
  double tolerance = 0.;    ///< of `is near`, relative; of `onset exponent`, absolute
  std::string against;      ///< "zeta" or an entry `Section/Name`; empty if there is none
  std::string against_unit; ///< SI unit of `against`, "1" for a pure number
  std::string unit() const; ///< returns the SI unit of the quantity; "1" for the pattern, whose number is a fraction
};

/// Claim of a source, and the rows that test it.
struct StudyClaim
{
  std::string claim; ///< short title
  std::string paper; ///< statement of the source; empty if there is none
  std::string note;
  std::vector<StudyRow> rows;
};

/// Study in one of its two sizes.
struct Study
{
  std::string file; ///< name for messages
  std::string title;
  std::string base;  ///< path of the case
  Settings settings; ///< of the whole study, for all runs
  std::vector<StudyRun> runs;
  std::vector<std::string> swept;    ///< entries that `sweep` varies
  std::size_t refine = 0;            ///< number of refinements of the sweep, see refined_runs()
  std::vector<std::string> left_out; ///< runs of the file that the quick version omits
  std::vector<StudyClaim> claims;
  std::vector<std::string> pictures; ///< runs whose sheet and near-tip fields are shown

  /// Returns the run with this name. @throws std::logic_error if there is none
  const StudyRun &run(const std::string &name) const;
};

/// Returns the SI unit of an entry of a case: "1" for a pure number, empty for entries that are not quantities.
/// @throws std::logic_error if the entry does not exist
[[nodiscard]] std::string entry_unit(const std::string &key);

/// Returns the sorted names of the shipped studies, which are in the data folder.
[[nodiscard]] std::vector<std::string> shipped_studies();

/// Describes the studies that a user can give.
[[nodiscard]] std::string study_choices();

/// Returns the path of the study given by a user: a file, or a shipped study without folder and extension.
[[nodiscard]] std::string study_path(const std::string &name);

/// Reads a study (docs/reference.md, "Studies").
/// @param text content of the file
/// @param path name of the file; the base case is relative to its folder
/// @param quick true for the small version
/// @throws InputError with all problems and their positions: unknown or missing keys, values of another type or out of
/// range, unknown runs, quantities and case entries
[[nodiscard]] Study read_study(const std::string &text, const std::string &path, bool quick);

/// Reads a study from its file. @throws InputError, also if the file cannot be read
[[nodiscard]] Study read_study_file(const std::string &path, bool quick);

} // namespace latcon::study
