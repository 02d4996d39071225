// Checks of the output files of a command.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::io {

struct OutputFile {
  std::string option;  // "--out"
  std::string file;    // empty: none
};

// Throws InputError if an output is also an input, or two outputs are the same file: data would be lost.
void refuse_overwriting(const std::vector<OutputFile>& outputs,
                        const std::vector<std::filesystem::path>& inputs);

// Returns all entries of a folder, or the path itself if it is not a folder.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

}  // namespace swiftlet::io
