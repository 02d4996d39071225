#include "swiftlet/io/security/digest.hpp"

#include <array>
#include <openssl/evp.h>
#include <stdexcept>

#include <fmt/format.h>

namespace swiftlet::io {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL cannot compute a SHA-256");
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace swiftlet::io
