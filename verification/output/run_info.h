/// How a run came about: program, machine, times.
#pragma once

#include "support/errors.h"

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace latcon::output
{

/// Wall time spent in named phases. A phase may be entered again: its times add up. Phases may overlap. Threads may
/// share a stopwatch.
class Stopwatch
{
public:
  /// Runs from its construction until its destruction or stop(); the stopwatch must outlive it.
  class Phase
  {
  public:
    Phase(Stopwatch &stopwatch, std::string name);
    ~Phase();
    Phase(const Phase &) = delete;
    Phase &operator=(const Phase &) = delete;

    /// Ends the phase early; a second call does nothing.
    void stop();

  private:
    Stopwatch *stopwatch_; // null once stopped
    std::string name_;
    std::chrono::steady_clock::time_point start_;
  };

  /// Starts a phase: `const auto phase = stopwatch.phase("assembly");`
  [[nodiscard]] Phase phase(const std::string &name) { return Phase(*this, name); }

  /// Adds a time [s] measured elsewhere.
  void add(const std::string &name, double seconds);

  /// Phases that have ended, with their wall times [s], in the order in which they first ended.
  [[nodiscard]] std::vector<std::pair<std::string, double>> times() const;

private:
  mutable std::mutex mutex_;
  std::vector<std::pair<std::string, double>> times_;
};

/// Version of latcon, e.g. "0.1.0".
[[nodiscard]] std::string program_version();

/// Commit the program was built from, 40 digits, with "-dirty" behind it if tracked files differed from it; "unknown"
/// if it was not built in a checkout.
[[nodiscard]] std::string git_commit();

/// SHA-256 of the running program's file, 64 hexadecimal digits. The file is read at the first call.
/// @throws std::runtime_error if it cannot be read
[[nodiscard]] const std::string &program_hash();

/// Largest memory this process has held so far [byte].
[[nodiscard]] std::uint64_t peak_memory();

/// What run.json tells: program, compiler, libraries, threads and ranks, times, memory, command line, outcome, and
/// whatever the run adds. The name of the machine is not in it. One thread may write it while another one adds.
class RunInfo
{
public:
  /// @param command_line the program's arguments, argv[0] included
  explicit RunInfo(std::vector<std::string> command_line);

  /// Wall times of this run's phases.
  [[nodiscard]] Stopwatch &stopwatch() { return stopwatch_; }

  /// Adds a fact under a key of its own, e.g. add("skip_verification", true). The same key again replaces the value.
  /// @throws std::logic_error if the key is one that run.json has anyway.
  void add(const std::string &key, bool value);
  void add(const std::string &key, int value);
  void add(const std::string &key, std::uint64_t value);
  void add(const std::string &key, double value);
  void add(const std::string &key, const char *value);
  void add(const std::string &key, const std::string &value);

  /// The value of one fact, or of one member of an object.
  using Scalar = std::variant<bool, int, std::uint64_t, double, std::string>;
  using Object = std::vector<std::pair<std::string, Scalar>>;

  /// Adds an object: its members are written in their order.
  void add(const std::string &key, const Object &object);

  /// The content of run.json as it now stands.
  /// @param exit_code what the run ended with; empty while it is under way (null in the file)
  /// @param verdict   verdict on the claims, if any were checked
  /// @return JSON with a line break at its end; wall times [s], memory [byte] of the calling process.
  [[nodiscard]] std::string json(std::optional<support::ExitCode> exit_code, const std::string &verdict = "") const;

  /// Writes json() to `path`; of several ranks, one should call it. @throws OutputError
  void write(const std::string &path, std::optional<support::ExitCode> exit_code,
             const std::string &verdict = "") const;

private:
  using Value = std::variant<Scalar, Object>;
  void add_value(const std::string &key, Value value);

  std::vector<std::string> command_line_;
  std::chrono::steady_clock::time_point start_;
  Stopwatch stopwatch_;
  int n_threads_, n_ranks_;  // as the thread that constructs sees them
  mutable std::mutex mutex_; // of facts_
  std::vector<std::pair<std::string, Value>> facts_;
};

} // namespace latcon::output
