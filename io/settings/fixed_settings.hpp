// The control settings that cannot change in flight, as texts, for comparing two files key by key.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/control/types/settings_request.hpp"

namespace swiftlet::io {

// The settings of a control settings file whose keys TunableSettings does not cover; without the name. Throws
// ConfigError for a text that is not YAML.
std::vector<control::FixedSetting> parse_fixed_settings(std::string_view text, const std::string& file_name);
std::vector<control::FixedSetting> load_fixed_settings(const std::string& path);

// True for texts of equal values: "2", "2.0"; "[1, 2]", "[1.0,2]".
bool same_setting(std::string_view a, std::string_view b);

}  // namespace swiftlet::io
