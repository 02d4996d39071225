// The arguments of the examples: which vehicle to fly.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <swiftlet/services/dds/node.hpp>

namespace swiftlet::examples {

struct Arguments {
  std::vector<std::string> own;  // of the example itself
  dds::NodeSettings network;
};

// Reads [VEHICLE] [DOMAIN] [--open-network], after the arguments of the example itself, whose names are
// `own`. Prints the usage and ends the program if the arguments ask for help (exit code 0) or are wrong (2).
inline Arguments read_arguments(int argc, char** argv, const std::vector<std::string>& own = {}) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto end_with_usage = [&](std::FILE* out, int exit_code) {
    std::fprintf(out, "usage: %s", argv[0]);
    for (const std::string& name : own) std::fprintf(out, " %s", name.c_str());
    std::fprintf(out, " [VEHICLE] [DOMAIN] [--open-network]\n");
    std::exit(exit_code);
  };
  std::vector<std::string> places;
  dds::NodeSettings network;
  network.name = "example";
  for (const std::string& word : words) {
    if (word == "--help" || word == "-h") end_with_usage(stdout, 0);
    if (word == "--open-network") {
      network.open_network = true;
    } else if (word.rfind('-', 0) == 0) {
      end_with_usage(stderr, 2);
    } else {
      places.push_back(word);
    }
  }
  const std::size_t first = own.size();
  if (places.size() < first || places.size() > first + 2) end_with_usage(stderr, 2);
  if (places.size() > first) network.vehicle = places[first];
  if (places.size() > first + 1) {
    char* end = nullptr;
    const long domain = std::strtol(places[first + 1].c_str(), &end, 10);
    if (*end != '\0' || domain < 0 || domain > 232) end_with_usage(stderr, 2);
    network.domain = static_cast<int>(domain);
  }
  places.resize(first);
  return {places, network};
}

}  // namespace swiftlet::examples
