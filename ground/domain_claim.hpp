// A DDS domain of one's own on this host: flights side by side must not hear each other.
#pragma once

namespace swiftlet::ground {

// Holds a lock file in the temporary folder, which the kernel lets go when the process ends, however it ends.
class DomainClaim {
 public:
  // Takes the first free domain of kFirst .. kLast. Throws std::runtime_error if none is free.
  DomainClaim();
  ~DomainClaim();
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;

  int domain() const { return domain_; }

  // Below, people choose by hand; above, the ports of DDS reach into those that the kernel hands out.
  static constexpr int kFirst = 20;
  static constexpr int kLast = 99;

 private:
  int domain_ = -1;
  int lock_ = -1;
};

}  // namespace swiftlet::ground
