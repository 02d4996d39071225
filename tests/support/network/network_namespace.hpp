// Hosts with networks of their own on this machine: network namespaces, as root.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::tests {

// Each host has the interfaces lo and eth0. The namespaces carry the number of this process in their names; the
// destructor deletes them, and the constructor also those that a killed test left.
class HostNetwork {
 public:
  enum class Layout {
    kSwitch,  // all on one switch, 10.77.0.0/24: multicast reaches everyone
    kRouter,  // each in a network of its own, 10.77.N.0/24, behind one router that forwards no multicast
  };

  // Why this machine may not make network namespaces, for GTEST_SKIP; empty if it may.
  static std::string why_unavailable();

  // Throws std::runtime_error with what failed.
  HostNetwork(Layout layout, int hosts);
  ~HostNetwork();
  HostNetwork(const HostNetwork&) = delete;
  HostNetwork& operator=(const HostNetwork&) = delete;

  // In place of a host: the switch or the router, whose interfaces are port0, port1, ...
  static constexpr int kCentre = -1;

  // host: 0 .. hosts - 1
  std::string address(int host) const;         // "10.77.0.1"
  std::string namespace_name(int host) const;  // for `ip netns exec`; also of kCentre

  // Runs a command of the shell on a host or kCentre, such as "ip link set eth0 down". Throws std::runtime_error
  // if it fails.
  void run(int host, const std::string& command) const;

  // As long as it lives, this thread, the threads and the programs that it starts, and their sockets are on the
  // host. Not for two hosts at a time in one thread.
  class Inside {
   public:
    Inside(const HostNetwork& network, int host);
    ~Inside();
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

   private:
    int outside_ = -1;
  };

 private:
  void connect(Layout layout);

  std::string prefix_;  // of the names
  std::string centre_;  // the namespace of the switch or the router
  std::vector<std::string> hosts_;
  std::vector<std::string> addresses_;
};

}  // namespace swiftlet::tests
