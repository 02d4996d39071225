#include "swiftlet/io/find_config.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::runtime {

namespace fs = std::filesystem;

std::vector<std::string> config_directories() {
  std::vector<std::string> directories;
  const char* const from_environment = std::getenv("SWIFTLET_CONFIG_DIR");
  if (from_environment != nullptr && *from_environment != 0) directories.emplace_back(from_environment);
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path prefix = executable.parent_path().parent_path();
    directories.push_back((prefix / "share" / "swiftlet" / "config").string());
    directories.push_back((prefix.parent_path() / "config").string());
  }
  return directories;
}

std::string find_config(const std::string& path) {
  std::vector<std::string> candidates = {path};
  if (fs::path(path).is_relative() && !path.empty()) {
    for (const std::string& directory : config_directories())
      candidates.push_back((fs::path(directory) / path).string());
  }
  std::string places;
  for (const std::string& candidate : candidates) {
    std::error_code error;
    const fs::file_status status = fs::status(candidate, error);
    if (fs::exists(status) && !fs::is_directory(status)) return candidate;
    places += (places.empty() ? "" : ", ") + candidate;
  }
  throw ConfigError(path, 0, "", "is not found, looked for " + places);
}

}  // namespace swiftlet::runtime
