/// Sweeps: values of entries on the command line or in a study file, and their combinations.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "verification/study/study_file.h"

namespace latcon::study
{

/// Values of one entry of a case.
struct Sweep
{
  std::string entry;               ///< `Section/Name`
  std::vector<std::string> values; ///< at least two, distinct (numbers in SI), as a case file would hold them
};

/// Parses `Section/Name=START:STOP:COUNT`, COUNT values at equal distances with both ends, or
/// `Section/Name=VALUE,VALUE,...`. Both ends of a grid have the same unit, or none (SI).
/// @throws InputError that names the wrong part
[[nodiscard]] Sweep parse_sweep(const std::string &text);

/// Name of the study file that a sweep leaves in its output directory.
inline constexpr const char *sweep_file_name = "sweep.json";

/// One combination of the values of several sweeps.
struct SweptCase
{
  /// Name of the run, formed from the values, such as "strain-y-1.5_height-2cm". A name that is too long, or that an
  /// earlier combination has, is cut, and ends in 16 digits of the SHA-256 of the settings.
  std::string name;
  Settings set;
};

/// Largest number of letters of the name of a run of a sweep, which is the name of a folder.
inline constexpr std::size_t max_name_length = 150;

/// Returns the case with one value of each sweep. @param at index of the value of each sweep
[[nodiscard]] SweptCase combination(const std::vector<Sweep> &sweeps, const std::vector<std::size_t> &at);

/// Formats a number with twelve digits, as the values of a grid: 1.7 instead of 1.7000000000000002.
[[nodiscard]] std::string plain_number(double number);

/// Returns true if all values of a sweep are numbers between which there are others: not whole numbers or words.
[[nodiscard]] bool is_continuous(const Sweep &sweep);

/// All combinations of values; those of the last sweep vary fastest. Names are distinct.
/// @param n_seeds number of seeds of each combination
/// @throws InputError for an entry that is swept twice, or more than 100,000 runs
[[nodiscard]] std::vector<SweptCase> combinations(const std::vector<Sweep> &sweeps, std::size_t n_seeds);

/// Text of a study file that runs sweeps.
/// @param sweeps at least one, as in parse_sweep()
/// @param case_name name of the case for the title
/// @param base path of the case, relative to the study file
/// @param settings of all runs
/// @param n_seeds seeds are 1 to n_seeds; 0: 1
/// @throws InputError for a sweep that is wrong, or of an entry that is also set
[[nodiscard]] std::string sweep_study(const std::vector<std::string> &sweeps, const std::string &case_name,
                                      const std::string &base, const Settings &settings, std::size_t n_seeds);

} // namespace latcon::study
