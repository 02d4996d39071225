// A DDS participant that the vehicles of a program share.
//
//   swiftlet::ground::Context context;                       // domain 0
//   swiftlet::ground::Vehicle first(context, "kl1"), second(context, "kl2");
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

class Context {
 public:
  // network.name: this program's name in the domain. network.vehicle is ignored. Throws std::runtime_error if
  // the network cannot be joined.
  explicit Context(const dds::NodeSettings& network = {"ground"})
      : network_(network), participant_(network) {}

  // The names of the vehicles discovered in the domain so far, sorted. Discovery takes up to a second.
  std::vector<std::string> discovered_vehicles() const;

  const dds::NodeSettings& network() const { return network_; }
  const dds::Participant& participant() const { return participant_; }

 private:
  dds::NodeSettings network_;
  dds::Participant participant_;
};

}  // namespace swiftlet::ground
