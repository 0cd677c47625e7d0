#include "verification/commands/recorded_output.h"

#include <iostream>
#include <mutex>

namespace latcon::commands
{
namespace
{

std::mutex mutex; // of the text
std::string recorded;

} // namespace

RecordedOutput::RecordedOutput() : original_(std::cout.rdbuf())
{
  const std::lock_guard lock(mutex);
  recorded.clear();
  std::cout.rdbuf(this);
}

RecordedOutput::~RecordedOutput()
{
  std::cout.rdbuf(original_);
}

std::string RecordedOutput::text()
{
  const std::lock_guard lock(mutex);
  return recorded;
}

RecordedOutput::int_type RecordedOutput::overflow(int_type c)
{
  if (traits_type::eq_int_type(c, traits_type::eof()))
    return traits_type::not_eof(c);
  const char character = traits_type::to_char_type(c);
  return xsputn(&character, 1) == 1 ? c : traits_type::eof();
}

std::streamsize RecordedOutput::xsputn(const char *text, std::streamsize length)
{
  {
    const std::lock_guard lock(mutex);
    recorded.append(text, static_cast<std::size_t>(length));
  }
  return original_->sputn(text, length);
}

} // namespace latcon::commands
