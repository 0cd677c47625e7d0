#include "verification/commands/recorded_output.h"

#include <iostream>
#include <mutex>
#include <streambuf>

namespace latcon::commands
{
namespace
{

std::mutex mutex; // of the text
std::string recorded;

} // namespace

// Passes everything on to another buffer.
class RecordedOutput::Copy : public std::streambuf
{
public:
  explicit Copy(std::streambuf *original) : original_(original) {}

  std::streambuf *original() const { return original_; }

protected:
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
      const std::lock_guard lock(mutex);
      recorded.append(text, static_cast<std::size_t>(length));
    }
    return original_->sputn(text, length);
  }

  int sync() override { return original_->pubsync(); }

private:
  std::streambuf *original_;
};

RecordedOutput::RecordedOutput() : copy_(std::make_unique<Copy>(std::cout.rdbuf()))
{
  const std::lock_guard lock(mutex);
  recorded.clear();
  std::cout.rdbuf(copy_.get());
}

RecordedOutput::~RecordedOutput()
{
  std::cout.rdbuf(copy_->original());
}

std::string RecordedOutput::text()
{
  const std::lock_guard lock(mutex);
  return recorded;
}

} // namespace latcon::commands
