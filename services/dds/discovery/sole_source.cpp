#include "swiftlet/services/dds/discovery/sole_source.hpp"

#include <stdexcept>
#include <utility>

namespace swiftlet::comms {
namespace {

[[noreturn]] void refuse(const std::string& other) {
  throw std::runtime_error(other + "; choose another --vehicle-name or --domain");
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

}  // namespace swiftlet::comms
