#include "swiftlet/services/dds/discovery/domain_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace swiftlet::comms {
namespace {

// Opens the file, which another user may have made: a lock needs no right to write, but O_CREAT would be
// refused there.
int open_or_create(const std::string& file) {
  const int there = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW);
  if (there >= 0 || errno != ENOENT) return there;
  const int made = ::open(file.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW, 0644);
  if (made >= 0) ::fchmod(made, 0644);  // whatever the umask is
  return made;
}

// An open file that only we have locked; -1 if another has, or if it is not ours to open.
int try_lock(const std::string& file) {
  const int lock = open_or_create(file);
  if (lock < 0) return -1;
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
  ::close(lock);
  return -1;
}

}  // namespace

DomainLock::DomainLock() {
  // Not the same first each time: what was just ended may still have packets under way.
  constexpr int kCount = kLast - kFirst + 1;
  const int start = static_cast<int>(::getpid() % kCount);
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  for (int i = 0; i < kCount && lock_ < 0; ++i) {
    domain_ = kFirst + (start + i) % kCount;
    lock_ = try_lock(folder / ("swiftlet-domain-" + std::to_string(domain_) + ".lock"));
  }
  if (lock_ < 0) {
    throw std::runtime_error("all DDS domains from " + std::to_string(kFirst) + " to " +
                             std::to_string(kLast) + " are claimed; choose one with --domain");
  }
}

DomainLock::~DomainLock() { ::close(lock_); }

}  // namespace swiftlet::comms
