#include "swiftlet/simulation/mission_runner.hpp"

#include <fmt/core.h>

namespace swiftlet::simulation {
namespace {

void arm(MissionTransport& vehicle) {
  for (std::int64_t waited_ns = 0;; waited_ns += FlightSchedule::kArmingRetryNs) {
    const MissionTransport::Reply reply = vehicle.arm();
    if (reply.accepted) return;
    const bool late = waited_ns + FlightSchedule::kArmingRetryNs > FlightSchedule::kArmingTimeoutNs;
    if (!reply.retry || late) throw FlightFailure("arming failed: " + reply.reason);
    vehicle.wait(FlightSchedule::kArmingRetryNs, "arming refused: " + reply.reason);
  }
}

void start(MissionTransport& vehicle) {
  const MissionTransport::Reply reply = vehicle.start_mission();
  if (!reply.accepted) vehicle.abandon("mission refused: " + reply.reason);
}

void follow(MissionTransport& vehicle, double planned_duration_s) {
  const double time_limit_s = FlightSchedule::time_limit_s(planned_duration_s);
  const std::int64_t start_ns = vehicle.status().stamp_ns;
  while (true) {
    vehicle.advance();
    const MissionTransport::Status status = vehicle.status();
    if (status.mission == control::MissionState::kCompleted && status.rotors_off) return;
    if (status.mission == control::MissionState::kAborted)
      vehicle.abandon("the mission was aborted: " + vehicle.abort_reason());
    if (static_cast<double>(status.stamp_ns - start_ns) * 1e-9 > time_limit_s) {
      vehicle.abandon(fmt::format("the mission exceeds its time limit of {:.0f} s (planned: {:.0f} s)",
                                  time_limit_s, planned_duration_s));
    }
  }
}

}  // namespace

bool comes_down(control::Mode mode) {
  return mode == control::Mode::kLanding || mode == control::Mode::kDescent;
}

std::string end_of(control::Mode mode, bool has_flown) {
  if (mode == control::Mode::kStopped) return "rotors stopped";
  return has_flown ? "landed" : "disarmed";
}

void fly_mission(MissionTransport& vehicle, double planned_duration_s) {
  vehicle.wait_until_ready();
  arm(vehicle);
  vehicle.wait_for_other_vehicles();
  start(vehicle);
  follow(vehicle, planned_duration_s);
}

}  // namespace swiftlet::simulation
