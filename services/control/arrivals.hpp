// When the samples of the streams that control receives arrived last.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>

namespace swiftlet::services {

// The newest sample of one stream. note() is called by one thread, the other methods by any.
class Arrivals {
 public:
  // stamp_ns: of the sample, on the vehicle's clock. now_ns: monotonic.
  void note(std::int64_t stamp_ns, std::uint64_t sequence, std::int64_t now_ns) {
    stamp_ns_.store(stamp_ns, std::memory_order_relaxed);
    sequence_.store(sequence, std::memory_order_relaxed);
    arrived_ns_.store(now_ns, std::memory_order_relaxed);
  }

  // Time since the last arrival, s; -1 if there was none. vehicle_now_ns: the vehicle's clock, if it runs. It
  // may be slower than the computer's in a simulation; the smaller of the two ages counts.
  double age_s(std::int64_t now_ns, std::optional<std::int64_t> vehicle_now_ns = std::nullopt) const {
    const std::int64_t arrived_ns = arrived_ns_.load(std::memory_order_relaxed);
    if (arrived_ns == kNever) return -1.0;
    std::int64_t age_ns = now_ns - arrived_ns;
    if (vehicle_now_ns) age_ns = std::min(age_ns, *vehicle_now_ns - stamp_ns());
    return 1e-9 * static_cast<double>(std::max<std::int64_t>(age_ns, 0));
  }
  std::int64_t stamp_ns() const { return stamp_ns_.load(std::memory_order_relaxed); }
  std::uint64_t sequence() const { return sequence_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kNever = -1;
  std::atomic<std::int64_t> stamp_ns_{0};
  std::atomic<std::uint64_t> sequence_{0};
  std::atomic<std::int64_t> arrived_ns_{kNever};
};

// The ages of the streams, s, as in Arrivals::age_s().
struct StreamAges {
  double imu_s = -1.0;
  double pose_s = -1.0;
  double battery_s = -1.0;
};

// An IMU older than this is silent. The controller takes no step meanwhile; only a stop request is obeyed.
constexpr double kImuSilence_s = 0.05;

}  // namespace swiftlet::services
