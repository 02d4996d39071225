// Files that hold a secret: only their owner may read them.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::runtime {

// Throws ConfigError if the file cannot be found, or gives others than its owner any right.
void require_owner_only(const std::filesystem::path& file);

// Writes the file as a whole, for its owner only. Throws std::runtime_error.
void write_for_owner_only(const std::filesystem::path& file, const std::string& text);

}  // namespace swiftlet::runtime
