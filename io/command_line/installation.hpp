// Paths of programs, relative to the running program: in a build folder or installed.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::io {

// Returns the path of a program of the project in the folder of the running one. In a build folder it is built first if it was
// not yet. Throws std::runtime_error if it does not exist.
std::filesystem::path program_beside(const std::string& name);

bool has_program_beside(const std::string& name);

// One word of a command of the shell.
std::string shell_quoted(const std::string& word);

}  // namespace swiftlet::io
