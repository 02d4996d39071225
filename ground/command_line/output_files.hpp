// Files that a command is told to write.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::ground {

struct OutputFile {
  std::string option;  // "--out"
  std::string file;    // empty: none
};

// Throws InputError if one of them is an input, or two are the same: what was measured would be lost.
void refuse_overwriting(const std::vector<OutputFile>& outputs,
                        const std::vector<std::filesystem::path>& inputs);

// All files of a folder; the file itself if it is none.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

}  // namespace swiftlet::ground
