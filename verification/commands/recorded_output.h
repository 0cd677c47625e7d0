#pragma once

#include <iostream>
#include <mutex>
#include <streambuf>
#include <string>

namespace latcon::commands
{

/// Keeps a copy of what is printed to std::cout while it exists, for log.txt of a run. At most one at a time.
class RecordedOutput : private std::streambuf
{
public:
  RecordedOutput() : original_(std::cout.rdbuf(this))
  {
    const std::lock_guard lock(mutex_);
    text_.clear();
  }
  ~RecordedOutput() override { std::cout.rdbuf(original_); }

  RecordedOutput(const RecordedOutput &) = delete;
  RecordedOutput &operator=(const RecordedOutput &) = delete;

  /// The text printed so far; empty if nothing is being recorded. May be called from another thread.
  [[nodiscard]] static std::string text()
  {
    const std::lock_guard lock(mutex_);
    return text_;
  }

private:
  int_type overflow(int_type c) override
  {
    if (traits_type::eq_int_type(c, traits_type::eof()))
      return traits_type::not_eof(c);
    const char character = traits_type::to_char_type(c);
    return xsputn(&character, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char *text, std::streamsize length) override
  {
    {
      const std::lock_guard lock(mutex_);
      text_.append(text, static_cast<std::size_t>(length));
    }
    return original_->sputn(text, length);
  }
  int sync() override { return original_->pubsync(); }

  static inline std::mutex mutex_; // of the text
  static inline std::string text_;

  std::streambuf *original_; // gets everything
};

} // namespace latcon::commands
