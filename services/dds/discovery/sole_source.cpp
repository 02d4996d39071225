#include "swiftlet/services/dds/discovery/sole_source.hpp"

#include <stdexcept>
#include <utility>

namespace swiftlet::dds {
namespace {

[[noreturn]] void refuse(const std::string& other) {
  throw std::runtime_error(other + "; choose another --vehicle-name or --domain");
}

NodeSettings announced(NodeSettings network) {
  network.name = "swiftlet fly";
  network.source_of = kFlight;
  network.announcement_period = messages::kFixturePeriod;  // several announcements within kSourceSearchTime
  return network;
}

}  // namespace

SoleSource::SoleSource(Participant& participant, const std::string& topic, std::function<void()> on_lost) {
  const auto other = participant.become_source(
      {topic}, [loss = loss_, on_lost = std::move(on_lost)](const std::string& sentence) {
        {
          const std::lock_guard<std::mutex> lock(loss->mutex);
          loss->other = sentence;
        }
        on_lost();
      });
  if (other) refuse(*other);
}

void SoleSource::check() const {
  const std::lock_guard<std::mutex> lock(loss_->mutex);
  if (!loss_->other.empty()) refuse(loss_->other);
}

FlightReservation::FlightReservation(const NodeSettings& network, const std::vector<std::string>& vehicles)
    : participant_(announced(network), vehicles) {
  for (const std::string& vehicle : vehicles) nodes_.emplace_back(participant_, vehicle);
  const auto other =
      participant_.become_source({kFlight, messages::topics::kImu.name, messages::topics::kMocapPose.name});
  if (other) {
    throw std::runtime_error(*other + "; choose another --vehicle-name or --domain, or fly it with --attach");
  }
}

}  // namespace swiftlet::dds
