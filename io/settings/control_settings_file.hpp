// The control settings file: YAML with the values of control::ControlSettings, units in the key names.
// config/control/motor_lag.yaml shows all keys; each must be given.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::runtime {

// Settings that control::validate() finds no fault with. Throws ConfigError for anything else. file_name is
// for the messages only.
control::ControlSettings parse_control_settings(std::string_view text, const std::string& file_name);
control::ControlSettings load_control_settings(const std::string& path);

}  // namespace swiftlet::runtime
