// The arguments of the examples: which vehicle to fly.
#pragma once

#include <cstdlib>
#include <string>

#include <swiftlet/services/dds/node.hpp>

namespace swiftlet::examples {

// Reads [VEHICLE] [DOMAIN] [--localhost-only].
inline comms::NodeSettings network(int argc, char** argv) {
  comms::NodeSettings network;
  network.name = "example";
  if (argc > 1) network.vehicle = argv[1];
  if (argc > 2) network.domain = std::atoi(argv[2]);
  network.localhost_only = argc > 3 && std::string(argv[3]) == "--localhost-only";
  return network;
}

}  // namespace swiftlet::examples
