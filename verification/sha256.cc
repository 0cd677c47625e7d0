#include "verification/sha256.h"

#include <array>
#include <stdexcept>

#include <openssl/evp.h>

namespace verification
{

std::string sha256(const std::string &bytes)
{
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
  constexpr const char *digits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < size; ++i)
  {
    text += digits[digest[i] >> 4U];
    text += digits[digest[i] & 15U];
  }
  return text;
}

} // namespace verification
