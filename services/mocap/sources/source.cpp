#include "swiftlet/services/mocap/sources/source.hpp"

#include <algorithm>
#include <utility>

#include "swiftlet/services/mocap/sources/natnet_source.hpp"
#include "swiftlet/services/mocap/sources/replay_source.hpp"
#include "swiftlet/services/mocap/sources/vicon_source.hpp"
#include "swiftlet/services/mocap/sources/vrpn_source.hpp"

namespace swiftlet::mocap {
namespace {

constexpr std::size_t kMostBodies = 1000;

bool are_same_body(const Body& a, const Body& b) { return a.name == b.name && a.id == b.id; }

}  // namespace

void Source::set_bodies(std::vector<Body> bodies) {
  if (std::equal(bodies.begin(), bodies.end(), bodies_.begin(), bodies_.end(), are_same_body)) return;
  bodies_ = std::move(bodies);
  ++revision_;
}

std::optional<std::size_t> Source::body_of(const std::string& name, std::int32_t id) {
  const auto known = std::find_if(bodies_.begin(), bodies_.end(),
                                  [&](const Body& body) { return body.id == id && body.name == name; });
  if (known != bodies_.end()) return static_cast<std::size_t>(known - bodies_.begin());
  if (bodies_.size() == kMostBodies) return std::nullopt;
  bodies_.push_back({name, id});
  ++revision_;
  return bodies_.size() - 1;
}

void Source::refuse(const std::string& why) {
  ++statistics_.refused;
  statistics_.last_refusal = why;
}

std::optional<std::size_t> find_body(const std::vector<Body>& bodies, const VehicleBody& vehicle) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if ((!vehicle.body || *vehicle.body == bodies[i].name) && (!vehicle.id || *vehicle.id == bodies[i].id))
      return i;
  }
  return std::nullopt;
}

std::string to_string(const std::vector<Body>& bodies) {
  std::string text;
  for (const Body& body : bodies)
    text += (text.empty() ? "" : ", ") + body.name + " (" + std::to_string(body.id) + ")";
  return text.empty() ? "none" : text;
}

std::unique_ptr<Source> open_source(const Room& room) {
  switch (room.source) {
    case SourceKind::kNatNet:
      return std::make_unique<NatNetSource>(room);
    case SourceKind::kVrpn:
      return std::make_unique<VrpnSource>(room);
    case SourceKind::kVicon:
      return std::make_unique<ViconSource>(room);
    case SourceKind::kReplay:
      break;
  }
  return std::make_unique<ReplaySource>(room);
}

}  // namespace swiftlet::mocap
