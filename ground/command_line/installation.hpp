// Paths of programs, relative to the running program: in a build folder or installed.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// Returns the path of a program of the project in the folder of the running one. Throws std::runtime_error if
// it does not exist.
std::filesystem::path program_beside(const std::string& name);

}  // namespace swiftlet::ground
