#include "verification/output/progress.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace latcon::output
{
namespace
{

// Such a terminal shows the control characters that erase a line.
bool is_dumb_terminal()
{
  const char *const kind = std::getenv("TERM");
  return kind != nullptr && std::strcmp(kind, "dumb") == 0;
}

// Descriptor of a program that shows the progress itself, the Python package, as a line of JSON per update; -1: none.
int descriptor_of_viewer()
{
  const char *const text = std::getenv("LATCON_PROGRESS");
  const std::size_t n_digits = text != nullptr ? std::strspn(text, "0123456789") : 0;
  return n_digits > 0 && n_digits < 10 && text[n_digits] == '\0' ? std::atoi(text) : -1;
}

} // namespace

Progress::Progress(bool wanted, double done_before, std::chrono::milliseconds log_interval)
  : shown_(wanted), on_terminal_(descriptor_of_viewer() < 0 && isatty(STDERR_FILENO) != 0 && !is_dumb_terminal()),
    done_before_(done_before),
    interval_(on_terminal_ || descriptor_of_viewer() >= 0 ? std::chrono::milliseconds(200) : log_interval),
    start_(Clock::now()), last_(start_)
{
}

Progress::~Progress()
{
  if (shown_ && on_terminal_)
    std::fputs("\r\033[K", stderr);
}

bool Progress::due() const
{
  return shown_ && Clock::now() - last_ >= interval_;
}

void Progress::show(const std::string &text, double fraction_done)
{
  if (!shown_)
    return;
  last_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  const double done_here = fraction_done - done_before_;
  const long left =
    done_here > 0.01 * (1. - done_before_) ? std::lround(elapsed * (1. - fraction_done) / done_here) : -1;
  std::string line = text + (left >= 0 ? ", " + std::to_string(left) + " s left" : "");
  if (const int viewer = descriptor_of_viewer(); viewer >= 0)
  {
    const nlohmann::json update{{"text", line}, {"seconds_left", left >= 0 ? nlohmann::json(left) : nullptr}};
    line = update.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (write(viewer, line.data(), line.size()) < 0)
      shown_ = false; // nobody reads
    return;
  }
  line = on_terminal_ ? "\r\033[K" + line : line + "\n";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

} // namespace latcon::output
