// What `swiftlet doctor network` concludes from what it has measured.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/ground/cli/network/network_probe.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

struct NetworkFacts {
  dds::NodeSettings settings;
  std::vector<io::Interface> interfaces;  // those that are used
  ground::ProbeReport probe;
  std::vector<dds::ProcessIdentity> processes;  // discovered over DDS
  std::vector<std::string> mismatches;          // of types, QoS and topic names: sentences
  std::vector<std::string> refused_keys;        // likewise
};

struct NetworkFinding {
  bool is_fault = false;  // else a hint: it may be as intended
  std::string sentence;
};

// Faults first.
std::vector<NetworkFinding> findings(const NetworkFacts& facts);

}  // namespace swiftlet::ground
