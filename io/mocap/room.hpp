// A room with motion capture: where the poses come from, their axes, and which body is which vehicle.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::mocap {

enum class SourceKind { kNatNet, kVrpn, kVicon, kReplay };
const char* to_string(SourceKind kind);  // as in the file

// Axes of the motion capture.
enum class Axes {
  kZUp,  // x forward, y left, z up
  kYUp,  // x forward, y up, z right
};

// A vehicle and its body in the motion capture.
struct VehicleBody {
  std::string vehicle;
  std::optional<std::string> body;  // name of the body
  std::optional<std::int32_t>
      id;  // number of the body, of the sensor with VRPN; name, number or both are given
  // From the body's origin, which the motion capture reports, to the vehicle's centre of mass.
  Eigen::Vector3d lever_arm_frd = Eigen::Vector3d::Zero();  // m
  // Rotation vector that turns the axes of the body into those of the vehicle, rad. Both are forward, right, down.
  Eigen::Vector3d misalignment = Eigen::Vector3d::Zero();

  std::string body_text() const;  // "body 'kl1'", "body 7"
};

struct Room {
  SourceKind source = SourceKind::kNatNet;
  std::string server;     // HOST or HOST:PORT; empty: looked for, or received from anyone
  std::string interface;  // of this host, by name or address; empty: the system's choice
  std::string file;       // of a replay
  Axes axes = Axes::kZUp;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // of the NED frame, in the axes of the motion capture, m
  double north_rad =
      0.0;  // direction of north, from the forward axis of the motion capture; clockwise seen from above
  double latency_s =
      0.0;  // from the exposure to the stamp of the server, or to the arrival if it sends no stamp
  std::vector<VehicleBody> vehicles;
};

constexpr double kLongestLeverArmM = 1.0;
constexpr double kLongestLatencyS = 0.5;

// Throws ConfigError with file, line, key, value and limit. file_name appears in messages only.
Room parse_room(std::string_view text, const std::string& file_name);
Room load_room(const std::string& path);

// The entry of a vehicle; nullptr if there is none.
const VehicleBody* find(const Room& room, const std::string& vehicle);

// A pose in NED.
struct NedPose {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

// The one place where axes are converted.
class RoomFrame {
 public:
  explicit RoomFrame(const Room& room);

  // Pose of the body: position in m and attitude as the motion capture reports them, whose body has the axes of the room
  // if it does not turn.
  NedPose body_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& q_room_from_body) const;
  // Pose of the vehicle whose body this is.
  NedPose vehicle_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& q_room_from_body,
                       const VehicleBody& vehicle) const;

 private:
  Eigen::Quaterniond q_frd_from_room_;  // from the axes of the room to forward, right, down
  Eigen::Quaterniond q_ned_from_frd_;   // by the direction of north
  Eigen::Vector3d origin_;
};

}  // namespace swiftlet::mocap
