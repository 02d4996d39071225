#include "swiftlet/ground/client/connection_watch.hpp"

namespace swiftlet::ground {
namespace {

std::string mode_of(const msg::ControlStatus& status) {
  return std::string(mode_name(status.mode())) + " (" + status.reason().c_str() + ")";
}

}  // namespace

bool is_connected(const View& view, Clock::time_point now) {
  return view.control.seen() && now - view.control.received < kConnectionSilence;
}

std::optional<ConnectionEvent> ConnectionWatch::update(const View& view, Clock::time_point now) {
  using Kind = ConnectionEvent::Kind;
  const bool was_connected = connected_;
  connected_ = is_connected(view, now);
  if (!connected_) {
    if (!was_connected) return std::nullopt;
    return ConnectionEvent{Kind::kLost, controller_, "control process lost: no control_status for 1 s"};
  }
  const msg::ControlStatus& status = view.control.message;
  const std::uint64_t before = controller_;
  controller_ = status.controller();
  if (before != 0 && before != controller_)
    return ConnectionEvent{Kind::kReplaced, controller_,
                           "another control process controls the vehicle: " + mode_of(status)};
  if (was_connected) return std::nullopt;
  const char* const words = before == 0 ? "control process connected: " : "control process connected again: ";
  return ConnectionEvent{Kind::kConnected, controller_, words + mode_of(status)};
}

}  // namespace swiftlet::ground
