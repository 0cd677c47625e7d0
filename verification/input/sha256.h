#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace latcon::input
{

/// Returns the SHA-256 (FIPS 180-4) of `bytes`, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Returns the SHA-256 of a file without its first `skipped` bytes; empty if the file cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path &path, std::size_t skipped = 0);

} // namespace latcon::input
