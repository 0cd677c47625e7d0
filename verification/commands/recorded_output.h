#pragma once

#include <streambuf>
#include <string>

namespace latcon::commands
{

/// Keeps a copy of what is printed to std::cout while it exists, for log.txt of a run.
class RecordedOutput : private std::streambuf
{
public:
  RecordedOutput();           ///< begins with an empty text; at most one at a time
  ~RecordedOutput() override; ///< std::cout is as before

  RecordedOutput(const RecordedOutput &) = delete;
  RecordedOutput &operator=(const RecordedOutput &) = delete;

  /// The text printed so far; empty if nothing is being recorded. May be called from another thread.
  [[nodiscard]] static std::string text();

private:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char *text, std::streamsize length) override;
  int sync() override { return original_->pubsync(); }

  std::streambuf *original_; // gets everything
};

} // namespace latcon::commands
