#pragma once

#include <stdexcept>

namespace latcon::support
{

/// Refuses an argument, or a value that an archive holds, before it is used. @throws std::invalid_argument
template <class Text>
void require(bool holds, const Text &problem)
{
  if (!holds)
    throw std::invalid_argument(problem);
}

} // namespace latcon::support
