#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

#include <algorithm>

namespace swiftlet::ground {
namespace {

template <class Entry, class Time>
void keep(std::vector<Entry>& entries, std::int64_t begin_ns, std::int64_t end_ns, Time time_of) {
  entries.erase(std::remove_if(
                    entries.begin(), entries.end(),
                    [&](const Entry& entry) { return time_of(entry) < begin_ns || time_of(entry) > end_ns; }),
                entries.end());
}

}  // namespace

VehicleRecording part_of(const VehicleRecording& recording, std::int64_t begin_ns, std::int64_t end_ns) {
  VehicleRecording part = recording;
  part.begin_ns = begin_ns;
  part.end_ns = end_ns;
  const auto received = [](const auto& entry) { return entry.received_ns; };
  keep(part.imu.samples, begin_ns, end_ns, received);
  keep(part.odometry.samples, begin_ns, end_ns, received);
  keep(part.battery.samples, begin_ns, end_ns, received);
  keep(part.mocap.samples, begin_ns, end_ns, received);
  keep(part.rotor_speeds.samples, begin_ns, end_ns, received);
  keep(part.rotors_running, begin_ns, end_ns, received);
  keep(part.clock, begin_ns, end_ns, [](const ClockExchange& exchange) { return exchange.returned_ns; });
  return part;
}

std::optional<plant::PoseSample> last_pose(const VehicleRecording& recording) {
  const auto& poses = recording.mocap.samples;
  const auto found = std::find_if(poses.rbegin(), poses.rend(),
                                  [](const auto& received) { return received.sample.tracked; });
  return found == poses.rend() ? std::nullopt : std::optional(found->sample);
}

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

bool runs_in_lockstep(const VehicleRecording& recording) {
  const auto in_lockstep = [](const auto& samples) {
    return std::any_of(samples.begin(), samples.end(),
                       [](const auto& received) { return received.sample.lockstep; });
  };
  return recording.description && recording.description->simulated &&
         (in_lockstep(recording.imu.samples) || in_lockstep(recording.odometry.samples));
}

}  // namespace swiftlet::ground
