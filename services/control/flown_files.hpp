// The files that a controller flies with, as it tells ground tools and recorders.
#pragma once

#include <string>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::services {

// Throws io::ConfigError if a file cannot be read.
messages::msg::FlownFiles flown_files(const std::string& program, const std::string& vehicle_file,
                                      const std::string& control_file);

}  // namespace swiftlet::services
