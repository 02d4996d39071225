// Which poses of motion capture go on to PX4's estimator, and with which counter.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/px4/translate.hpp"

namespace swiftlet::px4 {

enum class VisionStamps {
  kNow,    // 0: PX4 takes the time of arrival, and its EKF2_EV_DELAY is the delay of motion capture
  kAgent,  // of the exposure on the system clock of this host, which is that of PX4's agent if it runs here
};

struct VisionSettings {
  PoseDeviation deviation;
  double rate_hz = 100.0;  // the most; 0: none, PX4 has sensors of its own
  VisionStamps stamps = VisionStamps::kNow;
};

class Vision {
 public:
  explicit Vision(const VisionSettings& settings) : settings_(settings) {}

  // A pose that arrived at now_ns; its stamp is on the same clock. system_minus_now_ns: the system clock then minus now_ns.
  // nullopt: untracked, old, or more than the rate. A jump of the pose, which no vehicle flies, changes the reset counter.
  std::optional<msg::VehicleOdometry> take(const plant::PoseSample& pose, std::int64_t now_ns,
                                           std::int64_t system_minus_now_ns);

  // The last tracked pose, whether passed on or not.
  const std::optional<plant::PoseSample>& last() const { return last_; }
  std::uint64_t passed() const { return passed_; }
  std::uint8_t resets() const { return resets_; }

 private:
  bool jumps(const plant::PoseSample& pose) const;

  const VisionSettings settings_;
  std::optional<plant::PoseSample> last_;
  std::int64_t passed_ns_ = 0;
  std::uint64_t passed_ = 0;
  std::uint8_t resets_ = 0;
};

}  // namespace swiftlet::px4
