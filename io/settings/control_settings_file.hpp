// The control settings file: YAML with the values of control::ControlSettings. Key names end with the unit.
// config/control/motor_lag.yaml shows all keys; every key is required.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::io {

// Returns settings that pass control::validate(). Throws ConfigError otherwise. file_name appears in messages
// only.
control::ControlSettings parse_control_settings(std::string_view text, const std::string& file_name);
control::ControlSettings load_control_settings(const std::string& path);

}  // namespace swiftlet::io
