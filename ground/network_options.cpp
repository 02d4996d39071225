#include "ground/network_options.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace swiftlet::ground {
namespace {

const std::map<std::string, comms::Transport> kTransports = {{"udp", comms::Transport::kUdp},
                                                             {"shm", comms::Transport::kSharedMemory}};

}  // namespace

void add_vehicle_options(CLI::App& app, comms::NodeSettings& network) {
  app.add_option("--vehicle-name", network.vehicle, "name of the vehicle on the network")
      ->envname("SWIFTLET_VEHICLE")
      ->check(CLI::Validator(
          [](const std::string& name) -> std::string {
            const bool plain =
                name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
                std::string::npos;
            return plain && !name.empty() && name.size() <= 64 ? "" : "must be 1 to 64 letters, digits and _";
          },
          "NAME"))
      ->capture_default_str();
  app.add_option("--transport", network.transport, "udp, or shm between processes of one user on one host")
      ->transform(CLI::CheckedTransformer(kTransports))
      ->type_name("udp|shm");
  app.add_flag("--localhost-only,!--network", network.localhost_only,
               "stay on the loopback interface, or use all (as it is: " +
                   std::string(network.localhost_only ? "loopback" : "all") + ")");
}

void add_domain_option(CLI::App& app, int& domain) {
  app.add_option("--domain", domain, "DDS domain")
      ->envname("SWIFTLET_DOMAIN")
      ->check(CLI::Range(0, kMaxDomain))
      ->capture_default_str();
}

const char* to_string(comms::Transport transport) {
  for (const auto& [name, value] : kTransports) {
    if (value == transport) return name.c_str();
  }
  return "udp";
}

}  // namespace swiftlet::ground
