// The simulated vehicle on the network: publishes what it senses, obeys what reaches it. When time passes is
// for the loops.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/simulation/actuator_watchdog.hpp"
#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/plant/answer_latencies.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"

namespace swiftlet::services {

// What the loop tells the rest of the process.
struct PlantReport {
  std::int64_t stamp_ns = 0;
  bool rotors_running = false;
  bool timed_out = false;  // the vehicle stopped its rotors itself: commands ceased
  bool paused = false;     // in lockstep: waits to be granted more time
  std::uint64_t answered = 0;
  std::uint64_t unanswered = 0;
  std::uint64_t late = 0;
  std::int64_t answer_p50_ns = 0;
  std::int64_t answer_p99_ns = 0;
  std::int64_t answer_p999_ns = 0;
  std::int64_t answer_max_ns = 0;
  std::uint64_t commands = 0;  // that were obeyed
  std::uint64_t refused_commands = 0;
  comms::Fault refusal;         // of the last of those
  std::uint64_t slips = 0;      // times that the loop fell behind real time
  std::int64_t slipped_ns = 0;  // in all
};

// An actuator command as it came.
struct ReceivedCommand {
  explicit ReceivedCommand(const comms::msg::ActuatorCommand& message, std::int64_t now_ns)
      : received_ns(now_ns), fault(comms::from_message(message, command)) {}
  ReceivedCommand() = default;

  plant::ActuatorCommand command;
  std::int64_t received_ns = 0;  // monotonic
  comms::Fault fault;
};

// One thread at a time calls it.
class SimulatedVehicle {
 public:
  SimulatedVehicle(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                   std::uint64_t seed, const plant::VehicleState& initial, comms::Node& node);

  const plant::PlantSimulation& simulation() const { return simulation_; }

  // False if the command was refused; it then counts as none. One that a fault keeps back is not refused.
  bool obey(const ReceivedCommand& received);
  // One integration step.
  void step();
  // What is due at this stamp, the IMU's sample first: the controller waits for it.
  void publish_samples();
  // The same for lockstep: each sample that belongs to the IMU's before it, and the IMU's with the numbers of
  // what is to be waited for. mocap_sequence: the newest frame that motion capture makes of the truth so far.
  void publish_samples_in_order(std::uint64_t mocap_sequence, bool truth_needed);
  void publish_imu_again();
  void publish_again();  // the newest of all samples

  // Puts a report out when something changed or the last one has become old.
  void report();
  void note_slip(std::int64_t slipped_ns);
  void note_pause(bool paused) { report_.paused = paused; }
  runtime::LatestValue<PlantReport>& reports() { return reports_; }

 private:
  bool accept(const plant::ActuatorCommand& command);
  void refuse(const comms::Fault& fault);
  void publish_truth();
  void publish_slow_samples();

  plant::PlantSimulation simulation_;
  plant::CommandPath command_path_;
  plant::ActuatorWatchdog watchdog_;
  // The newest; number 0 before the first.
  comms::msg::Imu imu_message_;
  comms::msg::Battery battery_message_;
  comms::msg::RotorSpeeds rotor_speeds_message_;
  comms::msg::GroundTruth truth_message_;

  PlantReport report_;
  PlantReport last_report_;
  AnswerLatencies answers_;
  runtime::LatestValue<PlantReport> reports_;

  comms::Publisher<comms::msg::Imu> imu_;
  comms::Publisher<comms::msg::GroundTruth> ground_truth_;
  comms::Publisher<comms::msg::RotorSpeeds> rotor_speeds_;
  comms::Publisher<comms::msg::Battery> battery_;
};

}  // namespace swiftlet::services
