#include "services/comms/node_options.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace swiftlet::comms {

void add_node_options(CLI::App& app, NodeSettings& settings) {
  app.add_option("--domain", settings.domain, "DDS domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.add_option("--vehicle-name", settings.vehicle, "Namespace of the topics")->capture_default_str();
  app.add_option_function<std::string>(
         "--transport",
         [&settings](const std::string& name) {
           settings.transport = name == "shm" ? Transport::kSharedMemory : Transport::kUdp;
         },
         "udp, or shm: shared memory between processes of this host")
      ->check(CLI::IsMember({"udp", "shm"}))
      ->default_str("udp");
  app.add_flag("--localhost-only", settings.localhost_only,
               "Use the loopback interface only, without multicast");
}

}  // namespace swiftlet::comms
