// The command-line options of every program that joins the network.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::dds {

// The check of --vehicle-name, as for runtime::Option::check().
struct NameCheck {
  std::function<std::string(const std::string&)> fault_of = messages::fault_of_vehicle_name;
  std::string value_name = "NAME";
};

// --domain (default $ROS_DOMAIN_ID or 0), --vehicle-name; --localhost-only, --network, --peer (default $ROS_STATIC_PEERS), --discovery-server (default
// $ROS_DISCOVERY_SERVER), --interface,
// --dds-profile (default $FASTDDS_DEFAULT_PROFILES_FILE, else $FASTRTPS_DEFAULT_PROFILES_FILE), --network-key
// (default $SWIFTLET_NETWORK_KEY), --open-network (default
// $SWIFTLET_OPEN_NETWORK), --security (default $SWIFTLET_SECURITY).
void add_node_options(runtime::CommandLine app, NodeSettings& settings, const NameCheck& name = {});

// The same for a program that serves vehicles: --vehicle-name takes a list (vehicle_names.hpp), which it leaves in
// settings.vehicle.
void add_service_options(runtime::CommandLine app, NodeSettings& settings);

// The file of --network (YAML): the options of the network, for all processes of a host. All keys are optional:
//   peers: [lab2, 10.0.0.7:7412]        # or discovery_servers: [lab1:11811]
//   interfaces: [eth0]
//   dds_profile: profile.xml            # relative to this file
//   network_key: lab.key                # likewise
//   security: lab                       # likewise
//   open_network: true
// Sets what the file has; other settings stay, but for servers if it has peers, and the other way round. file_name appears in
// messages, and its folder is that of relative paths. Throws io::ConfigError.
void apply_network_file(std::string_view text, const std::string& file_name, NodeSettings& settings);

// --network-key alone.
void add_network_key_option(runtime::CommandLine app, std::string& file);

}  // namespace swiftlet::dds
