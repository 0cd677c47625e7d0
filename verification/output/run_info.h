/// Provenance of a run: program, libraries, times.
#pragma once

#include "support/errors.h"

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace latcon::output
{

/// Wall times of named phases. Times of repeated phases add up. Phases may overlap. Thread-safe.
class Stopwatch
{
public:
  /// Starts a phase, which lasts as long as what is returned: `const auto phase = stopwatch.phase("assembly");`, ended
  /// early by `phase.reset()`. The stopwatch must outlive it.
  [[nodiscard]] std::shared_ptr<void> phase(const std::string &name);

  /// Adds a time [s] measured elsewhere.
  void add(const std::string &name, double seconds);

  /// Returns the phases that have ended, with their wall times [s], in the order in which they first ended.
  [[nodiscard]] std::vector<std::pair<std::string, double>> times() const;

private:
  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, double>> times_;
};

/// Returns the version of latcon, for example "1.0.0".
[[nodiscard]] std::string program_version();

/// Returns the Git commit from which the program was built, 40 digits, with the suffix "-dirty" if tracked files were
/// modified; "unknown" if it was not built in a checkout.
[[nodiscard]] std::string git_commit();

/// Returns the SHA-256 of this program, 64 hexadecimal digits: of its executable, or, if it has a module with the finite
/// elements, of the text of both their SHA-256. Reads the files at the first call.
/// @throws std::runtime_error if it cannot be read
[[nodiscard]] const std::string &program_hash();

/// Content of run.json: program, compiler, libraries, threads and ranks, times, memory, command line, outcome, and
/// entries added by the run; the name of the machine is not included. Thread-safe.
class RunInfo
{
public:
  /// Creates the content. @param command_line arguments of the program, including argv[0]
  explicit RunInfo(std::vector<std::string> command_line);

  /// Returns the wall times of the phases of this run.
  [[nodiscard]] Stopwatch &stopwatch() { return stopwatch_; }

  /// Adds a value or an object under a new key, for example add("skip_verification", true). A repeated key replaces the
  /// value. A number that is not finite becomes "nan", "inf" or "-inf".
  /// @throws std::logic_error if the key is a standard key of run.json
  void add(const std::string &key, const nlohmann::ordered_json &value);

  /// Returns the current content of run.json.
  /// @param exit_code exit code of the run; empty (null in the file) while it is running
  /// @param verdict   verdict on the claims, if any were checked
  /// @return JSON with a final line break; wall times [s], memory [bytes] of the calling process
  [[nodiscard]] std::string json(std::optional<support::ExitCode> exit_code, const std::string &verdict = "") const;

  /// Writes json() to `path`. To be called on one rank. @throws OutputError
  void write(const std::string &path, std::optional<support::ExitCode> exit_code,
             const std::string &verdict = "") const;

private:
  nlohmann::ordered_json standard_facts(std::optional<support::ExitCode> exit_code, const std::string &verdict) const;

  std::vector<std::string> command_line_;
  std::chrono::steady_clock::time_point start_;
  Stopwatch stopwatch_;
  int n_threads_; // as seen by the constructing thread
  unsigned int n_ranks_;
  mutable std::mutex mutex_; // of facts_
  std::shared_ptr<nlohmann::ordered_json> facts_; // added by the run
};

} // namespace latcon::output
