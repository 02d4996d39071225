#include "tests/soak/fault_draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::soak {
namespace {

using Eigen::Vector3d;
using math::RandomStream;
using plant::Fault;
using plant::FaultKind;

constexpr double kMeanInterval_s = 4.0;
constexpr double kRecovery_s = 5.0;  // of the estimate after a fault of IMU or motion capture

// Duration of a kind of fault: log-uniform between these.
struct Duration {
  FaultKind kind;
  double min_s;
  double max_s;
};
constexpr std::array<Duration, plant::kFaultKinds> kDurations = {{
    {FaultKind::kMocapStop, 0.02, 5.0},      {FaultKind::kMocapFreeze, 0.02, 5.0},
    {FaultKind::kMocapUntracked, 0.02, 5.0}, {FaultKind::kMocapJump, 0.01, 3.0},
    {FaultKind::kMocapSwap, 0.01, 3.0},      {FaultKind::kMocapLatency, 0.1, 5.0},
    {FaultKind::kImuStop, 0.002, 1.0},       {FaultKind::kImuNan, 0.002, 1.0},
    {FaultKind::kImuStuck, 0.002, 0.3},      {FaultKind::kImuBias, 0.05, 3.0},
    {FaultKind::kBatteryStop, 0.1, 20.0},    {FaultKind::kRotorSpeedsStop, 0.1, 20.0},
    {FaultKind::kBatteryDrop, 0.1, 5.0},     {FaultKind::kRotorThrust, 0.05, 3.0},
    {FaultKind::kPush, 0.02, 0.2},           {FaultKind::kWind, 0.5, 10.0},
    {FaultKind::kCommandsStop, 0.002, 1.0},  {FaultKind::kCommandsDelay, 0.02, 2.0},
    {FaultKind::kOdometryJump, 0.01, 3.0},  // without effect on a vehicle that motion capture follows
}};

Vector3d inside(const control::Limits& limits, RandomStream& random) {
  Vector3d place;
  for (int i = 0; i < 3; ++i) place[i] = random.uniform(limits.fence_min_ned[i], limits.fence_max_ned[i]);
  return place;
}

void draw_parameters(Fault& fault, const plant::Vehicle& vehicle, const control::Limits& limits,
                     RandomStream& random) {
  switch (fault.kind) {
    case FaultKind::kMocapJump:
      fault.position_ned = random.log_uniform(0.01, 3.0) * random.on_unit_sphere();
      if (random.uniform() < 0.5)
        fault.rotation_frd = random.log_uniform(0.05, M_PI) * random.on_unit_sphere();
      return;
    case FaultKind::kMocapSwap:
      fault.position_ned = inside(limits, random);
      fault.yaw_rad = random.uniform(-M_PI, M_PI);
      return;
    case FaultKind::kMocapLatency:
      fault.delay_s = random.log_uniform(0.005, 0.1);
      return;
    case FaultKind::kImuBias:
      fault.specific_force_frd = random.log_uniform(0.05, 0.5) * random.on_unit_sphere();
      fault.body_rates_frd = random.log_uniform(0.005, 0.1) * random.on_unit_sphere();
      return;
    case FaultKind::kBatteryDrop:
      fault.voltage_v = random.log_uniform(0.05, 0.8);
      return;
    case FaultKind::kRotorThrust:
      fault.rotor = 1 + static_cast<int>(random.uniform() * vehicle.rotor_count());
      fault.factor = random.uniform(0.85, 1.0);
      return;
    case FaultKind::kPush:
      fault.force_ned =
          random.log_uniform(0.05, 0.5) * vehicle.mass_kg / fault.for_s * random.on_unit_sphere();
      fault.moment_frd =
          random.log_uniform(0.2, 3.0) / fault.for_s * (vehicle.inertia * random.on_unit_sphere());
      return;
    case FaultKind::kWind:
      fault.wind_ned = random.log_uniform(0.2, 4.0) * random.on_unit_sphere();
      return;
    case FaultKind::kCommandsDelay:
      fault.delay_s = random.log_uniform(0.002, 0.02);
      return;
    default:
      return;  // no parameters
  }
}

bool hides_attitude(FaultKind kind) {
  return kind == FaultKind::kMocapStop || kind == FaultKind::kMocapFreeze ||
         kind == FaultKind::kMocapUntracked || kind == FaultKind::kMocapJump || kind == FaultKind::kMocapSwap;
}
bool misleads(FaultKind kind) { return kind == FaultKind::kImuBias || kind == FaultKind::kImuStuck; }

// A misleading IMU during a loss of motion capture is undetectable.
bool hidden(const Fault& fault, const std::vector<Fault>& earlier) {
  return std::any_of(earlier.begin(), earlier.end(), [&](const Fault& other) {
    const bool together = (misleads(fault.kind) && hides_attitude(other.kind)) ||
                          (misleads(other.kind) && hides_attitude(fault.kind));
    return together && fault.at_s < other.at_s + other.for_s + kRecovery_s;
  });
}

}  // namespace

std::vector<Fault> draw_faults(std::uint64_t seed, double first_s, double last_s,
                               const plant::Vehicle& vehicle, const control::Limits& limits) {
  RandomStream random(seed, plant::streams::of_name("soak.faults"));
  std::array<double, plant::kFaultKinds> free_from_s{};  // by kind: end of its last fault
  std::vector<Fault> faults;
  for (double at_s = first_s;;) {
    at_s -= kMeanInterval_s * std::log(1.0 - random.uniform());
    if (at_s > last_s) return faults;
    const auto index = static_cast<std::size_t>(random.uniform() * static_cast<double>(plant::kFaultKinds));
    const Duration& duration = kDurations[index];
    Fault fault;
    fault.kind = duration.kind;
    fault.at_s = at_s;
    fault.for_s = random.log_uniform(duration.min_s, duration.max_s);
    draw_parameters(fault, vehicle, limits, random);
    if (at_s <= free_from_s[index]) continue;  // one of a kind at a time
    if (hidden(fault, faults)) continue;
    free_from_s[index] = at_s + fault.for_s;
    faults.push_back(fault);
  }
}

}  // namespace swiftlet::soak
