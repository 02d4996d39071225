#include "tests/support/paths.hpp"

#include <filesystem>

namespace swiftlet::tests {

std::string in_source(const std::string& path) { return std::string(SWIFTLET_SOURCE_DIR) + "/" + path; }

std::string in_build(const std::string& path) { return std::string(SWIFTLET_BINARY_DIR) + "/" + path; }

std::string program_file(const std::string& name) { return std::filesystem::path(in_build("bin")) / name; }

}  // namespace swiftlet::tests
