// Reads files that may be compressed.
#pragma once

#include <string>

namespace swiftlet::ground {

// Returns the text of a file, decompressed if it is a gzip file. Throws runtime::ConfigError.
std::string read_unpacked(const std::string& path);

}  // namespace swiftlet::ground
