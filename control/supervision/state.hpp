// All that the supervisor remembers from one step to the next, as plain data: another process that is given
// it, with the plan being flown, goes on exactly where this one stopped.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "swiftlet/control/guidance/guidance_state.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// A ground tool that the flight depends on.
struct GroundLink {
  std::uint64_t client = 0;  // 0: none
  std::int64_t heard_ns = 0;
};
constexpr int kMaxGroundLinks = 4;

// Times are stamps of the vehicle's clock, ns.
struct SupervisorState {
  Mode mode = Mode::kDisarmed;
  Reason reason = Reason::kStarted;
  bool land_on_return = false;  // in descent without position: a landing was under way
  std::int64_t now_ns = 0;      // of the last step
  std::int64_t mode_since_ns = 0;

  GuidanceState guidance;

  std::int64_t contact_since_ns = 0;           // 0: the ground is not felt
  std::int64_t low_battery_since_ns = 0;       // 0: the battery is well
  std::int64_t critical_battery_since_ns = 0;  // 0: it is not that low
  std::array<GroundLink, kMaxGroundLinks> ground_links{};
  RequestStatuses requests{};
};
static_assert(std::is_trivially_copyable_v<SupervisorState>);

}  // namespace swiftlet::control
