// A DDS domain of one's own, so that tests run in parallel without hearing each other.
#pragma once

#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <unistd.h>

namespace swiftlet::tests {

// Claims a free domain for as long as it lives, by a lock on a file in the folder for temporary files. Child
// processes inherit the claim: the domain is not free before they have ended too.
class DomainClaim {
 public:
  static constexpr int kFirst = 1;
  static constexpr int kLast = 100;  // the ports of higher ones lie where the kernel takes those of clients

  DomainClaim() {
    constexpr int kCount = kLast - kFirst + 1;
    const int start = static_cast<int>(::getpid() % kCount);
    for (int i = 0; i < kCount && fd_ < 0; ++i) try_claim(kFirst + (start + i) % kCount);
    if (fd_ < 0) throw std::runtime_error("all DDS domains from 1 to 100 are claimed");
  }
  ~DomainClaim() { ::close(fd_); }
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;

  int domain() const { return domain_; }

 private:
  void try_claim(int domain) {
    const auto path =
        std::filesystem::temp_directory_path() / ("swiftlet-domain-" + std::to_string(domain) + ".lock");
    const int fd = ::open(path.c_str(), O_RDONLY | O_CREAT, 0644);
    if (fd < 0) return;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) {
      fd_ = fd;
      domain_ = domain;
    } else {
      ::close(fd);
    }
  }

  int fd_ = -1;
  int domain_ = 0;
};

}  // namespace swiftlet::tests
