// Files that appear under their name only when they are complete.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::io {

// Returns FILE.part, the name under which a file is written until it is complete; the file itself if it is a
// device, a terminal or a pipe.
std::filesystem::path unfinished_name(const std::filesystem::path& file);

// Gives unfinished_name(file) the name of the file. Throws std::runtime_error.
void finish_file(const std::filesystem::path& file);

// Writes the text to unfinished_name(file), and finishes it. Throws std::runtime_error if that fails; the old
// file then remains, and no unfinished one.
void write_atomically(const std::filesystem::path& file, const std::string& text);

// The sentence for a file that cannot be written. error: an errno.
std::string write_fault(const std::filesystem::path& file, int error);

}  // namespace swiftlet::io
