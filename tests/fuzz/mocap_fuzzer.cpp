// Fuzzes what a motion capture sends. The first byte selects the protocol, the second the layout.
#include <cmath>
#include <iterator>
#include <vector>

#include "swiftlet/io/mocap/natnet.hpp"
#include "swiftlet/io/mocap/vicon.hpp"
#include "swiftlet/io/mocap/vrpn.hpp"
#include "swiftlet/services/mocap/sources/natnet_session.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;
using namespace swiftlet::mocap;

namespace {

constexpr natnet::Version kVersions[] = {{3, 0}, {3, 1}, {4, 0}, {4, 1}, {4, 2}};

bool is_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& attitude) {
  return position.allFinite() && std::abs(attitude.norm() - 1.0) < 1.1e-3;
}

void fuzz_natnet(const std::uint8_t* data, std::size_t size, natnet::Version version) {
  const auto message = natnet::parse_message(data, size);
  if (!message) return;
  natnet::Frame frame;
  if (natnet::parse_frame(message->payload, version, frame) == nullptr) {
    for (const natnet::RigidBody& body : frame.bodies)
      tests::demand(!body.tracked || is_pose(body.position, body.q_room_from_body),
                    "a tracked body has a pose");
  }
  std::vector<natnet::BodyDefinition> bodies;
  natnet::parse_models(message->payload, version, bodies);
  tests::demand(bodies.size() <= natnet::kMostBodies + 1, "the bodies are bounded");
}

// Datagrams, each behind its length, one after the other in a session.
void fuzz_session(const std::uint8_t* data, std::size_t size) {
  NatNetSession session;
  std::int64_t now_ns = 1'000'000'000;
  io::ByteReader in(data, size, true);
  while (in.rest() > 0) {
    const std::size_t bytes = in.u16();
    const io::ByteReader datagram = in.part(bytes < in.rest() ? bytes : in.rest());
    if (session.take(datagram.data(), datagram.rest(), now_ns += 1'000'000) == NatNetSession::Event::kFrame)
      session.exposed_ns(now_ns, true);
  }
}

void fuzz_vrpn(const std::uint8_t* data, std::size_t size) {
  vrpn::Message message;
  while (vrpn::parse_message(data, size, message) == vrpn::Parsed::kMessage) {
    tests::demand(message.bytes <= size && message.payload.rest() + vrpn::kHeaderBytes <= message.bytes,
                  "a message lies within what was received");
    vrpn::Pose pose;
    if (vrpn::parse_pose(message.payload, pose) == nullptr)
      tests::demand(is_pose(pose.position, pose.q_room_from_body), "a pose that was read is one");
    vrpn::parse_description(message.payload);
    data += message.bytes;
    size -= message.bytes;
  }
}

void fuzz_vicon(const std::uint8_t* data, std::size_t size) {
  vicon::Frame frame;
  if (vicon::parse_frame(data, size, frame) != nullptr) return;
  for (const vicon::Object& object : frame.objects)
    tests::demand(!object.tracked || is_pose(object.position, object.q_room_from_body),
                  "a tracked object has a pose");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const unsigned protocol = data[0] % 4U;
  const natnet::Version version = kVersions[data[1] % std::size(kVersions)];
  data += 2;
  size -= 2;
  if (protocol == 0) fuzz_natnet(data, size, version);
  if (protocol == 1) fuzz_session(data, size);
  if (protocol == 2) fuzz_vrpn(data, size);
  if (protocol == 3) fuzz_vicon(data, size);
  return 0;
}
