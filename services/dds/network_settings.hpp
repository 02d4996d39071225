// How a process finds the processes of other hosts.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::comms {

struct NetworkSettings {
  // Hosts to which it announces itself, "HOST" or "HOST:PORT"; without a port to the first discovery ports of
  // the domain. If there are any, it uses no multicast. Own processes of this host are found without.
  std::vector<std::string> peers{};
  // It sends and receives on these interfaces, by name or IPv4 address, and the loopback interface only. Empty: on all.
  std::vector<std::string> interfaces{};

  // The servers that tell it of the others, "HOST[:PORT][;...]" (discovery_servers.hpp). It uses no multicast then. Not
  // with peers. Empty: none.
  std::string discovery_servers{};
  // An XML file of Fast DDS, whose default participant profile applies under what Swiftlet sets itself
  // (dds_profile.hpp). Empty: none.
  std::string dds_profile{};

  std::string file{};  // that was applied (network_file.hpp); empty: none

  bool uses_multicast() const { return peers.empty() && discovery_servers.empty(); }
};

}  // namespace swiftlet::comms
