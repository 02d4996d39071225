// swiftlet-control: the flight controller.
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include <spdlog/spdlog.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/fixed_settings.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/control/control_service.hpp"
#include "swiftlet/services/dds/discovery/peer_log.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{100};  // of the main thread

struct Options {
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  int failover_priority = 0;
  runtime::Clock clock = runtime::Clock::kRealtime;
  comms::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  app.add_option("--control", options.control, "Control settings file, or the name of one in config/control")
      .show_default();
  app.add_option("--failover-priority", options.failover_priority,
                 "When the active controller fails, the standby of the highest priority takes over")
      .range(0, 1000)
      .show_default();
  runtime::add_clock_option(app, options.clock);
  comms::add_node_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

void run(const Options& options) {
  const plant::Vehicle vehicle =
      runtime::load_vehicle(runtime::configuration_file(runtime::kinds::kVehicle, options.vehicle));
  const std::string settings_file = runtime::configuration_file(runtime::kinds::kControl, options.control);
  const control::ControlSettings settings = runtime::load_control_settings(settings_file);

  runtime::StopSignal stop;
  const runtime::Logging logging("control", options.process.log);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, options.clock);

  comms::NodeSettings node_settings = options.node;
  node_settings.name = "control";
  node_settings.deadlines = options.clock == runtime::Clock::kRealtime;
  comms::Node node(node_settings);
  comms::log_peers(node);
  ControlService service(vehicle, settings, options.failover_priority, node, realtime, options.clock,
                         runtime::load_fixed_settings(settings_file));
  spdlog::info("ready: {} with {} control, vehicle {}, domain {}, failover priority {}", vehicle.name,
               settings.name, node_settings.vehicle, node_settings.domain, options.failover_priority);

  std::atomic<bool> telemetry_ends{false};
  std::thread telemetry([&] { service.run(telemetry_ends); });
  while (!service.has_rival() && !stop.wait_for(kPollPeriod)) {
  }
  telemetry_ends = true;
  service.wake();
  telemetry.join();
  if (service.has_rival())
    throw std::runtime_error("lockstep: another controller commands this vehicle; only one is allowed");

  const Snapshot& last = service.last();
  spdlog::info(
      "ended in mode {}: {} steps at {:.1f} Hz since the rotors were last started, {} late, longest {:.0f} "
      "us",
      control::to_string(last.status.mode), last.timing.cycles, last.timing.rate_hz,
      last.timing.deadline_misses, static_cast<double>(last.timing.longest_ns) * 1e-3);
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 70;
  return runtime::run_process(
      {"swiftlet-control",
       "The flight controller: answers each IMU sample with an actuator command, executes requests.",
       "--control config/control/motor_lag.yaml --localhost-only", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
