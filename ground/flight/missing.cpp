#include "swiftlet/ground/flight/missing.hpp"

namespace swiftlet::ground {

std::string missing(const View& view, bool has_truth) {
  std::string list;
  const auto need = [&list](bool there, const char* what) {
    if (!there) list += (list.empty() ? "" : ", ") + std::string(what);
  };
  need(view.vehicle.seen(), "vehicle_info");
  need(view.battery.seen(), "battery");
  need(view.truth.seen() || !has_truth, "ground_truth");
  need(view.estimate.seen(), "estimate");
  need(view.control.seen(), "control_status");
  need(view.reference.seen(), "reference");
  need(view.control.message.has_pose(), "a mocap_pose accepted by control");
  return list;
}

std::string missing_peer(const View& view) {
  for (const char* name : {"plant", "mocap", "control"}) {
    const auto peer = view.peers.find(name);
    if (peer == view.peers.end() || !peer->second) return name;
  }
  return {};
}

}  // namespace swiftlet::ground
