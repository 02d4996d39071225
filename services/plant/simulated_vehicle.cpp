#include "swiftlet/services/plant/simulated_vehicle.hpp"

#include <cstdio>
#include <type_traits>
#include <utility>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

using comms::topics::kBattery;
using comms::topics::kGroundTruth;
using comms::topics::kImu;
using comms::topics::kRotorSpeeds;

constexpr std::int64_t kReportPeriodNs = 50'000'000;

}  // namespace

std::vector<comms::Subscription> subscribe_commands(comms::Node& node, plant::ControlLevels levels,
                                                    comms::Delivery delivery,
                                                    std::function<void(const ReceivedCommand&)> callback) {
  std::vector<comms::Subscription> subscriptions;
  const auto subscribe = [&](const auto& topic, auto command) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    subscriptions.push_back(node.subscribe<Message>(
        topic,
        [callback, command](const Message& message) mutable {
          const comms::Fault fault = comms::from_message(message, command);
          callback({command, runtime::monotonic_ns(), fault});
        },
        delivery));
  };
  subscribe(comms::topics::kActuatorCommand, plant::ActuatorCommand());
  if (levels.has(plant::ControlLevel::kRates))
    subscribe(comms::topics::kRatesSetpoint, plant::RatesSetpoint());
  if (levels.has(plant::ControlLevel::kAttitude))
    subscribe(comms::topics::kAttitudeSetpoint, plant::AttitudeSetpoint());
  if (levels.has(plant::ControlLevel::kTrajectory))
    subscribe(comms::topics::kTrajectorySetpoint, plant::TrajectorySetpoint());
  return subscriptions;
}

SimulatedVehicle::SimulatedVehicle(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                                   std::uint64_t seed, const plant::VehicleState& initial, comms::Node& node,
                                   bool truth_only)
    : simulation_(vehicle, settings, seed, initial),
      command_path_(settings),
      firmware_(vehicle, settings),
      answers_(plant::period_ns(settings.imu.rate_hz)),
      ground_truth_(node.publish(kGroundTruth)) {
  inform_firmware();
  if (truth_only) return;
  imu_ = node.publish(kImu);
  rotor_speeds_ = node.publish(kRotorSpeeds);
  battery_ = node.publish(kBattery);
}

bool SimulatedVehicle::obey(const ReceivedCommand& received) {
  if (received.fault) {
    refuse(received.fault);
    return false;
  }
  if (!command_path_.send(received.command, simulation_.stamp_ns())) return true;
  if (!accept(received.command)) return false;
  answers_.answered(plant::header_of(received.command).imu_sequence, received.received_ns);
  return true;
}

bool SimulatedVehicle::accept(const plant::VehicleCommand& command) {
  const plant::CommandFault refusal = firmware_.accept(command, simulation_.stamp_ns());
  if (refusal == plant::CommandFault::kNone) {
    ++report_.commands;
    return true;
  }
  comms::Fault fault;
  std::snprintf(fault.text, sizeof fault.text, "%s", plant::to_string(refusal));
  refuse(fault);
  return false;
}

void SimulatedVehicle::refuse(const comms::Fault& fault) {
  ++report_.refused_commands;
  report_.refusal = fault;
}

void SimulatedVehicle::step() {
  if (const auto arrived = command_path_.arrived(simulation_.stamp_ns())) accept(*arrived);
  const plant::MotorCommand command = firmware_.motor_command(simulation_.stamp_ns());
  const bool running = command.state == plant::RotorState::kRunning;
  if (running && !report_.rotors_running) {
    answers_.reset();
    report_.timed_out = false;
  }
  if (!running && report_.rotors_running) report_.timed_out = firmware_.expired(simulation_.stamp_ns());
  report_.rotors_running = running;
  const bool outdated = running && firmware_.outdated(simulation_.stamp_ns());
  if (outdated && !outdated_) ++report_.outdated;
  outdated_ = outdated;
  simulation_.step(command);
  inform_firmware();
}

void SimulatedVehicle::inform_firmware() {
  if (simulation_.imu()) firmware_.on_imu(*simulation_.imu());
  if (simulation_.battery()) firmware_.on_battery(*simulation_.battery());
}

void SimulatedVehicle::publish_samples(bool truth_needed) {
  if (simulation_.imu()) {
    imu_message_ = comms::to_message(*simulation_.imu());
    comms::set_obeyed_command(firmware_.obeyed(), imu_message_);
    if (report_.rotors_running) answers_.written(simulation_.imu()->sequence, runtime::monotonic_ns());
    imu_.publish(imu_message_);
  }
  if (truth_needed) publish_truth();
  publish_slow_samples();
}

void SimulatedVehicle::publish_samples_in_order(std::uint64_t mocap_sequence, bool truth_needed) {
  publish_slow_samples();
  if (!simulation_.imu()) {
    if (truth_needed) publish_truth();
    return;
  }
  // Publishes the longest path first: the controller waits for the frame that motion capture makes of the
  // truth.
  const bool frame_due = mocap_sequence > imu_message_.mocap_sequence_number();
  imu_message_ = comms::to_message(*simulation_.imu());
  comms::set_obeyed_command(firmware_.obeyed(), imu_message_);
  imu_message_.mocap_sequence_number(mocap_sequence);
  imu_message_.battery_sequence_number(battery_message_.sequence_number());
  imu_message_.rotor_speeds_sequence_number(rotor_speeds_message_.sequence_number());
  if (truth_needed && frame_due) publish_truth();
  if (report_.rotors_running) answers_.written(simulation_.imu()->sequence, runtime::monotonic_ns());
  imu_.publish(imu_message_);
  if (truth_needed && !frame_due) publish_truth();
}

void SimulatedVehicle::publish_imu_again() { imu_.publish(imu_message_); }

void SimulatedVehicle::publish_again() {
  if (rotor_speeds_message_.sequence_number() > 0) rotor_speeds_.publish(rotor_speeds_message_);
  if (battery_message_.sequence_number() > 0) battery_.publish(battery_message_);
  ground_truth_.publish(truth_message_);
  publish_imu_again();
}

void SimulatedVehicle::publish_truth() { publish_truth(simulation_.stamp_ns()); }

void SimulatedVehicle::publish_truth(std::int64_t stamp_ns) {
  const std::uint64_t sequence = truth_message_.sequence_number() + 1;
  truth_message_ = comms::to_message(simulation_.truth());
  truth_message_.stamp_ns(stamp_ns);
  truth_message_.sequence_number(sequence);
  ground_truth_.publish(truth_message_);
}

void SimulatedVehicle::publish_slow_samples() {
  if (simulation_.rotor_speeds()) {
    rotor_speeds_message_ = comms::to_message(*simulation_.rotor_speeds());
    rotor_speeds_.publish(rotor_speeds_message_);
  }
  if (simulation_.battery()) {
    battery_message_ = comms::to_message(*simulation_.battery());
    battery_.publish(battery_message_);
  }
}

void SimulatedVehicle::note_slip(std::int64_t slipped_ns) {
  ++report_.slips;
  report_.slipped_ns += slipped_ns;
}

void SimulatedVehicle::report() {
  const bool changed = report_.rotors_running != last_report_.rotors_running ||
                       report_.timed_out != last_report_.timed_out || report_.paused != last_report_.paused;
  if (!changed && simulation_.stamp_ns() - last_report_.stamp_ns < kReportPeriodNs) return;
  report_.stamp_ns = simulation_.stamp_ns();
  report_.answered = answers_.times().count();
  report_.unanswered = answers_.unanswered();
  report_.late = answers_.late();
  report_.answer_p50_ns = answers_.times().quantile_ns(0.5);
  report_.answer_p99_ns = answers_.times().quantile_ns(0.99);
  report_.answer_p999_ns = answers_.times().quantile_ns(0.999);
  report_.answer_max_ns = answers_.times().max_ns();
  last_report_ = report_;
  reports_.put(report_);
}

}  // namespace swiftlet::services
