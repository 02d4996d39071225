// How a process finds the processes of other hosts.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::comms {

struct NetworkSettings {
  // Hosts to which it announces itself, "HOST" or "HOST:PORT"; without a port to the first discovery ports of
  // the domain. If there are any, it uses no multicast. Own processes of this host are found without.
  std::vector<std::string> peers{};
  // It sends and receives on these interfaces only, by name or IPv4 address. Empty: on all.
  std::vector<std::string> interfaces{};

  bool uses_multicast() const { return peers.empty(); }
};

}  // namespace swiftlet::comms
