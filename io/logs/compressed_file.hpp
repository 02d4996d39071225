// Files that may be compressed.
#pragma once

#include <string>

namespace swiftlet::ground {

// The text of a file, unpacked if it is one of gzip. Throws runtime::ConfigError.
std::string read_unpacked(const std::string& path);

}  // namespace swiftlet::ground
