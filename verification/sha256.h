#pragma once

#include <string>

namespace verification
{

/// SHA-256 (FIPS 180-4) of the bytes of a text, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(const std::string &bytes);

} // namespace verification
