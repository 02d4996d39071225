// Flies a circle of 0.5 m with a stream of setpoints, 50 a second: after take-off the vehicle follows
// whatever comes, and holds when nothing comes any more.
//
//   swiftlet-plant & swiftlet-mocap & swiftlet-control &
//   example-stream-circle [VEHICLE] [DOMAIN] [--localhost-only]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <ground/examples/arguments.hpp>
#include <ground/vehicle.hpp>

namespace {

using swiftlet::control::Setpoint;
using swiftlet::control::SetpointKind;
using swiftlet::ground::Vehicle;

constexpr double kRadius = 0.5;  // m
constexpr double kTurn_s = 8.0;  // for once around
constexpr std::chrono::milliseconds kPeriod{20};
constexpr double kSoftStart_s = 2.0;

// Angle along the circle and its rate: from rest to its full rate within kSoftStart_s, by a cosine.
void angle_at(double t, double& angle, double& rate, double& acceleration) {
  const double full = 2.0 * M_PI / kTurn_s;
  if (t >= kSoftStart_s) {
    rate = full;
    angle = full * (t - 0.5 * kSoftStart_s);
    acceleration = 0.0;
    return;
  }
  const double phase = M_PI * t / kSoftStart_s;
  rate = 0.5 * full * (1.0 - std::cos(phase));
  angle = 0.5 * full * (t - std::sin(phase) * kSoftStart_s / M_PI);
  acceleration = 0.5 * full * M_PI / kSoftStart_s * std::sin(phase);
}

// A position with its velocity and acceleration, which are fed forward. It begins where the vehicle holds,
// `start`, going east.
Setpoint circle(double t, const Eigen::Vector3d& start) {
  double angle, rate, acceleration;
  angle_at(t, angle, rate, acceleration);
  const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::Vector3d along(-std::sin(angle), std::cos(angle), 0.0);
  Setpoint setpoint;
  setpoint.kind = SetpointKind::kPosition;
  setpoint.position_ned = start + kRadius * (outward - Eigen::Vector3d::UnitX());
  setpoint.velocity_ned = kRadius * rate * along;
  setpoint.acceleration_ned = kRadius * (acceleration * along - rate * rate * outward);
  setpoint.yaw_free = true;
  return setpoint;
}

bool fly_circle(Vehicle& vehicle) {
  const auto before = vehicle.state();
  const Eigen::Vector3d start = before.reference_ned;
  const double begin_s = vehicle.clock_s();  // the vehicle's time: a simulation may be slower than real time
  double farthest_m = 0.0;
  for (double t = 0.0; t < kTurn_s + 0.5 * kSoftStart_s; t = vehicle.clock_s() - begin_s) {
    vehicle.send(circle(t, start));
    farthest_m = std::max(farthest_m, (vehicle.state().position_ned - start).norm());
    std::this_thread::sleep_for(kPeriod);
  }
  std::printf("once around, up to %.2f m from its start\n", farthest_m);
  // No setpoint comes any more: it holds.
  const bool holds =
      vehicle.wait_until([](const auto& state) { return state.mode == swiftlet::control::Mode::kHolding; },
                         std::chrono::seconds(20));
  const auto tally = vehicle.state().setpoints;
  std::printf("%llu setpoints were taken\n",
              static_cast<unsigned long long>(tally.taken - before.setpoints.taken));
  if (tally.refused > before.setpoints.refused) std::fprintf(stderr, "%s\n", tally.refusal.c_str());
  return holds && tally.refused == before.setpoints.refused;
}

}  // namespace

int main(int argc, char** argv) {
  Vehicle vehicle(swiftlet::examples::network(argc, argv));
  const swiftlet::ground::Answer there = vehicle.connect();
  if (!there.accepted()) {
    std::fprintf(stderr, "%s\n", there.reason.c_str());
    return 1;
  }
  const bool flown =
      vehicle.arm().wait().done() && vehicle.take_off(1.0).wait().done() && fly_circle(vehicle);
  return vehicle.land().wait().done() && flown ? 0 : 1;
}
