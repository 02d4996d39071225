// Paths of programs and configuration files, relative to the running program: in a build folder or installed.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// Returns the path of a program of the project in the folder of the running one. Throws std::runtime_error if
// it does not exist.
std::filesystem::path program_beside(const std::string& name);

// Returns the path of a configuration file. `name` is a path, or the bare name of a file of this kind
// ("square" of "missions") in the folders of runtime::find_config(). Throws runtime::ConfigError if there is
// no such file, InputError with the nearest name and all there are if there is no such name.
std::filesystem::path configuration_file(const std::string& kind, const std::string& name);

}  // namespace swiftlet::ground
