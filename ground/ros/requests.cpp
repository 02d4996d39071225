#include "swiftlet/ground/ros/requests.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "swiftlet/record/file/standard_messages.hpp"
#include "swiftlet/record/mcap/cdr_reader.hpp"

namespace swiftlet::ros {
namespace {

using mcap::CdrReader;

constexpr double kUnitTolerance = 1e-3;
constexpr double kQuarterTurn_rad = 1.5707963267948966;

Eigen::Vector3d vector(CdrReader& in) {
  const auto x = in.number<double>();
  const auto y = in.number<double>();
  return {x, y, in.number<double>()};
}

Eigen::Quaterniond quaternion(CdrReader& in) {
  const Eigen::Vector3d xyz = vector(in);
  return {in.number<double>(), xyz.x(), xyz.y(), xyz.z()};
}

}  // namespace

std::optional<Goal> goal_of(const Bytes& payload, double present_down_m, std::string& refusal) {
  CdrReader in({payload.data(), payload.size()});
  in.number<std::uint32_t>();  // stamp
  in.number<std::uint32_t>();
  const std::string frame(in.text());
  const Eigen::Vector3d position_enu = vector(in);
  const Eigen::Quaterniond q_enu = quaternion(in);
  refusal.clear();
  if (!in.ok())
    refusal = "it is no geometry_msgs/PoseStamped";
  else if (!frame.empty() && frame != record::kMapFrame)
    refusal = "its frame is '" + frame + "', must be " + record::kMapFrame;
  else if (!position_enu.allFinite())
    refusal = "its position is not finite";
  else if (!(std::abs(q_enu.norm() - 1.0) < kUnitTolerance))
    refusal = "its orientation is no unit quaternion";
  else if (position_enu.z() == 0.0 && !std::isfinite(present_down_m))
    refusal = "it has no height, and that of the vehicle is not known yet";
  if (!refusal.empty()) return std::nullopt;

  Goal goal;
  goal.position_ned_m = record::enu_from_ned(position_enu);  // its own inverse
  if (position_enu.z() == 0.0) goal.position_ned_m.z() = present_down_m;
  const Eigen::Vector3d forward_enu = q_enu * Eigen::Vector3d::UnitX();
  goal.yaw_rad = kQuarterTurn_rad - std::atan2(forward_enu.y(), forward_enu.x());
  return goal;
}

std::optional<ground::VelocitySetpoint> velocity_of(const Bytes& payload, double yaw_rad,
                                                    std::string& refusal) {
  CdrReader in({payload.data(), payload.size()});
  const Eigen::Vector3d velocity_flu = vector(in);
  const Eigen::Vector3d rates_flu = vector(in);
  refusal.clear();
  if (!in.ok())
    refusal = "it is no geometry_msgs/Twist";
  else if (!velocity_flu.allFinite() || !rates_flu.allFinite())
    refusal = "it is not finite";
  else if (rates_flu.x() != 0.0 || rates_flu.y() != 0.0)
    refusal = "its roll or pitch rate is not 0";
  else if (!std::isfinite(yaw_rad))
    refusal = "the heading of the vehicle is not known yet";
  if (!refusal.empty()) return std::nullopt;

  ground::VelocitySetpoint setpoint;
  setpoint.velocity_ned_m_s =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * record::flu_from_frd(velocity_flu);
  setpoint.heading.yaw_rate_rad_s = -rates_flu.z();
  return setpoint;
}

}  // namespace swiftlet::ros
