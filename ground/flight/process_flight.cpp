#include "swiftlet/ground/flight/process_flight.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/flight_settings.hpp"
#include "swiftlet/ground/flight/network_transport.hpp"
#include "swiftlet/plant/simulation/no_effect.hpp"
#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::ground {
namespace {

void take_figures(const View& view, analysis::FlightReport& report) {
  const auto& control = view.control.message;
  report.control_rate_hz = control.rate_hz();
  report.cycles = control.cycles();
  report.deadline_misses = control.deadline_misses();
  report.step_time_max_us = control.step_time_max_us();
  report.realtime_scheduling = control.realtime_scheduling();
  const auto& vehicle = view.vehicle.message;
  if (vehicle.name().size() > 0) report.vehicle = vehicle.name().c_str();
  report.imu_rate_hz = vehicle.imu_rate_hz();
  report.unanswered = vehicle.unanswered();
  report.sense_to_actuate = {vehicle.sense_to_actuate_p50_us(), vehicle.sense_to_actuate_p99_us(),
                             vehicle.sense_to_actuate_max_us()};
}

}  // namespace

ProcessFlight::ProcessFlight(LaunchConfiguration plan, dds::NodeSettings network, ProcessGroup& processes,
                             const dds::Participant& participant, MessageRecord& messages)
    : plan_(std::move(plan)),
      network_(std::move(network)),
      report_(report_of(plan_)),
      processes_(processes),
      messages_(messages) {
  report_.vehicle_name = network_.vehicle;
  keep_settings(plan_);
  client_ = std::make_shared<Client>(participant, network_);
  messages_.on_motion(network_.vehicle,
                      [this](std::int64_t stamp_ns) { client_->has_been_recorded(stamp_ns); });
}

ProcessFlight::~ProcessFlight() { messages_.on_motion(network_.vehicle, {}); }

void ProcessFlight::finish(const std::vector<std::string>& end_errors, const std::string& record_fault,
                           const std::filesystem::path& messages, io::Progress& progress) {
  messages_.on_motion(network_.vehicle, {});
  client_.reset();
  for (const std::string& error : end_errors) {
    if (report_.reason.empty()) report_.reason = "after the flight: " + error;
  }
  report_.record_fault = record_fault;
  const record::Flight flight = flight_in(messages, network_.vehicle).value_or(record::Flight{});
  const record::Evaluation flown = record::evaluate(flight);
  judge(report_, flown);
  write_report(plan_.folder, flight, report_, flown.window.value_or(record::Window{}), progress);
}

void ProcessFlight::fly(const Interrupts& interrupts, StartBarrier* barrier, io::Progress& progress) {
  const auto start = Clock::now();
  std::optional<NetworkTransport> vehicle;
  try {
    const NetworkTransport::Watch watch{
        [this] { return processes_.exited_process(); },       [&] { return interrupts.count(); },
        [this] { return messages_.hears(network_.vehicle); }, barrier,
        plan_.launch_mode == LaunchMode::kAttached,           plan_.speed.value_or(1.0)};
    vehicle.emplace(client_, plan_.mission, plan_.clock, watch, progress);
    simulation::fly_mission(*vehicle, plan_.planned_duration_s);
    vehicle->wait_for_last_figures();
  } catch (const simulation::FlightFailure& failure) {
    report_.reason = failure.what();
    // The end of a process may be noticed after what it caused.
    const auto exited_process = processes_.exited_process();
    if (exited_process && report_.reason.find(*exited_process) == std::string::npos)
      report_.reason = *exited_process + "; " + report_.reason;
    if (barrier != nullptr) barrier->fail(network_.vehicle + " failed: " + report_.reason);
  } catch (const std::exception& error) {
    report_.reason = error.what();
    if (barrier != nullptr) barrier->fail(network_.vehicle + " failed: " + report_.reason);
    throw;
  }
  report_.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (vehicle) report_.simulated_s = vehicle->vehicle_s();
  vehicle.reset();
  if (plan_.launch_mode == LaunchMode::kStarted && !plan_.px4_instance)
    report_.warnings =
        plant::settings_without_effect(plan_.simulation, plan_.vehicle,
                                       1e-9 * static_cast<double>(client_->view().truth.message.stamp_ns()));
  take_figures(client_->view(), report_);
}

}  // namespace swiftlet::ground
