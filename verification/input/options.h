#pragma once

#include <string>
#include <vector>

namespace latcon::input
{

/// Options of the command line, of all commands.
struct Options
{
  std::vector<std::string> arguments; ///< argv, for the record
  std::vector<std::string> overrides; ///< `Section/Name=value`
  std::string case_file;
  bool case_is_given = false;      ///< the user named a case
  bool laws_of_case = false;       ///< judge the laws on which the case relies, and report the others
  std::string output_dir;          ///< empty until the command has chosen its default
  std::vector<std::string> claims; ///< none: all
  unsigned int threads = 0;        ///< 0: as many cores as this process may use
  bool quick = false;
  bool quiet = false;
  bool verbose = false;
  bool dry_run = false;
  bool yes = false; ///< run also what would be refused for its cost
  bool skip_verification = false;
  bool no_report = false;    ///< draw neither pictures nor page
  bool resume = false;       ///< continue from the last checkpoint; keep the finished runs of a study
  bool on_continuum = false; ///< run the crack of the nonlocal continuum instead of that of the lattice
};

} // namespace latcon::input
