#include "swiftlet/io/program_directory.hpp"

#include <system_error>

namespace swiftlet::io {
namespace {

std::filesystem::path& chosen() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

std::filesystem::path program_directory() {
  if (!chosen().empty()) return chosen();
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

void set_program_directory(const std::filesystem::path& folder) { chosen() = folder; }

}  // namespace swiftlet::io
