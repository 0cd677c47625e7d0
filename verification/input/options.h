#pragma once

#include <string>
#include <vector>

namespace latcon::input
{

/// What the command line said, whatever the command.
struct Options
{
  std::vector<std::string> arguments; ///< argv, for the record
  std::vector<std::string> overrides; ///< `Section/Name=value`
  std::string case_file;
  bool case_is_given = false; ///< the case is the user's: a file or entries of it were named
  std::string output_dir = "output";
  std::vector<std::string> claims; ///< none: all
  unsigned int threads = 0;        ///< 0: as many cores as this process may use
  bool quick = false;
  bool quiet = false;
  bool verbose = false;
  bool dry_run = false;
  bool skip_verification = false;
  bool no_report = false; ///< of a crack: neither pictures nor page
  bool resume = false;    ///< go on from the last checkpoint; of a study: take the runs that are there
};

} // namespace latcon::input
