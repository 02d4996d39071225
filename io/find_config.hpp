// The search path of configuration files.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::runtime {

// The folders that are searched for vehicles/, control/, missions/, in order: $SWIFTLET_CONFIG_DIR if it is
// set, then, relative to the folder of the running executable, ../share/swiftlet/config (installed) and
// ../../config (build tree).
std::vector<std::string> config_directories();

// Returns the first file that exists: path as given, then, if it is relative ("vehicles/kaylion.yaml"), path
// below each of config_directories(). Throws ConfigError that lists all searched places if there is none.
std::string find_config(const std::string& path);

}  // namespace swiftlet::runtime
