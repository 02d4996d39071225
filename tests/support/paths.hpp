// Where the sources and the programs under test are. Compiled once: a path in the code of a test would keep the compiler cache from
// serving several work trees.
#pragma once

#include <string>

namespace swiftlet::tests {

// The path of a file or folder of the source tree, as "config/vehicles/kaylion.yaml".
std::string in_source(const std::string& path);

// The path of a file or folder of the build tree.
std::string in_build(const std::string& path);

// The path of one of the project's programs; an absolute one is returned as it is.
std::string program_file(const std::string& name);

}  // namespace swiftlet::tests
