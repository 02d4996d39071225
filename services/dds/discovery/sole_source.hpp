// Makes a process the only source of its topic, or ends it; and reserves vehicles for a flight that starts such processes.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds {

// A process that finds another source of one of its vehicles ends with an error.
class SoleSource {
 public:
  // topic: NodeSettings::source_of of the participant. Blocks for kSourceSearchTime or kLongSourceSearchTime.
  // Throws std::runtime_error with a sentence if there is another source. on_lost: called from another thread if an earlier
  // source is discovered later; then call check().
  SoleSource(Participant& participant, const std::string& topic, std::function<void()> on_lost);

  // Throws std::runtime_error if an earlier source was discovered.
  void check() const;

 private:
  struct Loss {
    std::mutex mutex;
    std::string other;  // a sentence
  };
  std::shared_ptr<Loss> loss_ =
      std::make_shared<Loss>();  // the participant's callback may outlive this object
};

// Reserves the names of vehicles in a domain that others may use too, before the processes of a simulated flight are started.
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

}  // namespace swiftlet::dds
