// Reads files that may be compressed.
#pragma once

#include <string>

namespace swiftlet::analysis {

// Returns the text of a file, decompressed if it is a gzip file. Throws io::ConfigError.
std::string read_unpacked(const std::string& path);

}  // namespace swiftlet::analysis
