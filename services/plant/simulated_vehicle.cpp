#include "swiftlet/services/plant/simulated_vehicle.hpp"

#include <cstdio>
#include <type_traits>
#include <utility>

#include "swiftlet/plant/simulation/streams.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::services {
namespace {

using messages::topics::kGroundTruth;
using messages::topics::kImu;
using messages::topics::kVehicleOdometry;

constexpr std::int64_t kReportPeriodNs = 50'000'000;

}  // namespace

std::vector<dds::Subscription> subscribe_commands(dds::Node& node, plant::ControlLevels levels,
                                                  dds::Delivery delivery,
                                                  std::function<void(const ReceivedCommand&)> callback) {
  std::vector<dds::Subscription> subscriptions;
  const auto subscribe = [&](const auto& topic, auto command) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    subscriptions.push_back(node.subscribe<Message>(
        topic,
        [callback, command](const Message& message) mutable {
          const messages::Fault fault = messages::from_message(message, command);
          callback({command, runtime::monotonic_ns(), fault});
        },
        delivery));
  };
  subscribe(messages::topics::kActuatorCommand, plant::ActuatorCommand());
  if (levels.has(plant::ControlLevel::kRates))
    subscribe(messages::topics::kRatesSetpoint, plant::RatesSetpoint());
  if (levels.has(plant::ControlLevel::kAttitude))
    subscribe(messages::topics::kAttitudeSetpoint, plant::AttitudeSetpoint());
  if (levels.has(plant::ControlLevel::kTrajectory))
    subscribe(messages::topics::kTrajectorySetpoint, plant::TrajectorySetpoint());
  return subscriptions;
}

SimulatedVehicle::SimulatedVehicle(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                                   std::uint64_t seed, const plant::VehicleState& initial, dds::Node& node,
                                   bool truth_only)
    : simulation_(vehicle, settings, seed, initial),
      telemetry_path_(settings, seed),
      command_path_(settings, seed),
      pose_path_(settings, seed, plant::streams::kRadioPoses),
      firmware_(vehicle, settings),
      answers_(plant::period_ns(settings.imu.rate_hz)),
      ground_truth_(node.publish(kGroundTruth)) {
  report_.boot = runtime::boot_number();
  if (settings.odometry.source != plant::OdometrySource::kNone) odometry_.emplace(settings, seed);
  inform_firmware();
  if (truth_only) return;
  if (odometry_) {
    vehicle_odometry_ = node.publish(kVehicleOdometry);
  } else {
    imu_ = node.publish(kImu);
  }
  plant::for_each_sensor([&](auto& sensor) { sensor.publisher = node.publish(sensor.topic); }, sensors_);
}

bool SimulatedVehicle::obey(const ReceivedCommand& received) {
  if (received.fault) {
    refuse(received.fault);
    return false;
  }
  const bool arrives = command_path_.send(received.command, simulation_.stamp_ns());
  if (arrives && !accept(received.command)) return false;
  if (arrives || telemetry_path_.has_radio())
    answers_.answered(plant::header_of(received.command).imu_sequence, received.received_ns);
  return true;
}

void SimulatedVehicle::on_pose(const plant::PoseSample& pose) {
  if (!pose_path_.on()) return firmware_.on_pose(pose);
  pose_path_.send(pose, simulation_.stamp_ns());
}

bool SimulatedVehicle::accept(const plant::VehicleCommand& command) {
  const plant::CommandFault refusal = firmware_.accept(command, simulation_.stamp_ns());
  if (refusal == plant::CommandFault::kNone) {
    ++report_.commands;
    return true;
  }
  messages::Fault fault;
  std::snprintf(fault.text, sizeof fault.text, "%s", plant::to_string(refusal));
  refuse(fault);
  return false;
}

void SimulatedVehicle::refuse(const messages::Fault& fault) {
  ++report_.refused_commands;
  report_.refusal = fault;
}

void SimulatedVehicle::step() {
  while (const auto* pose = pose_path_.take(simulation_.stamp_ns())) firmware_.on_pose(*pose);
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

plant::ObeyedCommand SimulatedVehicle::obeyed() const {
  plant::ObeyedCommand obeyed = firmware_.obeyed();
  obeyed.boot = report_.boot;
  return obeyed;
}

void SimulatedVehicle::inform_firmware() {
  odometry_sample_.reset();
  if (simulation_.imu()) firmware_.on_imu(*simulation_.imu());
  if (simulation_.imu() && odometry_) {
    odometry_sample_ = odometry_->sample(*simulation_.imu(), simulation_.state(), firmware_.estimator());
    firmware_.on_odometry(*odometry_sample_);
  }
  if (simulation_.battery()) firmware_.on_battery(*simulation_.battery());
  if (telemetry_path_.has_radio()) telemetry_path_.collect(simulation_, obeyed(), odometry_sample_);
}

// Without a radio, the samples of this stamp are those that arrive.
plant::TelemetryPacket SimulatedVehicle::present_samples() const {
  return {{}, *simulation_.imu(), odometry_sample_, obeyed()};
}

void SimulatedVehicle::prepare_imu(const plant::TelemetryPacket& packet) {
  if (packet.odometry) {
    odometry_message_ = messages::to_message(*packet.odometry);
    odometry_message_.obeyed(messages::to_message(packet.obeyed));
  } else {
    imu_message_ = messages::to_message(packet.imu);
    imu_message_.obeyed(messages::to_message(packet.obeyed));
  }
  if (report_.rotors_running) answers_.written(packet.imu.sequence, runtime::monotonic_ns());
}

void SimulatedVehicle::publish_samples(bool truth_needed) {
  if (telemetry_path_.has_radio()) {
    while (const auto* packet = telemetry_path_.take(simulation_.stamp_ns())) {
      prepare_imu(*packet);
      publish_imu_again();
      publish_slow_samples(*packet);
    }
    if (truth_needed) publish_truth();
    return;
  }
  if (simulation_.imu()) {
    prepare_imu(present_samples());
    publish_imu_again();
  }
  if (truth_needed) publish_truth();
  publish_slow_samples(simulation_.samples());
}

// Publishes the longest path first: the controller waits for the frame that motion capture makes of the truth.
void SimulatedVehicle::publish_samples_in_order(std::uint64_t mocap_sequence, bool truth_needed) {
  const bool frame_due = mocap_sequence > mocap_sequence_;
  mocap_sequence_ = mocap_sequence;
  if (truth_needed && frame_due) publish_truth();
  awaited_.reset();
  if (telemetry_path_.has_radio()) {
    if (simulation_.imu_due()) go_on_in_order();  // time waits for answers at these stamps only
  } else {
    publish_slow_samples(simulation_.samples());
    if (simulation_.imu()) publish_imu_in_order(present_samples());
  }
  if (truth_needed && !frame_due) publish_truth();
}

void SimulatedVehicle::go_on_in_order() {
  awaited_.reset();
  if (!telemetry_path_.has_radio()) return;
  const auto* packet = telemetry_path_.take(simulation_.stamp_ns());
  if (packet == nullptr) return;
  publish_slow_samples(*packet);
  publish_imu_in_order(*packet);
}

void SimulatedVehicle::publish_imu_in_order(const plant::TelemetryPacket& packet) {
  prepare_imu(packet);
  plant::LockstepInputs others;
  others.mocap_pose = mocap_sequence_;
  plant::for_each_sensor([](auto& number, const auto& sensor) { number = sensor.message.sequence_number(); },
                         others, sensors_);
  imu_message_.lockstep(messages::to_message(others));
  odometry_message_.lockstep(messages::to_message(others));
  awaited_ = packet.imu.sequence;
  publish_imu_again();
}

void SimulatedVehicle::publish_imu_again() {
  if (odometry_) {
    vehicle_odometry_.publish(odometry_message_);
  } else {
    imu_.publish(imu_message_);
  }
}

void SimulatedVehicle::publish_again() {
  plant::for_each_sensor(
      [](auto& sensor) {
        if (sensor.message.sequence_number() > 0) sensor.publisher.publish(sensor.message);
      },
      sensors_);
  ground_truth_.publish(truth_message_);
  publish_imu_again();
}

void SimulatedVehicle::publish_truth() { publish_truth(simulation_.stamp_ns()); }

void SimulatedVehicle::publish_truth(std::int64_t stamp_ns) {
  const std::uint64_t sequence = truth_message_.sequence_number() + 1;
  truth_message_ = messages::to_message(simulation_.truth());
  truth_message_.stamp_ns(stamp_ns);
  truth_message_.sequence_number(sequence);
  ground_truth_.publish(truth_message_);
}

void SimulatedVehicle::publish_slow_samples(const plant::SensorSamples& samples) {
  plant::for_each_sensor(
      [](auto& sensor, const auto& sample) {
        if (!sample) return;
        sensor.message = messages::to_message(*sample);
        sensor.publisher.publish(sensor.message);
      },
      sensors_, samples);
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
