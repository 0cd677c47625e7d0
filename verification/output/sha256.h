#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace latcon::output
{

/// SHA-256 (FIPS 180-4) of some bytes, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// The same of the bytes of a file, the first `skipped` left out; empty if it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path &path, std::size_t skipped = 0);

} // namespace latcon::output
