#include "swiftlet/services/control/control_program.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/fixed_settings.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/control/flown_files.hpp"
#include "swiftlet/services/control/hosted_control.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
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
  std::optional<plant::ControlLevel> level;
  runtime::Clock clock = runtime::Clock::kRealtime;
  dds::NodeSettings node;
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
  using plant::ControlLevel;
  app.add_choice<std::optional<ControlLevel>>("--level", options.level,
                                              {{"actuators", ControlLevel::kActuators},
                                               {"rates", ControlLevel::kRates},
                                               {"attitude", ControlLevel::kAttitude},
                                               {"trajectory", ControlLevel::kTrajectory}},
                                              "Level at which the vehicle is commanded: throttles, body "
                                              "rates, attitude, or the trajectory itself; default: the "
                                              "first of these that the vehicle accepts");
  runtime::add_clock_option(app, options.clock);
  options.node.name = "control";
  dds::add_service_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

void run(const Options& options) {
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  ControllerSettings settings;
  const std::string vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  settings.vehicle = io::load_vehicle(vehicle_file);
  const std::string settings_file = io::configuration_file(io::kinds::kControl, options.control);
  settings.control = io::load_control_settings(settings_file);
  settings.fixed = io::load_fixed_settings(settings_file);
  settings.files =
      flown_files(std::string("swiftlet-control ") + runtime::version_text(), vehicle_file, settings_file);
  settings.failover_priority = options.failover_priority;
  settings.level = options.level;
  settings.clock = options.clock;

  runtime::StopSignal stop;
  const runtime::Logging logging("control", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, options.clock);

  dds::NodeSettings network = options.node;
  network.hears_of_all = false;
  network.realtime_priority = settings.realtime.thread_priority();
  const dds::Participant participant(network, names);
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (const std::string& name : names) {
    const std::string log_label = runtime::log_label_of(name, names.size());
    const runtime::LogLabel label(log_label);
    vehicles.push_back(std::make_unique<HostedControl>(participant, name, settings));
  }
  dds::log_reach(network);
  runtime::log_info("ready: {} with {} control, vehicle {}, domain {}, failover priority {}",
                    settings.vehicle.name, settings.control.name, fmt::join(names, ","), network.domain,
                    options.failover_priority);
  runtime::host(std::move(vehicles), stop, kPollPeriod);
}

}  // namespace

int run_control(int argc, char** argv) {
  Options options;
  options.process.realtime.priority = 70;
  return runtime::run_process(
      {"swiftlet-control",
       "The flight controller of one or several vehicles: answers each IMU sample with an actuator command, "
       "executes requests.",
       "--control config/control/motor_lag.yaml --vehicle-name kl1..kl4", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { add_options(app, options); }, [&] { run(options); });
}

}  // namespace swiftlet::services
