#include "swiftlet/io/configuration.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/program_directory.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace fs = std::filesystem;

namespace {

// Names what there is instead of a name that is not there.
[[noreturn]] void refuse_name(const ConfigurationKind& kind, const std::string& name) {
  std::vector<std::string> names;
  std::string list;
  for (const ConfigurationFile& file : configuration_files(kind)) {
    names.push_back(file.name);
    list += (list.empty() ? "" : ", ") + file.name;
  }
  throw ConfigError(std::string("No ") + kind.noun + " '" + name + "'." + did_you_mean(names, name) +
                    (list.empty() ? "" : " Available: " + list));
}

// The text after a prefix; "" if the line begins otherwise.
std::string text_after(std::string_view prefix, const std::string& line) {
  return line.compare(0, prefix.size(), prefix) == 0 ? line.substr(prefix.size()) : "";
}

}  // namespace

std::vector<std::string> config_directories() {
  std::vector<std::string> directories;
  const char* const from_environment = std::getenv("SWIFTLET_CONFIG_DIR");
  if (from_environment != nullptr && *from_environment != 0) directories.emplace_back(from_environment);
  const fs::path programs = program_directory();
  if (!programs.empty()) {
    const fs::path prefix = programs.parent_path();
    if (prefix == "/usr") directories.emplace_back("/etc/swiftlet");
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

const std::vector<ConfigurationKind>& configuration_kinds() {
  static const std::vector<ConfigurationKind> kinds = {kinds::kVehicle, kinds::kControl, kinds::kSimulation,
                                                       kinds::kMission, kinds::kFleet,   kinds::kDispersion,
                                                       kinds::kRoom};
  return kinds;
}

std::vector<ConfigurationFile> configuration_files(const ConfigurationKind& kind) {
  std::vector<ConfigurationFile> files;
  for (const std::string& directory : config_directories()) {
    std::error_code error;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(directory) / kind.folder, error)) {
      const std::string name = entry.path().stem().string();
      const bool is_known = std::any_of(files.begin(), files.end(),
                                        [&](const ConfigurationFile& file) { return file.name == name; });
      if (entry.path().extension() == ".yaml" && !is_known)
        files.push_back({name, entry.path().lexically_normal()});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const ConfigurationFile& a, const ConfigurationFile& b) { return a.name < b.name; });
  return files;
}

fs::path configuration_file(const ConfigurationKind& kind, const std::string& name) {
  const bool bare = name.find('/') == std::string::npos && !fs::path(name).has_extension();
  const bool is_file = fs::exists(name) && !fs::is_directory(name);
  if (!bare || is_file) return fs::path(find_config(name)).lexically_normal();
  for (const ConfigurationFile& file : configuration_files(kind)) {
    if (file.name == name) return file.path;
  }
  if (fs::exists(name + ".yaml")) return name + ".yaml";
  refuse_name(kind, name);
}

std::string description_of(const fs::path& file) {
  std::ifstream in(file);
  std::string comment;
  for (std::string line; std::getline(in, line);) {
    const std::string description = text_after("description: ", line);
    if (!description.empty()) return printable(description);
    const bool is_schema = line.find("yaml-language-server") != std::string::npos;
    if (comment.empty() && !is_schema) comment = text_after("# ", line);
  }
  return printable(comment);
}

}  // namespace swiftlet::io
