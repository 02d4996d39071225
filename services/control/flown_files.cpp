#include "swiftlet/services/control/flown_files.hpp"

#include "swiftlet/io/security/digest.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::services {
namespace {

constexpr std::size_t kLongest = 65536;  // of SettingsFile

messages::msg::SettingsFile settings_file(const std::string& path) {
  const std::string text = io::read_text_file(path);
  messages::msg::SettingsFile file;
  file.sha256() = io::sha256(text);
  if (text.size() <= kLongest) {
    file.text() = text;
  } else {
    runtime::log_warning("{} has {} bytes: above {}, other processes are told its hash only", path,
                         text.size(), kLongest);
  }
  return file;
}

}  // namespace

messages::msg::FlownFiles flown_files(const std::string& program, const std::string& vehicle_file,
                                      const std::string& control_file) {
  messages::msg::FlownFiles files;
  files.program() = program;
  files.vehicle(settings_file(vehicle_file));
  files.control(settings_file(control_file));
  return files;
}

}  // namespace swiftlet::services
