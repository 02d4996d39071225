#include "swiftlet/services/dds/throttled_warning.hpp"

#include <chrono>

#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::comms {

void ThrottledWarning::note(const Fault& fault) {
  ++suppressed_;
  const std::int64_t now_ns =
      std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  if (now_ns < next_ns_) return;
  runtime::log_warning("{} of {} refused: {}",
                       suppressed_ == 1 ? "a sample" : std::to_string(suppressed_) + " samples", topic_,
                       fault.text);
  suppressed_ = 0;
  next_ns_ = now_ns + 1'000'000'000;
}

}  // namespace swiftlet::comms
