/// Why a run of latcon ended: exit codes, and the exceptions that carry them up to main.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace latcon::support
{

/// Exit status of the program. The values are part of the command line's contract.
enum class ExitCode : int
{
  done = 0,           ///< finished, and every claim that was checked holds
  internal_error = 1, ///< a defect of latcon itself
  bad_input = 2,      ///< a case, an option or a file that was read is wrong
  claim_failed = 3,   ///< lattice, continuum and theory do not agree
  solver_failed = 4,  ///< a solver did not converge, or the state blew up
  output_failed = 5,  ///< a file could not be written
  interrupted = 130   ///< stopped by a signal, with the state saved
};

/// What every exception of this kind has in common: a message for the user, and the status to exit with.
class Error : public std::runtime_error
{
public:
  Error(const ExitCode exit_code, const std::string &message) : std::runtime_error(message), exit_code_(exit_code) {}

  /// The status the program should end with.
  [[nodiscard]] ExitCode exit_code() const noexcept { return exit_code_; }

private:
  ExitCode exit_code_;
};

/// The user's input is wrong. Carries every problem found, so that one run is enough to mend them all.
class InputError : public Error
{
public:
  /// A single problem.
  explicit InputError(const std::string &problem) : InputError(std::vector<std::string>{problem}) {}

  /// @param problems one line each, in the order in which they should be read; what() joins them by line breaks.
  explicit InputError(std::vector<std::string> problems)
    : Error(ExitCode::bad_input, joined(problems)), problems_(std::move(problems))
  {
  }

  /// The problems, one line each.
  [[nodiscard]] const std::vector<std::string> &problems() const noexcept { return problems_; }

private:
  static std::string joined(const std::vector<std::string> &problems)
  {
    std::string text;
    for (const std::string &problem : problems)
      text += (text.empty() ? "" : "\n") + problem;
    return text;
  }

  std::vector<std::string> problems_;
};

/// A claim that the run depends on does not hold.
class ClaimFailed : public Error
{
public:
  explicit ClaimFailed(const std::string &message) : Error(ExitCode::claim_failed, message) {}
};

/// A solver did not converge, or the state became unphysical or not finite.
class SolverError : public Error
{
public:
  explicit SolverError(const std::string &message) : Error(ExitCode::solver_failed, message) {}
};

/// A file could not be written; what was there before is whole.
class OutputError : public Error
{
public:
  /// @param place the file that was to be written @param reason why it was not, usually the system's own words
  OutputError(const std::filesystem::path &place, const std::string &reason)
    : Error(ExitCode::output_failed, "cannot write " + place.string() + ": " + reason)
  {
  }
};

/// The run was stopped from outside, and what is needed to go on has been written.
class Interrupted : public Error
{
public:
  explicit Interrupted(const std::string &message) : Error(ExitCode::interrupted, message) {}
};

/// Another process writes to the folder.
class FolderInUse : public std::runtime_error
{
public:
  /// @param owner process and machine, as the lock file names them; empty: not known
  FolderInUse(const std::filesystem::path &folder, const std::string &owner);
};

} // namespace latcon::support
