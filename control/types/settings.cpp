#include "swiftlet/control/types/settings.hpp"

#include <string>

#include "swiftlet/control/types/settings_visit.hpp"
#include "swiftlet/plant/model/setting_values.hpp"

namespace swiftlet::control {

namespace {

using plant::RuleChecker;

constexpr double kMaxTilt = 1.5;  // rad; some vertical thrust must remain
constexpr char kAxis[] = {'x', 'y', 'z'};

void check_weights(const std::string& key, const LqrWeights& weights, RuleChecker& check) {
  check.above(key + ".q[0]", weights.q[0], 0.0);
  check.at_least(key + ".q[1]", weights.q[1], 0.0);
  check.at_least(key + ".q[2]", weights.q[2], 0.0);
}

void check_limits(const Limits& limits, RuleChecker& check) {
  check.between("limits.max_tilt_rad", limits.max_tilt_rad, 0.0, kMaxTilt);
  for (int i = 0; i < 3; ++i) {
    if (!(limits.fence_max_ned[i] <= limits.fence_min_ned[i])) continue;
    check.add("limits.fence_max_ned_m[" + std::to_string(i) + "]", "is ", limits.fence_max_ned[i],
              ", must be above fence_min_ned_m in ", kAxis[i], ", ", limits.fence_min_ned[i]);
  }
  if (limits.min_height_m > -limits.fence_min_ned.z()) {
    check.add("limits.min_height_m", "is ", limits.min_height_m,
              ", must be at most the height of the fence, ", -limits.fence_min_ned.z());
  }
}

}  // namespace

std::vector<plant::Violation> validate(const ControlSettings& settings) {
  RuleChecker check;
  if (settings.name.empty()) check.add("name", "is empty, must be given");
  plant::check_settings(settings, check);
  check_weights("attitude.roll", settings.attitude.roll, check);
  check_weights("attitude.pitch", settings.attitude.pitch, check);
  check_weights("attitude.yaw", settings.attitude.yaw, check);
  check_limits(settings.limits, check);
  if (settings.failsafe.tip_over_tilt_rad <= settings.limits.max_tilt_rad) {
    check.add("failsafe.tip_over_tilt_rad", "is ", settings.failsafe.tip_over_tilt_rad,
              ", must be above limits.max_tilt_rad, ", settings.limits.max_tilt_rad);
  }
  return check.take();
}

}  // namespace swiftlet::control
