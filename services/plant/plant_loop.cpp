#include "services/plant/plant_loop.hpp"

#include <cstdio>

namespace swiftlet::services {
namespace {

using comms::topics::kActuatorCommand;
using comms::topics::kBattery;
using comms::topics::kGroundTruth;
using comms::topics::kImu;
using comms::topics::kRotorSpeeds;

constexpr std::int64_t kReportPeriodNs = 50'000'000;

}  // namespace

PlantLoop::PlantLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                     std::uint64_t seed, comms::Node& node, const runtime::RealtimeSettings& realtime)
    : simulation_(vehicle, settings, seed),
      watchdog_(vehicle.rotor_count(), static_cast<std::int64_t>(settings.command_timeout_s * 1e9)),
      step_ns_(settings.step_ns),
      imu_period_ns_(plant::period_ns(settings.imu.rate_hz)),
      realtime_(realtime),
      imu_(node.publish(kImu)),
      ground_truth_(node.publish(kGroundTruth)),
      rotor_speeds_(node.publish(kRotorSpeeds)),
      battery_(node.publish(kBattery)),
      commands_(node.subscribe<comms::msg::ActuatorCommand>(
          kActuatorCommand, [this](const auto& message) { on_command(message); }, {},
          comms::Delivery::kOwnThread)) {}

void PlantLoop::run(const std::atomic<bool>& stop) {
  if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
  runtime::PeriodicTimer timer(step_ns_, imu_period_ns_);
  publish_samples();
  while (!stop.load(std::memory_order_relaxed)) {
    const std::int64_t slipped_ns = timer.wait();
    if (slipped_ns > 0) {
      ++report_.slips;
      report_.slipped_ns += slipped_ns;
    }
    take_commands();
    step();
    publish_samples();
    report();
  }
}

// In the thread that received it.
void PlantLoop::on_command(const comms::msg::ActuatorCommand& message) {
  if (!listener_scheduled_) {
    listener_scheduled_ = true;
    if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
  }
  ReceivedCommand received;
  received.received_ns = runtime::monotonic_ns();
  received.fault = comms::from_message(message, received.command);
  received_.push(received);
}

void PlantLoop::take_commands() {
  received_.consume_all([this](const ReceivedCommand& received) {
    comms::Fault fault = received.fault;
    if (!fault) {
      const plant::CommandFault refusal = watchdog_.accept(received.command, simulation_.stamp_ns());
      if (refusal != plant::CommandFault::kNone) {
        std::snprintf(fault.text, sizeof fault.text, "%s", plant::to_string(refusal));
      }
    }
    if (fault) {
      ++report_.refused_commands;
      report_.refusal = fault;
      return;
    }
    ++report_.commands;
    answers_.answered(received.command.imu_sequence, received.received_ns);
  });
}

void PlantLoop::step() {
  const plant::RotorDrive drive = watchdog_.drive(simulation_.stamp_ns());
  const bool running = drive.state == plant::RotorState::kRunning;
  if (running && !report_.rotors_running) {
    answers_.reset();
    report_.timed_out = false;
  }
  if (!running && report_.rotors_running) report_.timed_out = watchdog_.expired(simulation_.stamp_ns());
  report_.rotors_running = running;
  simulation_.step(drive);
}

// The IMU first: the controller waits for it.
void PlantLoop::publish_samples() {
  const auto& imu = simulation_.imu();
  if (imu) {
    const comms::msg::Imu message = comms::to_message(*imu);
    if (report_.rotors_running) answers_.written(imu->sequence, runtime::monotonic_ns());
    imu_.publish(message);
    ground_truth_.publish(comms::to_message(simulation_.truth()));
  }
  if (simulation_.rotor_speeds()) rotor_speeds_.publish(comms::to_message(*simulation_.rotor_speeds()));
  if (simulation_.battery()) battery_.publish(comms::to_message(*simulation_.battery()));
}

void PlantLoop::report() {
  const bool changed = report_.rotors_running != told_running_ || report_.timed_out != told_timed_out_;
  if (!changed && simulation_.stamp_ns() - reported_ns_ < kReportPeriodNs) return;
  told_running_ = report_.rotors_running;
  told_timed_out_ = report_.timed_out;
  reported_ns_ = simulation_.stamp_ns();
  report_.stamp_ns = simulation_.stamp_ns();
  report_.answered = answers_.times().count();
  report_.unanswered = answers_.unanswered();
  report_.answer_p50_ns = answers_.times().quantile_ns(0.5);
  report_.answer_p99_ns = answers_.times().quantile_ns(0.99);
  report_.answer_max_ns = answers_.times().max_ns();
  reports_.put(report_);
}

}  // namespace swiftlet::services
