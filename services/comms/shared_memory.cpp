#include "services/comms/shared_memory.hpp"

#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <regex>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace swiftlet::comms {
namespace {

namespace fs = std::filesystem;

bool is_young(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return error || fs::file_time_type::clock::now() - written < std::chrono::seconds(1);
}

// Holds the lock of a dead owner's file, so that nobody takes the name up again while its files are removed.
class DeadOwner {
 public:
  explicit DeadOwner(const fs::path& lock_file) : fd_(::open(lock_file.c_str(), O_RDWR | O_CLOEXEC)) {
    struct stat status {};
    dead_ = fd_ >= 0 && ::fstat(fd_, &status) == 0 && status.st_uid == ::geteuid() && !is_young(lock_file) &&
            ::flock(fd_, LOCK_EX | LOCK_NB) == 0;
  }
  ~DeadOwner() {
    if (fd_ >= 0) ::close(fd_);
  }
  DeadOwner(const DeadOwner&) = delete;
  DeadOwner& operator=(const DeadOwner&) = delete;
  explicit operator bool() const { return dead_; }

 private:
  int fd_;
  bool dead_ = false;
};

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
  // A segment has one lock file, held by its owner; a port's readers hold one of two, exclusive or shared.
  static const std::regex kSegmentLock("(fastrtps_[0-9a-f]{16})_el");
  static const std::regex kPortLock("(fastrtps_port[0-9]+)_[es]l");

  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory, error)) names.push_back(entry.path().filename());

  const fs::path root(directory);
  int removed = 0;
  for (const std::string& name : names) {
    std::smatch match;
    if (std::regex_match(name, match, kSegmentLock)) {
      const DeadOwner dead(root / name);
      if (dead) removed += remove_files({root / match[1].str(), root / name});
    } else if (std::regex_match(name, match, kPortLock)) {
      const std::string port = match[1];
      const std::string other =
          name.back() == 'l' && name[name.size() - 2] == 'e' ? port + "_sl" : port + "_el";
      const DeadOwner dead(root / name);
      const bool other_exists = fs::exists(root / other, error);
      if (dead && !other_exists) {
        removed += remove_files({root / port, root / ("sem." + port + "_mutex"), root / name});
      } else if (dead && other_exists) {
        const DeadOwner other_dead(root / other);
        if (other_dead) {
          removed +=
              remove_files({root / port, root / ("sem." + port + "_mutex"), root / name, root / other});
        }
      }
    }
  }
  return removed;
}

}  // namespace swiftlet::comms
