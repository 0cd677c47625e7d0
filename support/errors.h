/// Exit codes, and exceptions that carry them to main.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace latcon::support
{

/// Exit status of the program. The values are part of the command-line interface.
enum class ExitCode : int
{
  done = 0,           ///< finished; all checked claims hold
  internal_error = 1, ///< a defect of latcon itself
  bad_input = 2,      ///< invalid case, option or input file
  claim_failed = 3,   ///< lattice, continuum and theory do not agree
  solver_failed = 4,  ///< a solver did not converge, or the state diverged
  output_failed = 5,  ///< a file could not be written
  interrupted = 130   ///< stopped by a signal, with the state saved
};

/// Base class of exceptions that end a run, with a message for the user and an exit status.
class Error : public std::runtime_error
{
public:
  Error(const ExitCode exit_code, const std::string &message) : std::runtime_error(message), exit_code_(exit_code) {}

  /// Returns the exit status of the program.
  [[nodiscard]] ExitCode exit_code() const noexcept { return exit_code_; }

private:
  ExitCode exit_code_;
};

/// Invalid input. Contains all problems that were found, so that the user can fix them at once.
class InputError : public Error
{
public:
  /// Creates an error with a single problem.
  explicit InputError(const std::string &problem) : InputError(std::vector<std::string>{problem}) {}

  /// Creates an error with several problems. @param problems one line each, in the order of the output; what() joins
  /// them with line breaks
  explicit InputError(std::vector<std::string> problems)
    : Error(ExitCode::bad_input, join_lines(problems)), problems_(std::move(problems))
  {
  }

  /// Returns the problems, one line each.
  [[nodiscard]] const std::vector<std::string> &problems() const noexcept { return problems_; }

private:
  static std::string join_lines(const std::vector<std::string> &problems)
  {
    std::string text;
    for (const std::string &problem : problems)
      text += (text.empty() ? "" : "\n") + problem;
    return text;
  }

  std::vector<std::string> problems_;
};

/// Claim on which the run depends and that does not hold.
class ClaimFailed : public Error
{
public:
  explicit ClaimFailed(const std::string &message) : Error(ExitCode::claim_failed, message) {}
};

/// Solver that did not converge, or a state that became unphysical or not finite.
class SolverError : public Error
{
public:
  explicit SolverError(const std::string &message) : Error(ExitCode::solver_failed, message) {}
};

/// File that could not be written; an existing file is unchanged.
class OutputError : public Error
{
public:
  /// @param place file to write @param reason cause, usually the message of the operating system
  OutputError(const std::filesystem::path &place, const std::string &reason)
    : Error(ExitCode::output_failed, "cannot write " + place.string() + ": " + reason)
  {
  }
};

} // namespace latcon::support
