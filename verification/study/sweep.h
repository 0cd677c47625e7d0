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
