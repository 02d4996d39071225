#include "swiftlet/control/estimation/sent_commands.hpp"

#include <algorithm>

namespace swiftlet::control {

void SentCommands::sent(std::int64_t stamp_ns, double thrust_n) {
  if (count_ > 0 && stamp_ns <= at(count_ - 1).stamp_ns) return;
  if (count_ == kCapacity) {
    oldest_ = (oldest_ + 1) % kCapacity;
    --count_;
  }
  commands_[(oldest_ + count_) % kCapacity] = {stamp_ns, thrust_n};
  ++count_;
}

// Commands older than the obeyed one are of no use any more: the vehicle obeys none that is older than the last.
void SentCommands::sample(std::int64_t stamp_ns, double dt_s, const plant::ObeyedCommand& obeyed) {
  if (!obeyed.reported) {
    obeyed_thrust_n_ = count_ > 0 ? at(count_ - 1).thrust_n : 0.0;
    return;
  }
  if (!obeyed.any) {
    obeyed_thrust_n_ = 0.0;
    return;
  }
  while (count_ > 1 && at(1).stamp_ns <= obeyed.stamp_ns) {
    oldest_ = (oldest_ + 1) % kCapacity;
    --count_;
  }
  obeyed_thrust_n_ = count_ > 0 ? at(0).thrust_n : 0.0;
  const double age_s =
      std::clamp(1e-9 * static_cast<double>(stamp_ns - obeyed.stamp_ns), 0.0, kLongestDelay_s);
  delay_s_ += (reported_ ? dt_s / (kMemory_s + dt_s) : 1.0) * (age_s - delay_s_);
  reported_ = true;
}

}  // namespace swiftlet::control
