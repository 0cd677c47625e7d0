#include "verification/input/files.h"

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include <openssl/evp.h>

namespace latcon::input
{
namespace
{

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

void require(int status)
{
  if (status != 1)
    throw std::runtime_error("SHA-256 is not available");
}

std::string text_of(const Digest &digest, const unsigned int size)
{
  constexpr const char *digits = "0123456789abcdef";
  std::string text;
  for (unsigned int i = 0; i < size; ++i)
    text += {digits[digest[i] >> 4U], digits[digest[i] & 15U]};
  return text;
}

} // namespace

std::string sha256(std::string_view bytes)
{
  Digest digest{};
  unsigned int size = 0;
  require(EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr));
  return text_of(digest, size);
}

std::string sha256_of_file(const std::filesystem::path &path, std::size_t skipped)
{
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(skipped));
  if (!in)
    return "";
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  require(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr));
  std::vector<char> block(1U << 16U);
  do
  {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    require(EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(in.gcount())));
  } while (in);
  Digest digest{};
  unsigned int size = 0;
  require(EVP_DigestFinal_ex(context.get(), digest.data(), &size));
  return in.eof() ? text_of(digest, size) : "";
}

} // namespace latcon::input
