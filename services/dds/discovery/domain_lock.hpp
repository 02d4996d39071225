// A DDS domain of one's own on this host: flights and tests side by side must not hear each other.
#pragma once

namespace swiftlet::comms {

// Claims a free domain for as long as it lives, by a lock on a file in the folder for temporary files, which
// the kernel lets go however the process ends. Child processes inherit the claim: the domain is not free
// before they have ended too.
class DomainLock {
 public:
  // Throws std::runtime_error if no domain of kFirst .. kLast is free.
  DomainLock();
  ~DomainLock();
  DomainLock(const DomainLock&) = delete;
  DomainLock& operator=(const DomainLock&) = delete;

  int domain() const { return domain_; }

  // Below, people choose by hand; above, the ports of DDS reach into those that the kernel hands out.
  static constexpr int kFirst = 20;
  static constexpr int kLast = 99;

 private:
  int domain_ = -1;
  int lock_ = -1;
};

}  // namespace swiftlet::comms
