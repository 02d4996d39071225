// The simulated vehicle on DDS: publishes its sensor samples, obeys commands at the levels that it accepts. RealtimeLoop and
// LockstepLoop advance its time.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "swiftlet/plant/simulation/firmware/firmware.hpp"
#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/links/radio.hpp"
#include "swiftlet/plant/simulation/links/telemetry_path.hpp"
#include "swiftlet/plant/simulation/odometry.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/plant/answer_latencies.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"

namespace swiftlet::services {

// The loop's report to the rest of the process.
struct PlantReport {
  std::int64_t stamp_ns = 0;
  std::uint32_t boot = 0;  // as plant::ObeyedCommand::boot
  bool rotors_running = false;
  bool timed_out = false;      // command time-out: the vehicle stopped its rotors
  std::uint64_t outdated = 0;  // times that commands ceased while the rotors ran
  bool paused = false;         // lockstep: waits for simulation_clock
  std::uint64_t answered = 0;
  std::uint64_t unanswered = 0;
  std::uint64_t late = 0;
  std::int64_t answer_p50_ns = 0;
  std::int64_t answer_p99_ns = 0;
  std::int64_t answer_p999_ns = 0;
  std::int64_t answer_max_ns = 0;
  std::uint64_t commands = 0;  // obeyed
  std::uint64_t refused_commands = 0;
  messages::Fault refusal;      // of the last refused command
  std::uint64_t slips = 0;      // number of times the loop fell behind real time
  std::int64_t slipped_ns = 0;  // total
};

// A command as received, of any level.
struct ReceivedCommand {
  plant::VehicleCommand command;
  std::int64_t received_ns = 0;  // monotonic
  messages::Fault fault;
};

// Subscribes to the commands of the levels that the vehicle accepts, and to those of level actuators, with which a
// controller turns the rotors off before it knows the levels. The callback runs in the threads of the subscriptions.
std::vector<dds::Subscription> subscribe_commands(dds::Node& node, plant::ControlLevels levels,
                                                  dds::Delivery delivery,
                                                  std::function<void(const ReceivedCommand&)> callback);

// Not thread-safe.
class SimulatedVehicle {
 public:
  // truth_only: publishes nothing but by publish_truth().
  SimulatedVehicle(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                   std::uint64_t seed, const plant::VehicleState& initial, dds::Node& node,
                   bool truth_only = false);

  const plant::PlantSimulation& simulation() const { return simulation_; }

  // Returns false if the command is refused, that is ignored. A command that the radio or a simulated fault delays or
  // drops is not refused.
  bool obey(const ReceivedCommand& received);
  // A pose of motion capture, for the loops of levels attitude and trajectory.
  void on_pose(const plant::PoseSample& pose);
  bool needs_poses() const { return firmware_.needs_poses(); }
  // The command with the throttles that carry it out, for a trace.
  plant::ActuatorCommand as_actuators(const plant::VehicleCommand& command) const {
    return firmware_.as_actuators(command);
  }
  // Advances one integration step.
  void step();
  // Publishes the samples due at this stamp, the IMU's first: the controller waits for it. Over a radio those that have
  // arrived.
  void publish_samples(bool truth_needed);
  // Publishes the ground truth alone, with this stamp.
  void publish_truth(std::int64_t stamp_ns);
  // The same for lockstep: publishes battery and rotor speeds before the IMU sample that belongs to them. The
  // IMU sample carries the sequence numbers that control must wait for. mocap_sequence: the newest frame that
  // motion capture makes of the ground truth up to this stamp.
  void publish_samples_in_order(std::uint64_t mocap_sequence, bool truth_needed);
  // Lockstep: the IMU sample that was published at this stamp and waits for its answer.
  const std::optional<std::uint64_t>& awaited() const { return awaited_; }
  // The awaited sample is answered. Over a radio, publishes the next one that has arrived at this stamp.
  void go_on_in_order();
  void publish_imu_again();
  void publish_again();  // the newest sample of each topic

  // Updates reports() on a change of state and every 50 ms of simulated time.
  void report();
  void note_slip(std::int64_t slipped_ns);
  void note_pause(bool paused) { report_.paused = paused; }
  runtime::LatestValue<PlantReport>& reports() { return reports_; }

 private:
  bool accept(const plant::VehicleCommand& command);
  void prepare_imu(const plant::TelemetryPacket& packet);
  void publish_imu_in_order(const plant::TelemetryPacket& packet);
  plant::TelemetryPacket present_samples() const;
  plant::ObeyedCommand obeyed() const;
  void inform_firmware();
  void refuse(const messages::Fault& fault);
  void publish_truth();
  void publish_slow_samples(const plant::SensorSamples& samples);

  plant::PlantSimulation simulation_;
  plant::TelemetryPath telemetry_path_;
  plant::CommandPath command_path_;
  plant::RadioLine<plant::PoseSample> pose_path_;
  plant::Firmware firmware_;
  std::optional<plant::Odometry> odometry_;  // of a vehicle that brings it in place of IMU samples
  std::optional<plant::OdometrySample> odometry_sample_;  // of the present IMU sample
  // The newest samples; sequence number 0 before the first.
  messages::msg::Imu imu_message_;
  messages::msg::VehicleOdometry odometry_message_;
  messages::msg::GroundTruth truth_message_;
  std::uint64_t mocap_sequence_ = 0;  // lockstep: newest frame that control must have
  std::optional<std::uint64_t> awaited_;

  bool outdated_ = false;  // the vehicle obeys no command, and its rotors run
  PlantReport report_;
  PlantReport last_report_;
  AnswerLatencies answers_;
  runtime::LatestValue<PlantReport> reports_;

  dds::Publisher<messages::msg::Imu> imu_;  // or, in its place:
  dds::Publisher<messages::msg::VehicleOdometry> vehicle_odometry_;
  dds::Publisher<messages::msg::GroundTruth> ground_truth_;

  template <class Message>
  struct Sensor {
    messages::Topic<Message> topic;
    dds::Publisher<Message> publisher = {};
    Message message = {};  // the newest
  };
  struct Sensors {
    Sensor<messages::msg::Battery> battery{messages::topics::kBattery};
    Sensor<messages::msg::RotorSpeeds> rotor_speeds{messages::topics::kRotorSpeeds};
  };
  Sensors sensors_;
};

}  // namespace swiftlet::services
