#include "swiftlet/ground/command_line/installation.hpp"

#include <stdexcept>
#include <unistd.h>

#include "swiftlet/io/find_config.hpp"

namespace swiftlet::ground {

namespace fs = std::filesystem;

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
  const fs::path file = runtime::find_config(bare && !is_file ? kind + "/" + name + ".yaml" : name);
  return file.lexically_normal();
}

}  // namespace swiftlet::ground
