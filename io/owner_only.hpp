// Files that hold a secret: only their owner may read them.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::io {

// Throws ConfigError if the file cannot be found, or gives others than its owner any right.
void require_owner_only(const std::filesystem::path& file);

// Writes the file as a whole, for its owner only. Throws std::runtime_error; the old file then remains.
void write_for_owner_only(const std::filesystem::path& file, const std::string& text);

// The first step of that: finish_file() (atomic_write.hpp) is the second. Replaces whatever has the unfinished name, and
// never writes to where a link leads.
void write_unfinished_for_owner_only(const std::filesystem::path& file, const std::string& text);

}  // namespace swiftlet::io
