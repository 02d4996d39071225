// The state of the supervisor between steps, as plain data. Another process that receives it, with the plan
// being flown, continues exactly.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "swiftlet/control/guidance/guidance_state.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// A ground client whose link-loss failsafe is on.
struct GroundLink {
  std::uint64_t client = 0;  // 0: none
  std::int64_t heard_ns = 0;
};
constexpr int kMaxGroundLinks = 4;

// Times are stamps of the vehicle's clock, ns.
struct SupervisorState {
  Mode mode = Mode::kDisarmed;
  Reason reason = Reason::kStarted;
  bool land_on_return = false;  // a landing was under way when the pose was lost
  std::int64_t now_ns = 0;      // of the last step
  std::int64_t mode_since_ns = 0;

  GuidanceState guidance;

  std::int64_t contact_since_ns = 0;           // since when touchdown signs hold; 0: they do not
  std::int64_t low_battery_since_ns = 0;       // since when it is low; 0: it is not
  std::int64_t critical_battery_since_ns = 0;  // since when it is critical; 0: it is not
  std::array<GroundLink, kMaxGroundLinks> ground_links{};
  RequestStatuses requests{};
};

// The reason says so, of which a standby knows too: it flies a hover test on.
inline bool in_hover_test(const SupervisorState& state) {
  return !rotors_off(state.mode) &&
         (state.reason == Reason::kHoverTest || state.reason == Reason::kHoverTestPassed);
}
static_assert(std::is_trivially_copyable_v<SupervisorState>);

}  // namespace swiftlet::control
