#pragma once

#include <chrono>
#include <string>

namespace verification
{

/// One line on standard error that says how far a run is. Shown on a terminal only, a few times a second.
class Progress
{
public:
  /// @param wanted false to show nothing, whatever standard error is
  explicit Progress(bool wanted);
  ~Progress(); ///< clears the line
  Progress(const Progress &) = delete;
  Progress &operator=(const Progress &) = delete;

  /// Whether enough time has passed for a new line to be worth making.
  bool due() const;

  /// Replaces the line. @param fraction_done of the run, 0 to 1; the time left is estimated from it
  void show(const std::string &text, double fraction_done);

private:
  using Clock = std::chrono::steady_clock;

  bool shown_;
  Clock::time_point start_;
  Clock::time_point last_;
};

} // namespace verification
