#include "verification/output/progress.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

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

} // namespace

Progress::Progress(bool wanted, std::chrono::milliseconds log_interval)
  : shown_(wanted), on_terminal_(isatty(STDERR_FILENO) != 0 && !is_dumb_terminal()),
    interval_(on_terminal_ ? std::chrono::milliseconds(200) : log_interval), start_(Clock::now()), last_(start_)
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
  std::string line = text;
  if (fraction_done > 0.01)
    line += ", " + std::to_string(std::lround(elapsed * (1. / fraction_done - 1.))) + " s left";
  line = on_terminal_ ? "\r\033[K" + line : line + "\n";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

} // namespace latcon::output
