// The hosts of the benchmark of discovery, and what their interfaces receive.
#pragma once

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <memory>
#include <net/if.h>
#include <optional>
#include <sched.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/network/network_namespace.hpp"

namespace swiftlet::bench {

// Moves this process into a network namespace with nothing but a loopback interface. Returns false without the
// permission for that.
inline bool enter_own_network() {
  if (::unshare(CLONE_NEWNET) != 0) return false;
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP | IFF_RUNNING;
  const bool up = ::ioctl(socket, SIOCSIFFLAGS, &loopback) == 0;
  ::close(socket);
  if (!up) throw std::runtime_error("the loopback interface of a new network namespace cannot be started");
  // A discovery server of Fast DDS 2.9 does not start where there is a loopback interface only.
  if (std::system("ip link add bench0 type veth peer name bench1 && ip addr add 10.79.1.1/24 dev bench0 && "
                  "ip link set bench0 up && ip link set bench1 up") != 0)
    throw std::runtime_error("no interface can be added to a new network namespace");
  return true;
}

struct Traffic {
  double bytes = 0.0;
  double packets = 0.0;
};

// What the interfaces of this network have received so far.
inline Traffic received() {
  std::ifstream file("/proc/thread-self/net/dev");
  Traffic all;
  for (std::string line; std::getline(file, line);) {
    const std::size_t name_end = line.find(':');
    if (name_end == std::string::npos) continue;
    Traffic one;
    std::istringstream(line.substr(name_end + 1)) >> one.bytes >> one.packets;
    all.bytes += one.bytes;
    all.packets += one.packets;
  }
  return all;
}

// The hosts of the fleet: this one, or several on a switch.
class Hosts {
 public:
  explicit Hosts(int count) : count_(count) {
    if (count > 1) {
      switch_.emplace(tests::HostNetwork::Layout::kSwitch, count);
    } else if (!enter_own_network()) {
      std::fprintf(stderr, "discovery_bench: not root: the traffic of other programs is counted too\n");
    }
  }

  int count() const { return count_; }
  std::string server_address() const { return switch_ ? switch_->address(0) : "127.0.0.1"; }
  // Moves this process, which has one thread, to a host.
  void enter(int host) {
    if (switch_) inside_ = std::make_unique<tests::HostNetwork::Inside>(*switch_, host);
  }
  // What all hosts have received so far.
  Traffic traffic() const {
    if (!switch_) return received();
    Traffic all;
    for (int host = 0; host < count_; ++host) {
      const tests::HostNetwork::Inside inside(*switch_, host);
      const Traffic one = received();
      all.bytes += one.bytes;
      all.packets += one.packets;
    }
    return all;
  }

 private:
  const int count_;
  std::optional<tests::HostNetwork> switch_;
  std::unique_ptr<tests::HostNetwork::Inside> inside_;
};

}  // namespace swiftlet::bench
