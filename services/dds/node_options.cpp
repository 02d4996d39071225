#include "swiftlet/services/dds/node_options.hpp"

#include "swiftlet/services/dds/discovery/host_address.hpp"
#include "swiftlet/services/dds/discovery/interfaces.hpp"

namespace swiftlet::comms {

void add_node_options(runtime::CommandLine app, NodeSettings& settings, const NameCheck& name) {
  app.add_option("--domain", settings.domain, "DDS domain")
      .environment("ROS_DOMAIN_ID")
      .range(0, 232)
      .show_default();
  app.add_option("--vehicle-name", settings.vehicle, "Namespace of the topics")
      .show_default()
      .check(name.fault_of, name.value_name);
  app.add_choice("--transport", settings.transport,
                 {{"udp", Transport::kUdp}, {"shm", Transport::kSharedMemory}},
                 "udp, or shm: shared memory between processes of this host")
      .show_default("udp");
  runtime::Option localhost_only = app.add_flag("--localhost-only", settings.localhost_only,
                                                "Use the loopback interface only, without multicast");
  app.add_option("--peer", settings.network.peers,
                 "Find the processes of this host without multicast; once for each other host")
      .repeated()
      .check(fault_of_host_address, "HOST[:PORT]")
      .excludes(localhost_only);
  app.add_option("--interface", settings.network.interfaces,
                 "Use this network interface only; may be repeated")
      .repeated()
      .check(fault_of_interface, "NAME|ADDRESS")
      .excludes(localhost_only);
}

}  // namespace swiftlet::comms
