#pragma once

#include <chrono>
#include <string>

namespace latcon::output
{

/// Says on standard error how far a run is: on a terminal in one line that is replaced a few times a second, elsewhere,
/// as in the log of a batch job, in a line of its own every so often.
class Progress
{
public:
  /// @param wanted false to show nothing
  /// @param log_interval between lines where standard error is no terminal
  explicit Progress(bool wanted, std::chrono::milliseconds log_interval = std::chrono::minutes(1));
  ~Progress(); ///< clears the line of a terminal
  Progress(const Progress &) = delete;
  Progress &operator=(const Progress &) = delete;

  /// Whether enough time has passed for a new line to be worth making.
  bool due() const;

  /// Replaces the line, or adds one. @param fraction_done of the run, 0 to 1; the time left is estimated from it
  void show(const std::string &text, double fraction_done);

private:
  using Clock = std::chrono::steady_clock;

  bool shown_, on_terminal_;
  std::chrono::milliseconds interval_;
  Clock::time_point start_;
  Clock::time_point last_;
};

} // namespace latcon::output
