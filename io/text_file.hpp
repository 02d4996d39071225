// Reads an input file whole.
#pragma once

#include <cstddef>
#include <string>

namespace swiftlet::runtime {

// Throws ConfigError: "FILE: cannot be read: REASON", or if it holds more than max_bytes.
std::string read_text_file(const std::string& path, std::size_t max_bytes = std::size_t{256} << 20);

}  // namespace swiftlet::runtime
