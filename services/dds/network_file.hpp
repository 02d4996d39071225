// The network file: the options of the network in YAML, for all processes of a host. All keys are optional:
//   peers: [lab2, 10.0.0.7:7412]        # or localhost_only: true, or discovery_servers: [lab1:11811]
//   interfaces: [eth0]
//   dds_profile: profile.xml            # relative to this file
//   network_key: lab.key                # relative to this file
//   security: lab                       # likewise
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// Sets what the file has; other settings stay. Peers, servers and localhost_only exclude each other: one in the
// file replaces the others in `settings`. file_name appears in messages, and its folder is that of dds_profile. Throws
// runtime::ConfigError.
void apply_network_file(std::string_view text, const std::string& file_name, NodeSettings& settings);
void load_network_file(const std::string& path, NodeSettings& settings);

}  // namespace swiftlet::comms
