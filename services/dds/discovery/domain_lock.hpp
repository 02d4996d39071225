// Reserves a DDS domain on this host, so that concurrent flights and tests do not receive each other's
// topics.
#pragma once

namespace swiftlet::dds {

// Holds a free domain for its lifetime, by a lock on a file in the folder for temporary files. The kernel
// releases the lock however the process ends. Child processes inherit the lock: the domain stays reserved
// until they have ended too.
class DomainLock {
 public:
  // Throws std::runtime_error if no domain of kFirst .. kLast is free.
  DomainLock();
  ~DomainLock();
  DomainLock(const DomainLock&) = delete;
  DomainLock& operator=(const DomainLock&) = delete;

  int domain() const { return domain_; }

  // Lower domains are left to users. The DDS ports of higher domains overlap the kernel's ephemeral ports.
  static constexpr int kFirst = 20;
  static constexpr int kLast = 99;

 private:
  int domain_ = -1;
  int lock_ = -1;
};

}  // namespace swiftlet::dds
