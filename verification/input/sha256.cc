#include "verification/input/sha256.h"

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

class Digest
{
public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free)
  {
    require(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void add(const char *bytes, std::size_t n) { require(EVP_DigestUpdate(context_.get(), bytes, n) == 1); }

  std::string text()
  {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    constexpr const char *digits = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i)
    {
      text += digits[digest[i] >> 4U];
      text += digits[digest[i] & 15U];
    }
    return text;
  }

private:
  static void require(bool condition)
  {
    if (!condition)
      throw std::runtime_error("SHA-256 is not available");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

} // namespace

std::string sha256(std::string_view bytes)
{
  Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.text();
}

std::string sha256_of_file(const std::filesystem::path &path, std::size_t skipped)
{
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(skipped));
  if (!in)
    return "";
  Digest digest;
  std::vector<char> block(1U << 16U);
  do
  {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    digest.add(block.data(), static_cast<std::size_t>(in.gcount()));
  } while (in);
  return in.eof() ? digest.text() : "";
}

} // namespace latcon::input
