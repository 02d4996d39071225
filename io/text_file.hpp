// Reads a complete input file.
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet::runtime {

// Throws ConfigError "FILE: cannot be read: REASON", or "is too large" if the file exceeds max_bytes.
std::string read_text_file(const std::string& path, std::size_t max_bytes = std::size_t{256} << 20);

}  // namespace swiftlet::runtime
