// A program's place on the network, from which its vehicles are made: any number of them share one DDS
// participant.
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
  // Of the settings, `name` is this program's own, as others see it; `vehicle` is not looked at. Throws
  // std::runtime_error with a sentence if the network cannot be joined.
  explicit Context(const comms::NodeSettings& network = {"ground"})
      : network_(network), participant_(network) {}

  // The names of the vehicles that publish in the domain now, sorted. Others are found within a second.
  std::vector<std::string> discovered_vehicles() const;

  const comms::NodeSettings& network() const { return network_; }
  const comms::Participant& participant() const { return participant_; }

 private:
  comms::NodeSettings network_;
  comms::Participant participant_;
};

}  // namespace swiftlet::ground
