#include "swiftlet/services/dds/discovery/flight_reservation.hpp"

#include <stdexcept>

namespace swiftlet::comms {
namespace {

NodeSettings announced(NodeSettings network) {
  network.name = "swiftlet fly";
  network.source_of = kFlight;
  network.announcement_period = kFixturePeriod;  // several announcements within kSourceSearchTime
  return network;
}

}  // namespace

FlightReservation::FlightReservation(const NodeSettings& network, const std::vector<std::string>& vehicles)
    : participant_(announced(network), vehicles) {
  for (const std::string& vehicle : vehicles) nodes_.emplace_back(participant_, vehicle);
  const auto other = participant_.become_source({kFlight, topics::kImu.name, topics::kMocapPose.name});
  if (other) {
    throw std::runtime_error(*other + "; choose another --vehicle-name or --domain, or fly it with --attach");
  }
}

}  // namespace swiftlet::comms
