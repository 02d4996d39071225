#include "swiftlet/io/command_line/installation.hpp"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <unistd.h>

#include "swiftlet/io/program_directory.hpp"

namespace swiftlet::io {
namespace {

namespace fs = std::filesystem;

bool is_program(const fs::path& file) { return access(file.c_str(), X_OK) == 0; }

// `./dev fly` builds what a flight needs; the other programs of a build folder are built when they are first asked for.
void build_in_source_tree(const fs::path& program) {
  const fs::path build = program.parent_path().parent_path();
  std::error_code none;
  if (program.parent_path().filename() != "bin" || !fs::exists(build / "build.ninja", none)) return;
  std::fprintf(stderr, "swiftlet: building %s, once\n", program.filename().c_str());
  const std::string command =
      "ninja -C " + shell_quoted(build.string()) + " " + program.filename().string() + " >&2";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("building " + program.filename().string() + " failed");
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

fs::path program_beside(const std::string& name) {
  fs::path program = io::program_directory() / name;
  if (!is_program(program)) build_in_source_tree(program);
  if (!is_program(program) && program.parent_path() == "/usr/bin")
    throw std::runtime_error(
        name + " not found: the package swiftlet-analysis has it, apt install swiftlet-analysis");
  if (!is_program(program)) {
    throw std::runtime_error(name + " not found, must be in the folder of this program, " +
                             program.parent_path().string());
  }
  return program;
}

bool has_program_beside(const std::string& name) { return is_program(io::program_directory() / name); }

}  // namespace swiftlet::io
