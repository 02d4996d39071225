#include "swiftlet/ground/teleop/teleop.hpp"

#include <chrono>
#include <cmath>

#include "swiftlet/math/euler.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using control::Mode;

constexpr auto kHoldTimeout = 1s;

// In the air, and on its way without the sticks.
bool flies_by_itself(Mode mode) {
  return mode == Mode::kTakingOff || mode == Mode::kMission || mode == Mode::kTrajectory;
}

}  // namespace

void Teleop::update(const Sticks& sticks) {
  if (holding_.valid() && holding_.wait_for(0s) != std::future_status::ready) return;
  take_hold_answer();
  if (sticks.centred()) {
    if (moving_) hold();
    return;
  }
  const VehicleState state = vehicle_.state();
  if (state.mode != Mode::kHolding && state.mode != Mode::kSetpoint) return;
  const double yaw_rad = math::euler_angles(state.q_ned_from_frd).heading.yaw_rad;
  if (!std::isfinite(yaw_rad) || !vehicle_.send(velocity_of(sticks, limits_, yaw_rad))) return;
  moving_ = true;
  ++sent_;
}

void Teleop::hold() {
  if (holding_.valid()) return;
  moving_ = false;
  holding_ = std::async(std::launch::async, [this] { return vehicle_.hold(kHoldTimeout).answer(); });
}

bool Teleop::finish() {
  take_hold_answer();
  if (moving_ || flies_by_itself(vehicle_.state().mode)) hold();
  take_hold_answer();
  return !moving_;
}

void Teleop::take_hold_answer() {
  if (!holding_.valid()) return;
  const Result answer = holding_.get();
  hold_fault_ = answer.accepted() ? "" : answer.reason;
  // An answer that does not come is asked for again. A refusal means that the vehicle does not follow setpoints.
  if (!answer.accepted() && answer.kind != Result::Kind::kRefused) moving_ = true;
}

}  // namespace swiftlet::ground
