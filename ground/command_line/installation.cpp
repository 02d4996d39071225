#include "swiftlet/ground/command_line/installation.hpp"

#include <stdexcept>
#include <unistd.h>

#include "swiftlet/io/program_directory.hpp"

namespace swiftlet::ground {

namespace fs = std::filesystem;

fs::path program_beside(const std::string& name) {
  fs::path program = runtime::program_directory() / name;
  if (access(program.c_str(), X_OK) != 0) {
    throw std::runtime_error(name + " not found, must be in the folder of this program, " +
                             program.parent_path().string());
  }
  return program;
}

}  // namespace swiftlet::ground
