#include "swiftlet/ground/command_line/installation.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/io/find_config.hpp"
#include "swiftlet/io/nearest_name.hpp"

namespace swiftlet::ground {

namespace fs = std::filesystem;

namespace {

// The names of all files of this kind, sorted.
std::vector<std::string> configuration_names(const std::string& kind) {
  std::vector<std::string> names;
  for (const std::string& directory : runtime::config_directories()) {
    std::error_code error;
    for (const fs::directory_entry& file : fs::directory_iterator(fs::path(directory) / kind, error)) {
      if (file.path().extension() == ".yaml") names.push_back(file.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string noun_of(const std::string& kind) {
  if (kind == "missions") return "mission";
  if (kind == "vehicles") return "vehicle";
  return kind == "dispersion" ? kind : kind + " settings";
}

// Names what there is instead of a name that is not there.
[[noreturn]] void refuse_name(const std::string& kind, const std::string& name) {
  const std::vector<std::string> names = configuration_names(kind);
  std::string list;
  for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
  const std::string nearest = runtime::nearest_name(names, name);
  throw InputError("No " + noun_of(kind) + " '" + name + "'." +
                   (nearest.empty() ? "" : " Did you mean '" + nearest + "'?") +
                   (list.empty() ? "" : " Available: " + list));
}

}  // namespace

fs::path program_beside(const std::string& name) {
  fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / name;
  if (access(program.c_str(), X_OK) != 0) {
    throw std::runtime_error(name + " not found, must be in the folder of this program, " +
                             program.parent_path().string());
  }
  return program;
}

fs::path configuration_file(const std::string& kind, const std::string& name) {
  const bool bare = name.find('/') == std::string::npos && !fs::path(name).has_extension();
  const bool is_file = fs::exists(name) && !fs::is_directory(name);
  if (!bare || is_file) return fs::path(runtime::find_config(name)).lexically_normal();
  const std::vector<std::string> names = configuration_names(kind);
  if (std::find(names.begin(), names.end(), name) == names.end()) refuse_name(kind, name);
  return fs::path(runtime::find_config(kind + "/" + name + ".yaml")).lexically_normal();
}

}  // namespace swiftlet::ground
