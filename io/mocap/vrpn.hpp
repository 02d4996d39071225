// VRPN, which Vicon Tracker, Motive, Qualisys and others serve. Big-endian; layouts of version 7, which did
// not change since 1999.
//
// Client and server each send a cookie over TCP, then messages. A message has a time, a sender and a type, both numbers that
// its side has described before by name; descriptions have types below 0. Once the client has described a UDP port, poses
// come there, otherwise over TCP.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::mocap::vrpn {

constexpr std::uint16_t kPort = 3883;
constexpr std::size_t kCookieBytes = 24;
constexpr std::size_t kHeaderBytes = 24;
// Longest message; VRPN's own buffers hold no longer one.
constexpr std::size_t kLongestMessage = 65'536;

constexpr const char* kPoseType = "vrpn_Tracker Pos_Quat";
constexpr const char* kPingType = "vrpn_Base ping_message";
constexpr const char* kPongType = "vrpn_Base pong_message";

// Types of messages that describe.
constexpr std::int32_t kSenderDescription = -1;
constexpr std::int32_t kTypeDescription = -2;
constexpr std::int32_t kUdpDescription = -3;

struct Message {
  std::int64_t stamp_ns = 0;  // clock of the side that sent it, since 1970
  std::int32_t sender = 0;
  std::int32_t type = 0;
  std::uint32_t sequence = 0;  // counts the messages of a UDP stream; some servers leave it 0
  io::ByteReader payload{nullptr, 0, false};
  std::size_t bytes = 0;  // of the message with header and padding
};

struct Pose {
  std::int32_t sensor = 0;                             // a tracker may have several
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_room_from_body = Eigen::Quaterniond::Identity();
};

// Why this is not the cookie of a server of version 7, a string literal; nullptr if it is. It is kCookieBytes long.
const char* fault_of_cookie(const std::uint8_t* cookie);

enum class Parsed { kMessage, kIncomplete, kFault };
// Reads the first message of a stream or datagram. kFault: its length is impossible, the stream is lost.
Parsed parse_message(const std::uint8_t* data, std::size_t size, Message& message);

// The name in a description of a sender or type; nullopt if the payload is none.
std::optional<std::string> parse_description(io::ByteReader payload);
// Returns why the payload was refused, a string literal; nullptr if it was read.
const char* parse_pose(io::ByteReader payload, Pose& pose);

using Bytes = std::vector<std::uint8_t>;

Bytes cookie();
Bytes message(std::int64_t stamp_ns, std::int32_t sender, std::int32_t type, const Bytes& payload);
// kind: kSenderDescription or kTypeDescription. number: by which this side refers to it.
Bytes description(std::int32_t kind, std::int32_t number, std::string_view name);
Bytes udp_description(std::string_view address, std::uint16_t port);

}  // namespace swiftlet::mocap::vrpn
