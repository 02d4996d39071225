// The folder of the running program, beside which the configuration and other programs are found.
#pragma once

#include <filesystem>

namespace swiftlet::io {

// The folder of the running executable, or that of set_program_directory(); empty if it is not known.
std::filesystem::path program_directory();

// For a library that a program of others loads, such as the Python interpreter: the folder of the programs that the
// library belongs to. Call it before other threads begin.
void set_program_directory(const std::filesystem::path& folder);

}  // namespace swiftlet::io
