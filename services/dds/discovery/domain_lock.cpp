#include "swiftlet/services/dds/discovery/domain_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace swiftlet::dds {
namespace {

// Opens the lock file, which may belong to another user. A lock needs no write permission, but O_CREAT would
// be refused for such a file.
int open_or_create(const std::string& file) {
  const int there = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW);
  if (there >= 0 || errno != ENOENT) return there;
  const int made = ::open(file.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW, 0644);
  if (made >= 0) ::fchmod(made, 0644);  // whatever the umask is
  return made;
}

// Returns the file descriptor of the lock; -1 if another process holds it or the file cannot be opened.
int try_lock(const std::string& file) {
  const int lock = open_or_create(file);
  if (lock < 0) return -1;
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
  ::close(lock);
  return -1;
}

}  // namespace

DomainLock::DomainLock() {
  // The start varies, because a process that just ended may still have packets in flight in its domain.
  constexpr int kCount = kLast - kFirst + 1;
  const int start = static_cast<int>(::getpid() % kCount);
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  for (int i = 0; i < kCount && lock_ < 0; ++i) {
    domain_ = kFirst + (start + i) % kCount;
    lock_ = try_lock(folder / ("swiftlet-domain-" + std::to_string(domain_) + ".lock"));
  }
  if (lock_ < 0) {
    throw std::runtime_error("all DDS domains from " + std::to_string(kFirst) + " to " +
                             std::to_string(kLast) + " are in use; choose one with --domain");
  }
}

DomainLock::~DomainLock() { ::close(lock_); }

}  // namespace swiftlet::dds
