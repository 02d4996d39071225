// Where configuration files are looked for.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::runtime {

// Folders that may hold vehicles/, control/, missions/, in order: $SWIFTLET_CONFIG_DIR if it is set, then,
// seen from the folder of the running executable, ../share/swiftlet/config (installed) and ../../config
// (build tree).
std::vector<std::string> config_directories();

// The first file there is: path as given, then, if it is relative ("vehicles/kaylion.yaml"), below each of
// config_directories(). Throws ConfigError with all places if there is none.
std::string find_config(const std::string& path);

}  // namespace swiftlet::runtime
