#include "services/comms/node_options.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace swiftlet::comms {

void add_node_options(CLI::App& app, NodeSettings& settings) {
  static const std::map<std::string, Transport> kTransports{{"udp", Transport::kUdp},
                                                            {"shm", Transport::kSharedMemory}};
  app.add_option("--domain", settings.domain, "DDS domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.add_option("--vehicle-name", settings.vehicle, "Namespace of the topics")->capture_default_str();
  app.add_option("--transport", settings.transport,
                 "udp, or shm: shared memory between processes of this host")
      ->transform(CLI::CheckedTransformer(kTransports).description("{udp,shm}"))
      ->default_str("udp");
  app.add_flag("--localhost-only", settings.localhost_only,
               "Use the loopback interface only, without multicast");
}

}  // namespace swiftlet::comms
