#include "swiftlet/services/control/step_timing.hpp"

#include <algorithm>
#include <cstdlib>

namespace swiftlet::services {
namespace {

constexpr std::int64_t kDelayShare = 8;  // the expected time adapts by 1/8 of a delay per sample

}  // namespace

void StepTiming::arrived(std::uint64_t sequence, std::int64_t stamp_ns, std::int64_t now_ns,
                         bool rotors_running) {
  const std::int64_t elapsed_ns = stamp_ns - last_stamp_ns_;
  const bool restarts = last_sequence_ == 0 || sequence <= last_sequence_ || elapsed_ns <= 0;
  if (!restarts && sequence == last_sequence_ + 1) period_ns_ = elapsed_ns;
  const std::int64_t interval_ns = now_ns - arrival_ns_;
  const std::int64_t delay_ns = restarts ? 0 : now_ns - (expected_ns_ + elapsed_ns);
  expected_ns_ = delay_ns > 0 ? now_ns - delay_ns + delay_ns / kDelayShare : now_ns;
  last_sequence_ = sequence;
  last_stamp_ns_ = stamp_ns;
  arrival_ns_ = now_ns;

  if (rotors_running && !running_) {
    figures_ = {};
    jitter_.reset();
    first_arrival_ns_ = now_ns;
  }
  running_ = rotors_running;
  if (!running_) return;
  if (!restarts && figures_.cycles > 0) jitter_.record(std::abs(interval_ns - elapsed_ns));
  ++figures_.cycles;
  if (period_ns_ > 0 && delay_ns > period_ns_ / 2) ++figures_.deadline_misses;
  if (now_ns > first_arrival_ns_) {
    figures_.rate_hz =
        static_cast<double>(figures_.cycles - 1) * 1e9 / static_cast<double>(now_ns - first_arrival_ns_);
  }
}

void StepTiming::answered(std::int64_t now_ns) {
  if (!running_) return;
  figures_.longest_ns = std::max(figures_.longest_ns, now_ns - arrival_ns_);
  figures_.jitter_max_ns = jitter_.max_ns();
  if (figures_.cycles % kJitterUpdate != 0) return;
  figures_.jitter_p50_ns = jitter_.quantile_ns(0.5);
  figures_.jitter_p99_ns = jitter_.quantile_ns(0.99);
}

}  // namespace swiftlet::services
