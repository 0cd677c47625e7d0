#include "verification/input/input_file.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace latcon::input
{

InputFile read_input_file(const std::string &path)
{
  constexpr std::size_t largest = std::size_t(16) << 20;
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    return {"", "it is a folder"};
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return {"", std::generic_category().message(errno)};
  InputFile input;
  input.text.resize(largest + 1);
  file.read(input.text.data(), static_cast<std::streamsize>(input.text.size()));
  input.text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad())
    input.problem = std::generic_category().message(errno);
  else if (input.text.size() > largest)
    input.problem = "it is larger than 16 MiB";
  return input;
}

} // namespace latcon::input
