// Poses that arrive before the IMU samples of their time, which a radio delays: they wait until the estimate has reached
// them. Compared with an extrapolated estimate they would look like noise.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

// Not thread-safe. Does not allocate.
class PosesAhead {
 public:
  // longest_s: a pose that is further ahead does not wait. The IMU is silent then.
  explicit PosesAhead(double longest_s) : longest_ns_(static_cast<std::int64_t>(longest_s * 1e9)) {}

  // Keeps a pose that is ahead of the estimate, whose stamp is now_ns. Returns false for one that does not wait.
  bool keep(const plant::PoseSample& pose, std::int64_t now_ns) {
    const bool waits = pose.stamp_ns > now_ns && pose.stamp_ns - now_ns <= longest_ns_;
    if (!waits || count_ == poses_.size()) return false;
    poses_[(first_ + count_++) % poses_.size()] = pose;
    return true;
  }

  // The next kept pose that is not ahead of now_ns, in the order of arrival.
  std::optional<plant::PoseSample> take(std::int64_t now_ns) {
    if (count_ == 0 || poses_[first_].stamp_ns > now_ns) return std::nullopt;
    const std::size_t taken = first_;
    first_ = (first_ + 1) % poses_.size();
    --count_;
    return poses_[taken];
  }

  void clear() { count_ = 0; }

 private:
  std::int64_t longest_ns_;
  std::array<plant::PoseSample, 64> poses_;  // 64 ms of frames at 1 kHz
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::control
