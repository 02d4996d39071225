// Hashes of contents.
#pragma once

#include <string>
#include <string_view>

namespace swiftlet::io {

// SHA-256 (FIPS 180-4) in hexadecimal digits. Throws std::runtime_error if OpenSSL has none.
std::string sha256(std::string_view bytes);

}  // namespace swiftlet::io
