// An external autopilot flies the vehicle: advances simulated time, by the computer's clock or in lockstep with the
// autopilot's answers.
//
// In lockstep, time waits for the controls that answer each HIL_SENSOR, as soon as the autopilot has sent controls
// with the flag of lockstep. An autopilot whose loops are slower leaves samples without an answer: time waits for every second
// one then, or third, and so on. Without an answer for a time-out, and before the first, time goes on at the
// pace of real time: an autopilot may leave samples without an answer while it starts.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/plant/simulation/navigation_sensors.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/truth_schedule.hpp"
#include "swiftlet/record/flight_trace.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/autopilot_settings.hpp"
#include "swiftlet/services/plant/mavlink_autopilot.hpp"
#include "swiftlet/services/plant/rotor_mapping.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

struct AutopilotLoopSettings {
  AutopilotSettings autopilot;
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 1.0;  // simulated time per real time, but not of samples that are answered in lockstep
  bool limited_in_lockstep = false;  // speed holds for answered samples too
  std::string trace;                 // lockstep: file; empty: none
  runtime::RealtimeSettings realtime;
};

class AutopilotLoop {
 public:
  // The vehicle must outlive the loop. Throws as MavlinkAutopilot, RotorMapping and FlightTrace do.
  AutopilotLoop(SimulatedVehicle& vehicle, const plant::Vehicle& parameters,
                const plant::SimulationSettings& simulation, std::uint64_t seed,
                const AutopilotLoopSettings& settings, dds::Node& node);

  // Runs until `stop`. In lockstep, time stands until the first message of an autopilot.
  void run(const std::atomic<bool>& stop);

 private:
  bool in_lockstep() const { return settings_.clock == runtime::Clock::kLockstep; }
  void wait_for_connection(const std::atomic<bool>& stop);
  void wait_for_answer(const std::atomic<bool>& stop);
  void note_silence();
  void wait_for_tick(const std::atomic<bool>& stop);
  void receive(std::int64_t deadline_ns);
  bool waits_for_answer() const;
  bool answered() const {
    return vehicle_.simulation().stamp_ns() - answered_stamp_ns_ < samples_per_answer_ * imu_period_ns_;
  }
  void note_answer(std::int64_t stamp_ns);
  void advance();
  void obey_until(std::int64_t due_ns);
  void obey(const ReceivedControls& received);
  std::int64_t stamp_answered_by(const ReceivedControls& received) const;
  void publish();
  void publish_samples(bool truth_needed);
  std::optional<std::int64_t> simulated_ns() const;

  SimulatedVehicle& vehicle_;
  const AutopilotLoopSettings settings_;
  RotorMapping mapping_;
  plant::NavigationSensors sensors_;
  plant::TruthSchedule truth_;
  MavlinkAutopilot autopilot_;
  std::int64_t steps_per_sample_;
  std::int64_t imu_period_ns_;
  std::int64_t tick_period_ns_;  // of the IMU, computer's clock
  std::int64_t tick_ns_ = 0;     // when the present sample was due, computer's clock
  std::vector<ReceivedControls> received_;
  std::int64_t answered_stamp_ns_ = -1;  // newest sample that controls have answered
  int samples_per_answer_ = 1;
  int sooner_answers_ = 0;          // in a row, after fewer samples
  int most_left_out_ = 1;           // the most samples per answer that were logged
  bool silent_ = false;             // lockstep: an answer was overdue, and none has come since
  plant::ActuatorCommand command_;  // newest
  std::optional<record::FlightTrace> trace_;
  std::atomic<std::int64_t> origin_ns_{
      0};  // computer's clock at stamp 0, at the present pace; 0: time stands
  std::optional<clocks::ClockClient> clock_client_;  // truth_only
  std::optional<clocks::ClockServer>
      clock_server_;  // otherwise. Last two: their callbacks use all members above
};

}  // namespace swiftlet::services
