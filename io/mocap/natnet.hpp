// NatNet, the protocol of OptiTrack's Motive: UDP, little-endian. Layouts of versions 3.0, 3.1, 4.0, 4.1 and later 4.x.
//
// A message is a header (number and size of the payload) and a payload. The client sends commands to port 1510 of the server and
// receives the answers; frames come by multicast, or by unicast to the address that sent the connect request.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::mocap::natnet {

constexpr std::uint16_t kCommandPort = 1510;
constexpr std::uint16_t kDataPort = 1511;
constexpr std::array<std::uint8_t, 4> kMulticastGroup{239, 255, 42, 99};

enum class MessageId : std::uint16_t {
  kConnect = 0,
  kServerInfo = 1,
  kRequest = 2,
  kResponse = 3,
  kRequestModels = 4,
  kModels = 5,
  kFrame = 7,
  kKeepAlive = 10,
  kEchoRequest = 12,
  kEchoResponse = 13,
  kDiscovery = 14,
  kUnrecognizedRequest = 100,
};

struct Version {
  int major = 0;
  int minor = 0;

  // The layouts of versions 3 and 4 are supported: any 4.x after 4.1 only adds to what has a size in front.
  bool is_supported() const { return major == 3 || major == 4; }
  bool has_sizes() const { return major > 4 || (major == 4 && minor >= 1); }
  std::string to_string() const;
};

inline bool operator==(const Version& a, const Version& b) {
  return a.major == b.major && a.minor == b.minor;
}
inline bool operator!=(const Version& a, const Version& b) { return !(a == b); }

struct ServerInfo {
  std::string application;  // "Motive"
  Version application_version;
  Version version;             // of NatNet
  std::uint64_t clock_hz = 0;  // ticks per second of the stamps
  std::uint16_t data_port = kDataPort;
  bool multicast = true;
  std::array<std::uint8_t, 4> group = kMulticastGroup;
};

struct BodyDefinition {
  std::string name;
  std::int32_t id = 0;
  std::int32_t parent = -1;
};

// Pose of a rigid body in the axes of the server, which are its own setting: y up or z up.
struct RigidBody {
  std::int32_t id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_room_from_body = Eigen::Quaterniond::Identity();
  double mean_error_m = 0.0;  // of its markers
  bool tracked = false;
  int markers = 0;       // labelled markers of the body in this frame
  int lost_markers = 0;  // of these, those which no camera sees: the server fills in where they should be
};

struct Frame {
  std::int32_t number = 0;
  double timestamp_s = 0.0;  // since the start of the server's software
  // Ticks of the server's clock; 0: unknown.
  std::uint64_t exposed_ticks = 0;   // middle of the exposure
  std::uint64_t received_ticks = 0;  // the cameras' data arrived at the server
  std::uint64_t sent_ticks = 0;      // the frame left the server
  bool models_changed = false;       // since the last frame: ask for the definitions
  std::vector<RigidBody> bodies;
};

struct EchoResponse {
  std::uint64_t request = 0;         // as in the request
  std::uint64_t received_ticks = 0;  // the request arrived at the server
};

struct Message {
  MessageId id{};
  io::ByteReader payload;
};

// Most bodies of a frame, and definitions of a server.
constexpr std::size_t kMostBodies = 1000;

// Splits a datagram. nullopt: it is none of NatNet: shorter than the header, or than the header says.
std::optional<Message> parse_message(const std::uint8_t* data, std::size_t size);

// These return why a payload was refused, a string literal; nullptr if it was read. After a refusal the content of the output
// is undefined. They never read beyond the payload, and `frame` keeps its memory.
const char* parse_server_info(io::ByteReader payload, ServerInfo& info);
const char* parse_models(io::ByteReader payload, Version version, std::vector<BodyDefinition>& bodies);
const char* parse_frame(io::ByteReader payload, Version version, Frame& frame);
const char* parse_echo_response(io::ByteReader payload, EchoResponse& response);

using Datagram = std::vector<std::uint8_t>;

// Requests of a client. wanted: the layouts that a 4.x server is asked for.
Datagram connect_request(Version wanted);
Datagram discovery_request(Version wanted);
Datagram models_request();
Datagram keep_alive();
Datagram echo_request(std::uint64_t stamp);

}  // namespace swiftlet::mocap::natnet
