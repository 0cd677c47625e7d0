#pragma once

#include <chrono>
#include <string>

namespace latcon::output
{

/// Progress indicator on standard error: on a terminal, a line that is updated several times per second; otherwise, for
/// example in a log, a new line at intervals; or lines of JSON to the descriptor in LATCON_PROGRESS (reference.md).
class Progress
{
public:
  /// @param wanted false for no output
  /// @param done_before fraction of the run that was done before, 0 to 1: that of a resumed run
  /// @param log_interval interval between lines if standard error is not a terminal
  explicit Progress(bool wanted, double done_before = 0.,
                    std::chrono::milliseconds log_interval = std::chrono::minutes(1));
  ~Progress(); ///< clears the line of a terminal
  Progress(const Progress &) = delete;
  Progress &operator=(const Progress &) = delete;

  /// Returns true if the next update is due.
  bool due() const;

  /// Replaces the line, or adds one. @param fraction_done fraction of the run that is done, 0 to 1; determines the
  /// estimate of the remaining time
  void show(const std::string &text, double fraction_done);

private:
  using Clock = std::chrono::steady_clock;

  bool shown_, on_terminal_;
  double done_before_;
  std::chrono::milliseconds interval_;
  Clock::time_point start_;
  Clock::time_point last_;
};

} // namespace latcon::output
