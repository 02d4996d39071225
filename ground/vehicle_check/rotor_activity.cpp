#include "swiftlet/ground/vehicle_check/rotor_activity.hpp"

#include <algorithm>
#include <cstddef>

namespace swiftlet::ground {
namespace {

constexpr double kTurning_rad_s = 30.0;  // five turns a second
constexpr double kSlowed = 0.8;          // of the speed before

double fastest(const plant::PerRotor& speeds) { return *std::max_element(speeds.begin(), speeds.end()); }

bool is_slowed(const plant::RotorSpeedSample& sample, const plant::PerRotor& before) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(sample.rotor_count); ++i) {
    if (sample.speeds[i] > kSlowed * before[i]) return false;
  }
  return true;
}

}  // namespace

std::optional<plant::PerRotor> mean_rotor_speeds(const VehicleRecording& recording, std::int64_t begin_ns,
                                                 std::int64_t end_ns) {
  plant::PerRotor sum{};
  int count = 0;
  for (const auto& received : recording.rotor_speeds.samples) {
    if (received.received_ns < begin_ns || received.received_ns > end_ns) continue;
    ++count;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += received.sample.speeds[i];
  }
  if (count == 0) return std::nullopt;
  for (double& speed : sum) speed /= count;
  return sum;
}

std::optional<bool> rotors_turn(const VehicleRecording& recording, std::int64_t begin_ns,
                                std::int64_t end_ns) {
  if (const auto speeds = mean_rotor_speeds(recording, begin_ns, end_ns))
    return fastest(*speeds) > kTurning_rad_s;
  std::optional<bool> running;
  for (const Received<bool>& report : recording.rotors_running) {
    if (report.received_ns <= end_ns) running = report.sample;
  }
  return running;
}

std::optional<std::int64_t> rotors_slow_at(const VehicleRecording& recording, std::int64_t begin_ns,
                                           std::int64_t end_ns,
                                           const std::optional<plant::PerRotor>& speeds_before) {
  if (speeds_before) {
    for (const auto& received : recording.rotor_speeds.samples) {
      if (received.received_ns >= begin_ns && received.received_ns <= end_ns &&
          is_slowed(received.sample, *speeds_before))
        return received.received_ns;
    }
    return std::nullopt;
  }
  for (const Received<bool>& report : recording.rotors_running) {
    if (report.received_ns >= begin_ns && report.received_ns <= end_ns && !report.sample)
      return report.received_ns;
  }
  return std::nullopt;
}

}  // namespace swiftlet::ground
