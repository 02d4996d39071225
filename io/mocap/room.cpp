#include "swiftlet/io/mocap/room.hpp"

#include <cmath>
#include <limits>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::mocap {
namespace {

using io::ConfigNode;

constexpr double kFurthestOriginM = 1000.0;

VehicleBody read_vehicle(const std::string& name, const ConfigNode& node) {
  node.allow({"body", "id", "lever_arm_frd_m", "misalignment_rad"});
  VehicleBody vehicle;
  vehicle.vehicle = name;
  if (const auto body = node.find("body")) vehicle.body = body->text();
  if (const auto id = node.find("id"))
    vehicle.id = static_cast<std::int32_t>(id->integer(0, std::numeric_limits<std::int32_t>::max()));
  if (!vehicle.body && !vehicle.id) node.fail("has neither body nor id, must have one");
  if (const auto arm = node.find("lever_arm_frd_m"))
    vehicle.lever_arm_frd = arm->vector3(io::between(-kLongestLeverArmM, kLongestLeverArmM));
  if (const auto turn = node.find("misalignment_rad")) {
    vehicle.misalignment = turn->vector3(io::between(-M_PI, M_PI));
    if (vehicle.misalignment.norm() > M_PI)
      turn->fail("is longer than pi, must be a rotation vector of at most pi");
  }
  return vehicle;
}

// Two vehicles that fly by the pose of one body would collide.
void require_own_body(const std::vector<VehicleBody>& others, const VehicleBody& vehicle,
                      const ConfigNode& node) {
  for (const VehicleBody& other : others) {
    if (other.body == vehicle.body && other.id == vehicle.id)
      node.fail("is " + vehicle.body_text() + ", which is the vehicle " + other.vehicle + " already");
  }
}

void read_source(const ConfigNode& root, Room& room) {
  room.source = root.at("source").choice<SourceKind>({{"natnet", SourceKind::kNatNet},
                                                      {"vrpn", SourceKind::kVrpn},
                                                      {"vicon", SourceKind::kVicon},
                                                      {"replay", SourceKind::kReplay}});
  if (const auto server = root.find("server")) room.server = server->text();
  if (const auto interface = root.find("interface")) room.interface = interface->text();
  if (const auto file = root.find("file")) room.file = file->text();
  if (room.source == SourceKind::kVrpn && room.server.empty())
    root.at("source").fail("is vrpn, which needs the key server");
  if (room.source == SourceKind::kReplay && room.file.empty())
    root.at("source").fail("is replay, which needs the key file");
  if (room.source != SourceKind::kReplay && !room.file.empty())
    root.at("file").fail("is only for the source replay");
}

Room read_room(const ConfigNode& root) {
  root.allow({"description", "source", "server", "interface", "file", "frame", "origin_m", "north_rad",
              "latency_s", "vehicles"});
  Room room;
  if (const auto description = root.find("description")) description->text();
  read_source(root, room);
  room.axes = root.at("frame").choice<Axes>({{"zup", Axes::kZUp}, {"yup", Axes::kYUp}});
  if (const auto origin = root.find("origin_m"))
    room.origin = origin->vector3(io::between(-kFurthestOriginM, kFurthestOriginM));
  if (const auto north = root.find("north_rad")) room.north_rad = north->number(io::between(-M_PI, M_PI));
  if (const auto latency = root.find("latency_s"))
    room.latency_s = latency->number(io::between(0.0, kLongestLatencyS));
  const ConfigNode vehicles = root.at("vehicles");
  for (const auto& [name, node] : vehicles.entries()) {
    const VehicleBody vehicle = read_vehicle(name, node);
    require_own_body(room.vehicles, vehicle, node);
    room.vehicles.push_back(vehicle);
  }
  if (room.vehicles.empty()) vehicles.fail("is empty, must name at least one vehicle");
  return room;
}

// Forward, right and down in the axes of the motion capture are the rows.
Eigen::Matrix3d frd_from(Axes axes) {
  Eigen::Matrix3d rotation;
  if (axes == Axes::kZUp) {
    rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  } else {
    rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  }
  return rotation;
}

}  // namespace

const char* to_string(SourceKind kind) {
  switch (kind) {
    case SourceKind::kNatNet:
      return "natnet";
    case SourceKind::kVrpn:
      return "vrpn";
    case SourceKind::kVicon:
      return "vicon";
    case SourceKind::kReplay:
      break;
  }
  return "replay";
}

std::string VehicleBody::body_text() const {
  std::string text = "body";
  if (body) text += " '" + *body + "'";
  if (id) text += (body ? " with number " : " ") + std::to_string(*id);
  return text;
}

Room parse_room(std::string_view text, const std::string& file_name) {
  return read_room(io::parse_config(text, file_name));
}

Room load_room(const std::string& path) { return parse_room(io::read_text_file(path), path); }

const VehicleBody* find(const Room& room, const std::string& vehicle) {
  for (const VehicleBody& body : room.vehicles) {
    if (body.vehicle == vehicle) return &body;
  }
  return nullptr;
}

RoomFrame::RoomFrame(const Room& room)
    : q_frd_from_room_(frd_from(room.axes)),
      q_ned_from_frd_(Eigen::AngleAxisd(-room.north_rad, Eigen::Vector3d::UnitZ())),
      origin_(room.origin) {}

NedPose RoomFrame::body_pose(const Eigen::Vector3d& position,
                             const Eigen::Quaterniond& q_room_from_body) const {
  const Eigen::Quaterniond q_ned_from_room = q_ned_from_frd_ * q_frd_from_room_;
  NedPose pose;
  pose.position_ned = q_ned_from_room * (position - origin_);
  pose.q_ned_from_frd = (q_ned_from_room * q_room_from_body * q_frd_from_room_.conjugate()).normalized();
  return pose;
}

NedPose RoomFrame::vehicle_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& q_room_from_body,
                                const VehicleBody& vehicle) const {
  NedPose pose = body_pose(position, q_room_from_body);
  pose.q_ned_from_frd = (pose.q_ned_from_frd * math::rotation(vehicle.misalignment)).normalized();
  pose.position_ned += pose.q_ned_from_frd * vehicle.lever_arm_frd;
  return pose;
}

}  // namespace swiftlet::mocap
