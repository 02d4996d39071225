// Where the programs and the configuration stand, seen from the running program: in a build folder or
// installed.
#pragma once

#include <filesystem>
#include <string>

namespace swiftlet::ground {

// A program of the project, which stands beside the running one. Throws std::runtime_error if it is not
// there.
std::filesystem::path program_beside(const std::string& name);

// A configuration file as a user names it: a path, or the bare name of a file of that kind ("square" of
// "missions"), which is looked for where runtime::find_config does. Throws runtime::ConfigError if there is
// no such file.
std::filesystem::path configuration_file(const std::string& kind, const std::string& name);

}  // namespace swiftlet::ground
