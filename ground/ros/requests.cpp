#include "swiftlet/ground/ros/requests.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/record/file/standard_messages.hpp"

namespace swiftlet::ros {
namespace {

constexpr double kUnitTolerance = 1e-3;
constexpr double kQuarterTurn_rad = 1.5707963267948966;

// Numbers of a CDR payload in sequence, aligned from behind the encapsulation header.
class CdrReader {
 public:
  explicit CdrReader(const Bytes& payload)
      : reader_(payload.data(), payload.size(), payload.size() > 1 && payload[1] == 1) {
    reader_.skip(kHeaderBytes);
    begin_ = reader_.rest();
    if (payload.size() > 1 && payload[1] > 1)
      reader_.skip(payload.size());  // another encoding: ok() is false
  }

  std::uint32_t u32() {
    align(sizeof(std::uint32_t));
    return reader_.u32();
  }
  double f64() {
    align(sizeof(double));
    return reader_.f64();
  }
  Eigen::Vector3d vector() {
    const double x = f64();
    const double y = f64();
    return {x, y, f64()};
  }
  Eigen::Quaterniond quaternion() {
    const Eigen::Vector3d xyz = vector();
    return {f64(), xyz.x(), xyz.y(), xyz.z()};
  }
  std::string text() {
    const std::uint32_t length = u32();  // with the NUL
    return std::string(reader_.text_field(length));
  }
  bool ok() const { return reader_.ok(); }

 private:
  static constexpr std::size_t kHeaderBytes = 4;

  void align(std::size_t size) { reader_.skip((size - (begin_ - reader_.rest()) % size) % size); }

  io::ByteReader reader_;
  std::size_t begin_ = 0;
};

}  // namespace

std::optional<Goal> goal_of(const Bytes& payload, double present_down_m, std::string& refusal) {
  CdrReader in(payload);
  in.u32();  // stamp
  in.u32();
  const std::string frame = in.text();
  const Eigen::Vector3d position_enu = in.vector();
  const Eigen::Quaterniond q_enu = in.quaternion();
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
  CdrReader in(payload);
  const Eigen::Vector3d velocity_flu = in.vector();
  const Eigen::Vector3d rates_flu = in.vector();
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
