#include "swiftlet/io/settings/control_settings_file.hpp"

#include "swiftlet/control/types/settings_visit.hpp"
#include "swiftlet/io/settings/settings_reader.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

control::ControlSettings parse_control_settings(std::string_view text, const std::string& file_name) {
  const ConfigNode root = parse_config(text, file_name);
  control::ControlSettings settings;
  root.read_known([&] {
    settings.name = root.at("name").text();
    read_section(SettingsReader(root, NumbersAre::kPlain), settings);
  });
  reject_violations(root, control::validate(settings));
  return settings;
}

control::ControlSettings load_control_settings(const std::string& path) {
  return parse_control_settings(read_text_file(path), path);
}

}  // namespace swiftlet::io
