#include "swiftlet/services/control/lockstep_driver.hpp"

namespace swiftlet::services {

void LockstepDriver::on_sample(const VehicleSample& sample) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!levels_known_.load(std::memory_order_acquire)) return;
  if (!gate_.offer(sample)) return answers_.repeat();
  answer_if_complete();
}

void LockstepDriver::on_sensor(Stream stream, std::uint64_t sequence, const std::function<void()>& put) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!gate_.is_new(stream, sequence)) return;
  put();
  answer_if_complete();
}

// Another term in a sample reveals a rival.
void LockstepDriver::answer_if_complete() {
  const auto sample = gate_.take();
  if (!sample) return;
  Role role = Role::kActive;
  if (sample->obeyed.any && sample->obeyed.term != term_) {
    role = Role::kStandby;
    rival_.store(true, std::memory_order_relaxed);
    wake_.post();
  }
  answers_.answer(*sample, {role, term_, 0, {}});
}

}  // namespace swiftlet::services
