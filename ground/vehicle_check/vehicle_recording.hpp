// What was received from a vehicle, with the times of reception: the input of all checks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::ground {

template <class Sample>
struct Received {
  Sample sample;
  std::int64_t received_ns = 0;  // monotonic clock of this computer
};

struct TopicState {
  bool published = false;     // a publisher with matching QoS was found
  std::uint64_t invalid = 0;  // messages with a field out of range, which control refuses too
  std::string fault;          // of the first of them: field, value, limit
  std::string conflict;       // names two processes that both publish the topic; else empty
};

// The messages of a topic, in the order in which they arrived.
template <class Sample>
struct TopicRecord : TopicState {
  std::vector<Received<Sample>> samples;

  bool is_present() const { return published || !samples.empty(); }
};

struct ImuReport {
  plant::ImuSample imu;
  plant::ObeyedCommand obeyed;
  bool lockstep = false;  // it names the samples that belong to it, as in lockstep only
};

// The vehicle's own estimate, in place of an IMU sample.
struct OdometryReport {
  plant::OdometrySample odometry;
  plant::ObeyedCommand obeyed;
  bool lockstep = false;
};

struct VehicleDescription {
  std::string name;
  bool simulated = false;
  int rotor_count = 0;
  double mass_kg = 0.0;
  double imu_rate_hz = 0.0;
  plant::ControlLevels levels = plant::ControlLevel::kActuators;
  double full_battery_v = 0.0;   // 0: not reported
  double empty_battery_v = 0.0;  // likewise
  std::string foreign{};         // it has another wire version, a sentence; empty: not so
};

// The vehicle accepts a level at which it closes its inner loops itself.
inline bool closes_inner_loops(plant::ControlLevels levels) {
  return levels != plant::ControlLevel::kActuators;
}

// A request for the vehicle's clock and its answer.
struct ClockExchange {
  std::int64_t sent_ns = 0;      // computer's clock
  std::int64_t received_ns = 0;  // vehicle's clock
  std::int64_t answered_ns = 0;  // vehicle's clock
  std::int64_t returned_ns = 0;  // computer's clock
};

constexpr std::size_t kFewest = 3;  // samples of a topic, to say anything about it

struct VehicleRecording {
  std::int64_t begin_ns = 0;  // computer's clock
  std::int64_t end_ns = 0;
  TopicRecord<ImuReport> imu;
  TopicRecord<OdometryReport> odometry;
  TopicRecord<plant::BatterySample> battery;
  TopicRecord<plant::PoseSample> mocap;
  TopicRecord<plant::RotorSpeedSample> rotor_speeds;
  std::optional<VehicleDescription> description;  // vehicle_info
  std::vector<Received<bool>> rotors_running;     // vehicle_info
  std::vector<ClockExchange> clock;
  std::vector<std::string> mismatches;  // of types, QoS and topic names, a sentence each

  double duration_s() const { return 1e-9 * static_cast<double>(end_ns - begin_ns); }
};

// The part that was received in begin_ns .. end_ns.
VehicleRecording part_of(const VehicleRecording& recording, std::int64_t begin_ns, std::int64_t end_ns);

// The last tracked pose of motion capture.
std::optional<plant::PoseSample> last_pose(const VehicleRecording& recording);

// Mean speeds, rad/s, of the samples received in this time; nullopt without any.
std::optional<plant::PerRotor> mean_rotor_speeds(const VehicleRecording& recording, std::int64_t begin_ns,
                                                 std::int64_t end_ns);

// The vehicle's time follows the answers of a controller, so that nothing can be said about its timing.
bool runs_in_lockstep(const VehicleRecording& recording);

}  // namespace swiftlet::ground
