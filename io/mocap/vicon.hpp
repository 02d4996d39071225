// The UDP object stream of Vicon Tracker: datagrams of 256, 512 or 1024 bytes to port 51001, little-endian. Each holds the
// objects of a frame that are tracked; which ones, and where it goes, is set in Tracker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::mocap::vicon {

constexpr std::uint16_t kPort = 51001;
constexpr std::size_t kObjectBytes = 75;  // with its header

struct Object {
  std::string name;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m; mm on the wire
  Eigen::Quaterniond q_room_from_body = Eigen::Quaterniond::Identity();
  bool tracked = false;  // false: all numbers are 0, or one is not finite
};

struct Frame {
  std::uint32_t number = 0;
  std::vector<Object> objects;
};

// Returns why the datagram was refused, a string literal; nullptr if it was read. Never reads beyond it.
const char* parse_frame(const std::uint8_t* data, std::size_t size, Frame& frame);

// On the wire the attitude is three angles in rad: about x, then about the turned y, then about the twice turned z.
Eigen::Quaterniond attitude_of(double about_x, double about_y, double about_z);

}  // namespace swiftlet::mocap::vicon
