#include "verification/progress.h"

#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace verification
{
namespace
{

constexpr std::chrono::milliseconds interval(200);

} // namespace

Progress::Progress(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

Progress::~Progress()
{
  if (shown_)
    std::fputs("\r\033[K", stderr);
}

bool Progress::due() const
{
  return shown_ && Clock::now() - last_ >= interval;
}

void Progress::show(const std::string &text, double fraction_done)
{
  if (!shown_)
    return;
  last_ = Clock::now();
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  std::string line = "\r\033[K" + text;
  if (fraction_done > 0.01)
    line += ", " + std::to_string(std::lround(elapsed * (1. / fraction_done - 1.))) + " s left";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

} // namespace verification
