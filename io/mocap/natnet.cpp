#include "swiftlet/io/mocap/natnet.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/byte_writer.hpp"

namespace swiftlet::mocap::natnet {
namespace {

using io::ByteReader;

constexpr std::size_t kApplicationNameBytes = 256;  // of the application, in messages of fixed size
constexpr std::size_t kPositionBytes = 12;          // three floats
constexpr std::size_t kBodyBytes = 38;              // of a rigid body in a frame: number, pose, error, flags
constexpr std::size_t kMarkerBytes = 26;     // of a labelled marker: number, position, size, flags, residual
constexpr std::size_t kMostModels = 10'000;  // definitions of all kinds
constexpr std::size_t kMostPadding = 4;      // bytes behind the last definition

enum class ModelKind {
  kMarkerSet = 0,
  kRigidBody = 1,
  kSkeleton = 2,
  kForcePlate = 3,
  kDevice = 4,
  kCamera = 5
};

// Flags.
constexpr unsigned kTracked = 1;        // of a rigid body
constexpr unsigned kOccluded = 1;       // of a marker
constexpr unsigned kModelsChanged = 2;  // of a frame

Version read_version(ByteReader& in) {
  Version version;
  version.major = in.u8();
  version.minor = in.u8();
  in.skip(2);  // build, revision
  return version;
}

Eigen::Vector3d read_position(ByteReader& in) {
  const double x = in.f32();
  const double y = in.f32();
  const double z = in.f32();
  return {x, y, z};
}

Eigen::Quaterniond read_quaternion(ByteReader& in) {
  const double x = in.f32();
  const double y = in.f32();
  const double z = in.f32();
  const double w = in.f32();
  return {w, x, y, z};
}

// Reads a count of things of at least this size. More than fit into the rest are refused, so that a count never makes us
// allocate or loop more than the datagram is long.
std::size_t read_count(ByteReader& in, std::size_t least_bytes) {
  const std::int32_t count = in.i32();
  if (count < 0 || static_cast<std::size_t>(count) > in.rest() / std::max<std::size_t>(least_bytes, 1)) {
    in.skip(in.rest() + 1);
    return 0;
  }
  return static_cast<std::size_t>(count);
}

// The head of a section of a frame: its count and, since 4.1, its size.
struct Section {
  std::size_t count = 0;
  ByteReader content;
};

Section read_section(ByteReader& in, Version version, std::size_t least_bytes) {
  if (!version.has_sizes()) return {read_count(in, least_bytes), in};
  const std::int32_t count = in.i32();
  const std::int32_t size = in.i32();
  Section section{0, in.part(size < 0 ? in.rest() + 1 : static_cast<std::size_t>(size))};
  if (count < 0 || static_cast<std::size_t>(count) > section.content.rest() / least_bytes) {
    in.skip(in.rest() + 1);
    return section;
  }
  section.count = static_cast<std::size_t>(count);
  return section;
}

// Without sizes in front, the next section begins where this one was read to.
void leave_section(ByteReader& in, Version version, const Section& section) {
  if (!version.has_sizes()) in = section.content;
}

// Reads past a section of which nothing is needed.
template <class SkipOne>
void skip_section(ByteReader& in, Version version, std::size_t least_bytes, const SkipOne& skip_one) {
  Section section = read_section(in, version, least_bytes);
  if (version.has_sizes()) return;
  for (std::size_t i = 0; i < section.count && section.content.ok(); ++i) skip_one(section.content);
  leave_section(in, version, section);
}

void skip_marker_set(ByteReader& in) {
  in.text();
  in.skip(kPositionBytes * read_count(in, kPositionBytes));
}

void skip_skeleton(ByteReader& in) {
  in.skip(4);  // number
  in.skip(kBodyBytes * read_count(in, kBodyBytes));
}

// Skips the data of a force plate or a device.
void skip_analog_data(ByteReader& in) {
  in.skip(4);  // number
  const std::size_t channels = read_count(in, 4);
  for (std::size_t i = 0; i < channels && in.ok(); ++i) in.skip(4 * read_count(in, 4));
}

bool is_plausible(const RigidBody& body) {
  return body.position.allFinite() && body.q_room_from_body.coeffs().allFinite() &&
         std::abs(body.q_room_from_body.norm() - 1.0) < 1e-3;
}

RigidBody read_rigid_body(ByteReader& in) {
  RigidBody body;
  body.id = in.i32();
  body.position = read_position(in);
  body.q_room_from_body = read_quaternion(in);
  body.mean_error_m = in.f32();
  body.tracked = (in.u16() & kTracked) != 0;
  // A lost body of some servers is all zeros or not a number.
  if (!is_plausible(body)) body.tracked = false;
  return body;
}

const char* read_rigid_bodies(ByteReader& in, Version version, std::vector<RigidBody>& bodies) {
  Section section = read_section(in, version, kBodyBytes);
  if (section.count > kMostBodies) return "more than 1000 rigid bodies";
  bodies.clear();
  for (std::size_t i = 0; i < section.count; ++i) bodies.push_back(read_rigid_body(section.content));
  if (!section.content.ok()) return "the rigid bodies end too early";
  leave_section(in, version, section);
  return nullptr;
}

// Counts the markers of each body.
void read_labelled_markers(ByteReader& in, Version version, std::vector<RigidBody>& bodies) {
  Section section = read_section(in, version, kMarkerBytes);
  for (std::size_t i = 0; i < section.count && section.content.ok(); ++i) {
    section.content.skip(2);  // number of the marker
    const std::uint16_t owner = section.content.u16();
    section.content.skip(kPositionBytes + 4);  // position, size
    const bool occluded = (section.content.u16() & kOccluded) != 0;
    section.content.skip(4);  // residual
    if (owner == 0) continue;
    const auto body =
        std::find_if(bodies.begin(), bodies.end(), [&](const RigidBody& one) { return one.id == owner; });
    if (body == bodies.end()) continue;
    ++body->markers;
    if (occluded) ++body->lost_markers;
  }
  leave_section(in, version, section);
}

void read_suffix(ByteReader& in, Version version, Frame& frame) {
  in.skip(8);  // timecode
  frame.timestamp_s = in.f64();
  frame.exposed_ticks = in.u64();
  frame.received_ticks = in.u64();
  frame.sent_ticks = in.u64();
  if (version.has_sizes()) in.skip(8);  // precision timestamp
  frame.models_changed = (in.u16() & kModelsChanged) != 0;
}

void skip_marker_set_definition(ByteReader& in) {
  in.text();
  const std::size_t markers = read_count(in, 1);
  for (std::size_t i = 0; i < markers && in.ok(); ++i) in.text();
}

// Past the markers of a rigid body: positions, active labels and, since 4.0, names.
void skip_marker_definitions(ByteReader& in, Version version) {
  const std::size_t markers = read_count(in, kPositionBytes + 4);
  in.skip(markers * (kPositionBytes + 4));
  if (version.major >= 4) {
    for (std::size_t i = 0; i < markers && in.ok(); ++i) in.text();
  }
}

// Servers differ in whether they send the markers of the bones.
enum class Bones { kBare, kWithMarkers };

void skip_skeleton_definition(ByteReader& in, Version version, Bones layout) {
  in.text();
  in.skip(4);  // number
  const std::size_t bones = read_count(in, 1);
  for (std::size_t i = 0; i < bones && in.ok(); ++i) {
    in.text();
    in.skip(8 + kPositionBytes);  // number, parent, offset
    if (layout == Bones::kWithMarkers) skip_marker_definitions(in, version);
  }
}

void skip_channel_names(ByteReader& in) {
  const std::size_t channels = read_count(in, 1);
  for (std::size_t i = 0; i < channels && in.ok(); ++i) in.text();
}

void skip_force_plate_definition(ByteReader& in) {
  in.skip(4);  // number
  in.text();   // serial number
  in.skip(8 + kPositionBytes + 4 * 144 + 4 * kPositionBytes +
          8);  // size, origin, calibration, corners, types
  skip_channel_names(in);
}

void skip_device_definition(ByteReader& in) {
  in.skip(4);  // number
  in.text();   // name
  in.text();   // serial number
  in.skip(8);  // types
  skip_channel_names(in);
}

void skip_camera_definition(ByteReader& in) {
  in.text();
  in.skip(kPositionBytes + 16);  // pose
}

// The rest of the definition is skipped by its size in the layouts that have one.
BodyDefinition read_body_definition(ByteReader& in, Version version) {
  BodyDefinition body;
  body.name = std::string(in.text());
  body.id = in.i32();
  body.parent = in.i32();
  in.skip(kPositionBytes);
  if (!version.has_sizes()) skip_marker_definitions(in, version);
  return body;
}

const char* read_model(ByteReader& in, Version version, Bones bones, std::vector<BodyDefinition>& bodies) {
  const auto kind = static_cast<ModelKind>(in.i32());
  ByteReader content = in;
  if (version.has_sizes()) {
    const std::int32_t size = in.i32();
    content = in.part(size < 0 ? in.rest() + 1 : static_cast<std::size_t>(size));
  }
  switch (kind) {
    case ModelKind::kRigidBody:
      bodies.push_back(read_body_definition(content, version));
      break;
    case ModelKind::kMarkerSet:
      skip_marker_set_definition(content);
      break;
    case ModelKind::kSkeleton:
      if (!version.has_sizes()) skip_skeleton_definition(content, version, bones);
      break;
    case ModelKind::kForcePlate:
      if (!version.has_sizes()) skip_force_plate_definition(content);
      break;
    case ModelKind::kDevice:
      if (!version.has_sizes()) skip_device_definition(content);
      break;
    case ModelKind::kCamera:
      if (!version.has_sizes()) skip_camera_definition(content);
      break;
    default:
      if (!version.has_sizes()) return "a definition is of an unknown kind";
  }
  if (!content.ok()) return "a definition ends too early";
  if (!version.has_sizes()) in = content;
  return nullptr;
}

const char* read_models(ByteReader in, Version version, Bones bones, std::vector<BodyDefinition>& bodies) {
  bodies.clear();
  const std::size_t count = read_count(in, 4);
  if (!in.ok() || count > kMostModels) return "the number of definitions is impossible";
  for (std::size_t i = 0; i < count; ++i) {
    if (const char* const fault = read_model(in, version, bones, bodies)) return fault;
    if (bodies.size() > kMostBodies) return "more than 1000 rigid bodies";
  }
  return in.rest() > kMostPadding ? "something follows the last definition" : nullptr;
}

Datagram message(MessageId id, const Datagram& payload) {
  Datagram out;
  io::append(out, id);
  io::append(out, static_cast<std::uint16_t>(payload.size()));
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

// A connect or discovery request: name and versions of the client, whether it wants only what it subscribes, and the layouts
// that it wants. Servers before 4.0 ignore the last five bytes.
Datagram introduction(MessageId id, Version wanted) {
  const std::string name = "swiftlet";
  Datagram payload(name.begin(), name.end());
  payload.resize(kApplicationNameBytes);
  const auto put_version = [&](Version version) {
    payload.push_back(static_cast<std::uint8_t>(version.major));
    payload.push_back(static_cast<std::uint8_t>(version.minor));
    io::append(payload, std::uint16_t{0});
  };
  put_version({1, 0});
  put_version(wanted);
  payload.push_back(0);
  put_version(wanted);
  return message(id, payload);
}

}  // namespace

std::string Version::to_string() const { return std::to_string(major) + "." + std::to_string(minor); }

std::optional<Message> parse_message(const std::uint8_t* data, std::size_t size) {
  ByteReader in(data, size, true);
  const auto id = static_cast<MessageId>(in.u16());
  const std::size_t bytes = in.u16();
  if (!in.ok() || bytes > in.rest()) return std::nullopt;
  return Message{id, in.part(bytes)};
}

const char* parse_server_info(ByteReader payload, ServerInfo& info) {
  info.application = std::string(payload.text_field(kApplicationNameBytes));
  info.application_version = read_version(payload);
  info.version = read_version(payload);
  if (!payload.ok()) return "the server's description ends too early";
  if (!info.version.is_supported()) return nullptr;  // the rest is of another layout
  info.clock_hz = payload.u64();
  info.data_port = payload.u16();
  info.multicast = payload.u8() != 0;
  for (std::uint8_t& byte : info.group) byte = payload.u8();
  if (!payload.ok()) return "the server's description ends too early";
  if (info.clock_hz == 0 || info.clock_hz > 1'000'000'000'000)
    return "the frequency of the server's clock is not within 1 Hz and 1 THz";
  return nullptr;
}

const char* parse_models(ByteReader payload, Version version, std::vector<BodyDefinition>& bodies) {
  const char* const fault = read_models(payload, version, Bones::kBare, bodies);
  return fault == nullptr ? nullptr : read_models(payload, version, Bones::kWithMarkers, bodies);
}

const char* parse_frame(ByteReader payload, Version version, Frame& frame) {
  frame.number = payload.i32();
  skip_section(payload, version, 5, skip_marker_set);
  skip_section(payload, version, kPositionBytes, [](ByteReader& in) { in.skip(kPositionBytes); });
  if (!payload.ok()) return "the marker sets end too early";
  if (const char* const fault = read_rigid_bodies(payload, version, frame.bodies)) return fault;
  skip_section(payload, version, 8, skip_skeleton);
  if (version.has_sizes()) skip_section(payload, version, 8, [](ByteReader&) {});  // assets
  read_labelled_markers(payload, version, frame.bodies);
  skip_section(payload, version, 8, skip_analog_data);  // force plates
  skip_section(payload, version, 8, skip_analog_data);  // devices
  read_suffix(payload, version, frame);
  if (!payload.ok()) return "the frame ends too early";
  return nullptr;
}

const char* parse_echo_response(ByteReader payload, EchoResponse& response) {
  response.request = payload.u64();
  response.received_ticks = payload.u64();
  return payload.ok() ? nullptr : "the answer to an echo request ends too early";
}

Datagram connect_request(Version wanted) { return introduction(MessageId::kConnect, wanted); }
Datagram discovery_request(Version wanted) { return introduction(MessageId::kDiscovery, wanted); }
Datagram models_request() { return message(MessageId::kRequestModels, {}); }
Datagram keep_alive() { return message(MessageId::kKeepAlive, {}); }

Datagram echo_request(std::uint64_t stamp) {
  Datagram payload;
  io::append(payload, stamp);
  return message(MessageId::kEchoRequest, payload);
}

}  // namespace swiftlet::mocap::natnet
