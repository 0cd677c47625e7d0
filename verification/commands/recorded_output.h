#pragma once

#include <memory>
#include <string>

namespace latcon::commands
{

/// Keeps a copy of what is printed to std::cout while it exists, for log.txt of a run.
class RecordedOutput
{
public:
  RecordedOutput();  ///< begins with an empty text; at most one at a time
  ~RecordedOutput(); ///< std::cout is as before

  RecordedOutput(const RecordedOutput &) = delete;
  RecordedOutput &operator=(const RecordedOutput &) = delete;

  /// The text printed so far; empty if nothing is being recorded. May be called from another thread.
  [[nodiscard]] static std::string text();

private:
  class Copy;
  std::unique_ptr<Copy> copy_;
};

} // namespace latcon::commands
