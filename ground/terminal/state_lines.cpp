#include "swiftlet/ground/terminal/state_lines.hpp"

#include <cmath>
#include <unistd.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/math/angles.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

// Rounded as it is shown, so that neither -0.0 nor 360.0 appears.
double tenths_of_degrees(double angle_rad) {
  return std::round(10.0 * math::kDegPerRad * angle_rad) / 10.0 + 0.0;
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<Silence>& silences) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Silence& silence : silences) {
    json.push_back({{"who", silence.who}, {"for_s", nullptr}});
    if (silence.for_s) json.back()["for_s"] = *silence.for_s;
  }
  return json;
}

void print_alarm(std::FILE* stream, const std::string& line) {
  const bool terminal = isatty(fileno(stream)) != 0;
  std::fprintf(stream, terminal ? "\x1b[1;31m%s\x1b[0m\n" : "%s\n", line.c_str());
}

double heading_deg(const Eigen::Quaterniond& q_ned_from_frd) {
  const double yaw_deg = tenths_of_degrees(math::euler_angles(q_ned_from_frd).heading.yaw_rad);
  return yaw_deg < 0.0 ? yaw_deg + 360.0 : yaw_deg;
}

std::string odometry_text(const messages::msg::ControlStatus& control) {
  const bool in_force =
      control.estimate_source() == messages::msg::ControlStatus_Constants::ESTIMATE_OF_VEHICLE;
  const bool compared = control.odometry_angle_rad() >= 0.0;
  if (!in_force && !compared && control.odometry_resets() == 0) return {};
  std::string text =
      compared ? fmt::format("{:.3f} m and {:.1f} degrees from motion capture", control.odometry_distance_m(),
                             math::kDegPerRad * control.odometry_angle_rad())
               : "no estimate of motion capture to compare with";
  if (control.odometry_resets() > 0) text += fmt::format(", {} jumps", control.odometry_resets());
  return text + (in_force ? ", flown by it" : ", flown by that of motion capture");
}

std::string attitude_text(const messages::msg::Estimate& estimate) {
  const Eigen::Quaterniond q_ned_from_frd = messages::wire::quaternion(estimate.q_ned_from_frd());
  const math::EulerAngles angles = math::euler_angles(q_ned_from_frd);
  return fmt::format("roll {:.1f}, pitch {:.1f}, heading {:.1f} deg", tenths_of_degrees(angles.roll_rad),
                     tenths_of_degrees(angles.pitch_rad), heading_deg(q_ned_from_frd));
}

}  // namespace swiftlet::ground
