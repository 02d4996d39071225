#include "swiftlet/io/owner_only.hpp"

#include <cerrno>
#include <cstdio>
#include <sys/stat.h>
#include <system_error>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::runtime {
namespace {

constexpr mode_t kRightsOfOthers = S_IRWXG | S_IRWXO;

}  // namespace

void require_owner_only(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0)
    throw ConfigError(file, 0, "", "cannot be read: " + std::generic_category().message(errno));
  if ((status.st_mode & kRightsOfOthers) == 0) return;
  char rights[8];
  std::snprintf(rights, sizeof rights, "%04o", status.st_mode & 07777U);
  throw ConfigError(file, 0, "",
                    std::string("has rights ") + rights + ", must be 0600: others could read the key");
}

void write_for_owner_only(const std::filesystem::path& file, const std::string& text) {
  const mode_t before = ::umask(kRightsOfOthers);
  try {
    write_atomically(file, text);
  } catch (...) {
    ::umask(before);
    throw;
  }
  ::umask(before);
}

}  // namespace swiftlet::runtime
