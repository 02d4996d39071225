// Reserves the names of vehicles in a domain that others may use too, before the processes of a simulated
// flight are started.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

class FlightReservation {
 public:
  // network.vehicle is ignored. Blocks for kSourceSearchTime or kLongSourceSearchTime. Throws
  // std::runtime_error with a sentence if a process publishes as one of the vehicles or as its motion capture, or if another
  // flight has reserved one of the names. Of two flights that start at the same time, one is refused, here or when its plant
  // starts.
  FlightReservation(const NodeSettings& network, const std::vector<std::string>& vehicles);

 private:
  Participant participant_;
  std::deque<Node> nodes_;
};

}  // namespace swiftlet::comms
