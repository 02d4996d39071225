#include "swiftlet/services/dds/shared_memory.hpp"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace swiftlet::comms {
namespace {

namespace fs = std::filesystem;

// False if the file does not exist.
bool is_young(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written < std::chrono::seconds(1);
}

// True if a lock file of this user has no holder, or does not exist.
bool is_free(const fs::path& lock_file) {
  const int fd = ::open(lock_file.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return errno == ENOENT;
  struct stat status {};
  const bool free = ::fstat(fd, &status) == 0 && status.st_uid == ::geteuid() && !is_young(lock_file) &&
                    ::flock(fd, LOCK_EX | LOCK_NB) == 0;
  ::close(fd);
  return free;
}

int remove_files(const std::vector<fs::path>& paths) {
  int removed = 0;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (fs::remove(path, error)) ++removed;
  }
  return removed;
}

}  // namespace

int remove_stale_shared_memory(const std::string& directory) {
  // A segment, or a port with its semaphore; each has a lock file that its owner holds, exclusive or shared.
  static const std::regex kFile("(fast(?:rtps|dds)_(?:[0-9a-f]{16}|port[0-9]+))(?:_[es]l)?");

  std::error_code error;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string file = entry.path().filename();
    std::smatch match;
    if (std::regex_match(file, match, kFile)) names.insert(match[1]);
  }

  const fs::path root(directory);
  int removed = 0;
  for (const std::string& name : names) {
    const fs::path exclusive = root / (name + "_el");
    const fs::path shared = root / (name + "_sl");
    if (is_young(root / name) || !is_free(exclusive) || !is_free(shared)) continue;
    removed += remove_files({root / name, root / ("sem." + name + "_mutex"), exclusive, shared});
  }
  return removed;
}

}  // namespace swiftlet::comms
