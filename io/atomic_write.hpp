// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// Throws std::runtime_error, and leaves what was there before.
void write_whole_file(const std::filesystem::path& file, const std::string& text);

}  // namespace swiftlet::ground
