#include <algorithm>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::messages {

msg::ControlStatus to_message(const control::Status& in, const control::ControlGains& gains,
                              const control::FailsafeSettings& thresholds) {
  msg::ControlStatus out;
  out.wire_version(kWireVersion);
  out.mode(static_cast<std::uint8_t>(in.mode));
  out.reason_code(static_cast<std::uint8_t>(in.reason));
  out.reason() = control::to_string(in.reason);
  out.airborne(in.airborne);
  out.has_pose(in.has_pose);
  out.pose_age_s(in.pose_age_s);
  out.supply_voltage_v(in.supply_voltage_v);
  out.low_battery_voltage_v(thresholds.low_battery_voltage);
  out.critical_battery_voltage_v(thresholds.critical_battery_voltage);
  out.saturated(in.saturated);
  out.ground_links(static_cast<std::uint8_t>(in.ground_links));
  out.control_level(plant::ControlLevels(in.level).bits());
  out.estimate_source(in.odometry.in_force ? msg::ControlStatus_Constants::ESTIMATE_OF_VEHICLE
                                           : msg::ControlStatus_Constants::ESTIMATE_OF_MOCAP);
  out.odometry_distance_m(in.odometry.distance_m);
  out.odometry_angle_rad(in.odometry.angle_rad);
  out.odometry_resets(in.odometry.resets);
  out.settings() = in.settings.data();
  out.gains_progress(in.gains_progress);
  out.gains(to_message(gains));
  return out;
}

msg::MissionStatus to_message(const control::MissionProgress& in) {
  msg::MissionStatus out;
  out.mission_id(in.id);
  out.state(static_cast<std::uint8_t>(in.state));
  out.item_index(static_cast<std::uint32_t>(std::max(in.item_index, 0)));
  out.item_count(static_cast<std::uint32_t>(std::max(in.item_count, 0)));
  return out;
}

}  // namespace swiftlet::messages
