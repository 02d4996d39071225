// Atomic writes: a reader sees the old file or the complete new one, never a part.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// Writes FILE.part and renames it to the file. Throws std::runtime_error if that fails; the old file then
// stays unchanged.
void write_atomically(const std::filesystem::path& file, const std::string& text);

}  // namespace swiftlet::ground
