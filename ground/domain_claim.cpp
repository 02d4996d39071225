#include "ground/domain_claim.hpp"

#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <unistd.h>

namespace swiftlet::ground {
namespace {

// An open file that only we have locked; -1 if another has, or if the file is not ours to open.
int try_lock(const std::string& file) {
  const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (lock < 0) return -1;
  if (flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
  close(lock);
  return -1;
}

}  // namespace

DomainClaim::DomainClaim() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  for (int domain = kFirst; domain <= kLast; ++domain) {
    lock_ = try_lock(folder / ("swiftlet-domain-" + std::to_string(domain) + ".lock"));
    if (lock_ < 0) continue;
    domain_ = domain;
    return;
  }
  throw std::runtime_error("no DDS domain is free between " + std::to_string(kFirst) + " and " +
                           std::to_string(kLast) + "; choose one with --domain");
}

DomainClaim::~DomainClaim() { close(lock_); }

}  // namespace swiftlet::ground
