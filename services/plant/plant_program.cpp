#include "swiftlet/services/plant/plant_program.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/plant/autopilot_settings.hpp"
#include "swiftlet/services/plant/hosted_plant.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/serial_device.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

using namespace std::chrono_literals;

constexpr auto kReportPeriod = 20ms;

struct Options {
  std::string vehicle = "kaylion";
  std::string simulation = "default";
  std::uint64_t seed = 1;
  std::vector<double> start = {0.0, 0.0};  // m, north and east
  double spacing_m = 1.0;
  int per_row = 0;  // 0: all in one row
  std::string levels = "actuators";
  plant::OdometrySource odometry = plant::OdometrySource::kNone;
  int imu_rate = 0;  // Hz; 0: as in the simulation file
  std::optional<double> rotor_speed_rate_hz;
  std::optional<double> radio_delay_s, radio_jitter_s, radio_loss;
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 0.0;  // 0: real time, or in lockstep no limit
  LockstepSettings lockstep;
  std::optional<double> patience_s;
  std::string autopilot_protocol;  // empty: the control service flies
  AutopilotSettings autopilot;
  std::array<double, 2> autopilot_range{0.0, 1.0};
  dds::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_autopilot_options(runtime::CommandLine app, Options& options) {
  AutopilotSettings& autopilot = options.autopilot;
  const runtime::Option chosen =
      app.add_option(
             "--autopilot", options.autopilot_protocol,
             "An external autopilot flies the vehicle in place of swiftlet-control, by this protocol: "
             "mavlink, the simulator interface of PX4")
          .one_of({"mavlink"});
  const runtime::Option port =
      app.add_option("--autopilot-port", autopilot.port,
                     "TCP port to which the autopilot connects; of several vehicles each has the next one")
          .range(1, 65535)
          .show_default()
          .needs(chosen);
  const runtime::Option address =
      app.add_option(
             "--autopilot-address", autopilot.address,
             "IPv4 address at which the port is open; 0.0.0.0: to all networks, without any protection")
          .show_default()
          .needs(chosen);
  const runtime::Option device = app.add_option("--autopilot-device", autopilot.device,
                                                "Serial device of an autopilot in HITL mode, in place of TCP")
                                     .needs(chosen)
                                     .excludes(port)
                                     .excludes(address);
  app.add_option("--baud", autopilot.baud, "Rate of the serial device, bit/s").show_default().needs(device);
  app.add_option("--autopilot-system-id", autopilot.system_id,
                 "MAVLink system to obey; 0: the first that is heard")
      .range(0, 255)
      .show_default()
      .needs(chosen);
  app.add_option(
         "--autopilot-controls", autopilot.controls,
         "Actuator control of each rotor: px4 for PX4's numbers of a quadrotor in X, direct for control i "
         "to rotor i, or a list such as 3,1,2,4")
      .show_default()
      .needs(chosen);
  app.add_option("--autopilot-range", options.autopilot_range, "Controls at throttle 0 and at throttle 1")
      .range(-1.0, 1.0)
      .show_default("0 1")
      .needs(chosen);
  app.add_flag("--truth-only", autopilot.truth_only,
               "Publish ground_truth alone, for motion capture, with stamps of the vehicle on the network: "
               "swiftlet-px4 or another process is that")
      .needs(chosen);
  app.add_option(
         "--autopilot-timeout", autopilot.answer_timeout_s,
         "Lockstep: after this time without an answer, s, simulated time goes on at the pace of real time")
      .range(0.001, 60.0)
      .show_default()
      .needs(chosen);
}

std::string fault_of_levels(const std::string& list) {
  if (plant::control_levels_from(list)) return {};
  return "'" + list + "' is not a list of the levels actuators, rates, attitude and trajectory";
}

void add_place_options(runtime::CommandLine app, Options& options) {
  app.add_option(
         "--start", options.start,
         "Initial position on the ground, m north and m east of the origin; of several vehicles that of "
         "the first, or that of each in turn")
      .range(-1e3, 1e3);
  app.add_option("--spacing", options.spacing_m,
                 "Distance between the start positions of several vehicles, m to the east")
      .range(-100.0, 100.0)
      .show_default();
  app.add_option("--per-row", options.per_row,
                 "Number of vehicles in a row; further rows stand to the north; default: all in one row")
      .range(1, 1000);
}

void add_radio_options(runtime::CommandLine app, Options& options) {
  app.add_option("--radio-delay", options.radio_delay_s,
                 "Radio between vehicle and control: delay one way, s; default: as in the simulation file")
      .range(0.0, 0.2);
  app.add_option("--radio-jitter", options.radio_jitter_s,
                 "Radio: additional delay, uniform from 0 to this, s; default: as in the simulation file")
      .range(0.0, 0.2);
  app.add_option("--radio-loss", options.radio_loss,
                 "Radio: share of the packets that are lost; default: as in the simulation file")
      .range(0.0, 0.9);
}

void add_time_options(runtime::CommandLine app, Options& options) {
  runtime::add_clock_option(app, options.clock);
  app.add_option("--speed", options.speed,
                 "Simulation speed factor (1 = real time). In lockstep an upper limit; default: as fast as "
                 "answers arrive")
      .range(0.01, 100.0);
  app.add_option("--patience", options.patience_s,
                 "Lockstep: longest time without an answer of motion capture, control or the ground that has "
                 "answered before, s; then the flight ends; default: 2, with --security 10")
      .range(0.1, 3600.0);
  app.add_flag("--go-on", options.lockstep.goes_on,
               "Lockstep: after --patience simulated time goes on without motion capture or control, without "
               "control at a quarter of the pace of real time, until it answers again");
  app.add_flag("--paused", options.lockstep.paused, "Lockstep: advance time only up to simulation_clock");
  app.add_option(
      "--trace", options.lockstep.trace,
      "Lockstep: write every sample and command of the flight to this CSV file, without rounding; in the "
      "path, {} stands for the name of the vehicle");
}

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  app.add_option("--simulation", options.simulation, "Simulation file").show_default();
  app.add_option("--seed", options.seed,
                 "Random seed of noise, biases and gusts; of several vehicles each has the next number")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  add_place_options(app, options);
  app.add_option(
         "--level", options.levels,
         "Levels at which the vehicle accepts commands, separated by commas: actuators, rates, attitude, "
         "trajectory. At all but actuators it flies by loops of its own, as flight-control firmware does")
      .check(fault_of_levels, "LEVELS")
      .show_default();
  app.add_choice(
         "--odometry", options.odometry,
         {{"mocap", plant::OdometrySource::kMocap}, {"own", plant::OdometrySource::kOwnSensors}},
         "Bring vehicle_odometry in place of imu: mocap, the estimate of an on-board estimator on IMU and "
         "motion capture, or own, one of position sensors of its own, which drifts as the simulation file "
         "says")
      .show_default("imu");
  app.add_option("--imu-rate", options.imu_rate,
                 "IMU rate, Hz, 500 or 1000; default: as in the simulation file")
      .one_of({"500", "1000"});
  app.add_option("--rotor-speed-rate", options.rotor_speed_rate_hz,
                 "Rate of rotor speed samples, Hz; 0: none; default: as in the simulation file")
      .range(0.0, 1000.0);
  add_radio_options(app, options);
  add_time_options(app, options);
  add_autopilot_options(app, options);
  options.node.name = "plant";
  dds::add_service_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

constexpr const char* kNameInTrace = "{}";
// Motion capture and control may still authenticate each other when both have answered the plant already.
constexpr double kSecurePatienceS = 10.0;

// Throws std::invalid_argument for lockstep options without --clock lockstep, and for one trace of several vehicles.
void check(const Options& options, std::size_t vehicles) {
  const bool lockstep = options.clock == runtime::Clock::kLockstep;
  if (options.start.size() != 2 && options.start.size() != 2 * vehicles) {
    throw std::invalid_argument(fmt::format(
        "--start: has {} numbers, must have 2{}", options.start.size(),
        vehicles > 1 ? fmt::format(", or {} for {} vehicles", 2 * vehicles, vehicles) : std::string()));
  }
  if (!lockstep && options.lockstep.paused) throw std::invalid_argument("--paused: needs --clock lockstep");
  if (!lockstep && options.patience_s) throw std::invalid_argument("--patience: needs --clock lockstep");
  if (!lockstep && options.lockstep.goes_on) throw std::invalid_argument("--go-on: needs --clock lockstep");
  if (!lockstep && !options.lockstep.trace.empty())
    throw std::invalid_argument("--trace: needs --clock lockstep");
  const std::string& trace = options.lockstep.trace;
  if (vehicles > 1 && !trace.empty() && trace.find(kNameInTrace) == std::string::npos)
    throw std::invalid_argument("--trace: of several vehicles the path must contain {}");
}

// Throws std::invalid_argument for options that do not fit an autopilot.
void check_autopilot(const Options& options, std::size_t vehicles) {
  if (options.autopilot_protocol.empty()) return;
  const AutopilotSettings& autopilot = options.autopilot;
  const std::string baud_fault = runtime::fault_of_baud(autopilot.baud);
  if (!baud_fault.empty()) throw std::invalid_argument("--baud: " + baud_fault);
  if (options.lockstep.paused) throw std::invalid_argument("--paused: is not possible with --autopilot");
  if (options.patience_s || options.lockstep.goes_on)
    throw std::invalid_argument("--patience, --go-on: of an autopilot the time-out is --autopilot-timeout");
  if (autopilot.truth_only && options.clock == runtime::Clock::kLockstep && options.speed != 1.0)
    throw std::invalid_argument("--truth-only: needs real time, in lockstep --speed 1");
  if (plant::control_levels_from(options.levels) != plant::ControlLevels(plant::ControlLevel::kActuators))
    throw std::invalid_argument("--level: an autopilot commands throttles, level actuators");
  if (options.odometry != plant::OdometrySource::kNone)
    throw std::invalid_argument("--odometry: an autopilot has an estimator of its own");
  if (!autopilot.device.empty() && options.clock == runtime::Clock::kLockstep)
    throw std::invalid_argument("--autopilot-device: needs --clock realtime; a board keeps its own time");
  if (!autopilot.device.empty() && vehicles > 1)
    throw std::invalid_argument("--autopilot-device: flies one vehicle, not " + std::to_string(vehicles));
  if (autopilot.port + static_cast<int>(vehicles) - 1 > 65535)
    throw std::invalid_argument("--autopilot-port: leaves no ports for " + std::to_string(vehicles) +
                                " vehicles");
}

std::string trace_of(const std::string& vehicle, std::string path) {
  const std::size_t length = std::string_view(kNameInTrace).size();
  for (std::size_t at = path.find(kNameInTrace); at != std::string::npos;
       at = path.find(kNameInTrace, at + vehicle.size()))
    path.replace(at, length, vehicle);
  return path;
}

// Throws as the loaders do, and std::invalid_argument.
PlantSettings load(const Options& options) {
  PlantSettings settings;
  settings.vehicle = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  settings.simulation =
      io::load_simulation_settings(io::configuration_file(io::kinds::kSimulation, options.simulation));
  settings.simulation.control_levels = plant::control_levels_from(options.levels).value();
  settings.simulation.odometry.source = options.odometry;
  if (options.imu_rate != 0) settings.simulation.imu.rate_hz = options.imu_rate;
  if (options.rotor_speed_rate_hz) settings.simulation.rotor_speed_rate_hz = *options.rotor_speed_rate_hz;
  plant::RadioSettings& radio = settings.simulation.radio;
  radio.delay_s = options.radio_delay_s.value_or(radio.delay_s);
  radio.jitter_s = options.radio_jitter_s.value_or(radio.jitter_s);
  radio.loss = options.radio_loss.value_or(radio.loss);
  if (radio.on() && !options.autopilot_protocol.empty())
    throw std::invalid_argument("--autopilot: the simulated radio is between a vehicle and control");
  for (const plant::Violation& violation : plant::validate(settings.simulation)) {
    const char* const option =
        violation.key == "rotor_speed_rate_hz" ? "--rotor-speed-rate: " : "--imu-rate: ";
    throw std::invalid_argument(option + violation.key + " " + violation.message);
  }
  for (const plant::Violation& violation :
       plant::validate_faults(settings.simulation.faults, settings.vehicle)) {
    throw std::invalid_argument(options.simulation + ": " + violation.key + ": " + violation.message);
  }
  settings.clock = options.clock;
  settings.speed = options.speed;
  settings.lockstep = options.lockstep;
  if (!options.autopilot_protocol.empty()) {
    settings.autopilot = options.autopilot;
    settings.autopilot->control_at_zero = options.autopilot_range[0];
    settings.autopilot->control_at_full = options.autopilot_range[1];
  }
  if (!options.node.security.empty()) settings.lockstep.patience_s = kSecurePatienceS;
  if (options.patience_s) settings.lockstep.patience_s = *options.patience_s;
  return settings;
}

// m, north and east, of the i-th of several vehicles.
Eigen::Vector2d place_in_rows(std::size_t i, const Options& options) {
  const std::size_t row = options.per_row > 0 ? i / static_cast<std::size_t>(options.per_row) : 0;
  const std::size_t column = i - row * static_cast<std::size_t>(options.per_row);
  return {options.start[0] + static_cast<double>(row) * options.spacing_m,
          options.start[1] + static_cast<double>(column) * options.spacing_m};
}

// The settings of the i-th vehicle.
PlantSettings settings_of(const std::vector<std::string>& names, std::size_t i, const Options& options,
                          PlantSettings settings) {
  settings.seed = options.seed + i;
  if (options.start.size() > 2) {
    settings.initial.position_ned.head<2>() = Eigen::Vector2d(options.start[2 * i], options.start[2 * i + 1]);
  } else {
    settings.initial.position_ned.head<2>() = place_in_rows(i, options);
  }
  settings.lockstep.trace = trace_of(names[i], options.lockstep.trace);
  if (settings.autopilot) settings.autopilot->port += static_cast<int>(i);
  return settings;
}

void run(const Options& options) {
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  PlantSettings settings = load(options);
  check(options, names.size());
  check_autopilot(options, names.size());

  runtime::StopSignal stop;
  const runtime::Logging logging("plant", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, options.clock);

  dds::NodeSettings network = options.node;
  network.announcement_period = messages::kFixturePeriod;
  network.hears_of_all = false;
  network.realtime_priority = settings.realtime.thread_priority();
  network.source_of =
      options.autopilot.truth_only ? messages::topics::kGroundTruth.name : messages::topics::kImu.name;
  dds::Participant participant(network, names);
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  RealtimeLoop loop(settings.realtime);
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string log_label = runtime::log_label_of(names[i], names.size());
    const runtime::LogLabel label(log_label);
    vehicles.push_back(
        std::make_unique<HostedPlant>(participant, names[i], settings_of(names, i, options, settings), loop));
  }
  dds::log_reach(network);
  runtime::log_info("ready: {}, vehicle {}, domain {}, clock {}, IMU at {:g} Hz, seed {}{}",
                    settings.vehicle.name, fmt::join(names, ","), network.domain,
                    runtime::to_string(options.clock), settings.simulation.imu.rate_hz, options.seed,
                    settings.autopilot ? ", flown by " + settings.autopilot->description() : "");
  runtime::host(std::move(vehicles), stop, kReportPeriod);
  source.check();
}

}  // namespace

int run_plant(int argc, char** argv) {
  Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"swiftlet-plant",
       "Simulates one or several quadrotors on the network: publishes sensor samples, obeys actuator "
       "commands.",
       "--vehicle config/vehicles/kaylion.yaml --vehicle-name kl1..kl4", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { add_options(app, options); }, [&] { run(options); });
}

}  // namespace swiftlet::services
