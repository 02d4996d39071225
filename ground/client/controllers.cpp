#include "swiftlet/ground/client/controllers.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

#include "swiftlet/ground/client/connection_watch.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kStateSilence_s = 0.5;

auto rank(const LiveController& controller) {
  return std::tuple(controller.active, controller.state ? controller.state->failover_priority() : 0U,
                    controller.number);
}

}  // namespace

LiveControllers controllers_of(const View& view, Clock::time_point now) {
  LiveControllers live;
  for (const auto& [number, latest] : view.controllers) {
    if (latest.age_s(now) >= kStateSilence_s) continue;
    const bool active = latest.message.role() == msg::ControllerState_Constants::ACTIVE;
    live.known.push_back({number, active, std::make_shared<const msg::ControllerState>(latest.message)});
  }
  const std::uint64_t reporting = is_connected(view, now) ? view.control.message.controller() : 0;
  const bool listed = std::any_of(live.known.begin(), live.known.end(),
                                  [&](const LiveController& known) { return known.number == reporting; });
  if (reporting != 0 && !listed) live.known.push_back({reporting, true});
  std::sort(live.known.begin(), live.known.end(),
            [](const LiveController& a, const LiveController& b) { return rank(a) > rank(b); });
  const auto announced = view.peers.find("control");
  if (announced != view.peers.end())
    live.others = std::max(announced->second - static_cast<int>(live.known.size()), 0);
  return live;
}

}  // namespace swiftlet::ground
