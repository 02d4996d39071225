// Flies a circle of 0.5 m radius with a stream of position setpoints at 50 Hz. After take-off the vehicle
// follows the stream; when the stream stops, it holds.
//
//   swiftlet-plant & swiftlet-mocap & swiftlet-control &
//   example-stream-circle [VEHICLE] [DOMAIN] [--open-network]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <swiftlet/ground/client/vehicle.hpp>
#include <swiftlet/ground/examples/arguments.hpp>

namespace {

using swiftlet::ground::PositionSetpoint;
using swiftlet::ground::Vehicle;

constexpr double kRadius_m = 0.5;
constexpr double kTurn_s = 8.0;  // one revolution
constexpr std::chrono::milliseconds kPeriod{20};
constexpr double kSoftStart_s = 2.0;

// The angle along the circle, rad, and its time derivatives, rad/s and rad/s^2.
struct Turn {
  double angle;
  double rate;
  double acceleration;
};

// Accelerates from rest to the full rate within kSoftStart_s, with a cosine profile.
Turn turn_at(double t) {
  const double full = 2.0 * M_PI / kTurn_s;
  if (t >= kSoftStart_s) return {full * (t - 0.5 * kSoftStart_s), full, 0.0};
  const double phase = M_PI * t / kSoftStart_s;
  return {0.5 * full * (t - std::sin(phase) * kSoftStart_s / M_PI), 0.5 * full * (1.0 - std::cos(phase)),
          0.5 * full * M_PI / kSoftStart_s * std::sin(phase)};
}

// The position at time t, s, with velocity and acceleration fed forward. The circle begins at `start`, where
// the vehicle holds, going east.
PositionSetpoint circle(double t, const Eigen::Vector3d& start) {
  const Turn turn = turn_at(t);
  const Eigen::Vector3d outward(std::cos(turn.angle), std::sin(turn.angle), 0.0);
  const Eigen::Vector3d along(-std::sin(turn.angle), std::cos(turn.angle), 0.0);
  PositionSetpoint setpoint;
  setpoint.position_ned_m = start + kRadius_m * (outward - Eigen::Vector3d::UnitX());
  setpoint.velocity_ned_m_s = kRadius_m * turn.rate * along;
  setpoint.acceleration_ned_m_s2 = kRadius_m * (turn.acceleration * along - turn.rate * turn.rate * outward);
  return setpoint;
}

bool fly_circle(Vehicle& vehicle) {
  const auto before = vehicle.state();
  const Eigen::Vector3d start = before.reference_position_ned_m;
  const double begin_s = vehicle.clock_s();  // vehicle's clock: a simulation may be slower than real time
  double farthest_m = 0.0;
  double t = 0.0;
  while (t < kTurn_s + 0.5 * kSoftStart_s) {
    vehicle.send(circle(t, start));
    farthest_m = std::max(farthest_m, (vehicle.state().position_ned_m - start).norm());
    std::this_thread::sleep_for(kPeriod);
    t = vehicle.clock_s() - begin_s;
  }
  std::printf("flew one circle, up to %.2f m from its start\n", farthest_m);
  // The stream has stopped: the vehicle holds.
  const bool holds =
      vehicle.wait_until([](const auto& state) { return state.mode == swiftlet::control::Mode::kHolding; },
                         std::chrono::seconds(20));
  const auto tally = vehicle.state().setpoints;
  std::printf("%llu setpoints were accepted\n",
              static_cast<unsigned long long>(tally.accepted - before.setpoints.accepted));
  if (tally.refused > before.setpoints.refused) std::fprintf(stderr, "%s\n", tally.refusal.c_str());
  return holds && tally.refused == before.setpoints.refused;
}

}  // namespace

int main(int argc, char** argv) try {
  Vehicle vehicle(swiftlet::examples::read_arguments(argc, argv).network);
  const swiftlet::ground::Result connection = vehicle.connect();
  if (!connection.accepted()) {
    std::fprintf(stderr, "%s\n", connection.reason.c_str());
    return 1;
  }
  const bool flown =
      vehicle.arm().wait().done() && vehicle.take_off(1.0).wait().done() && fly_circle(vehicle);
  return vehicle.land().wait().done() && flown ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
