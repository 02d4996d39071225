// swiftlet-microcontroller: the simulated far end of a vehicle process's link.
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/microcontroller/microcontroller.hpp"
#include "swiftlet/services/microcontroller/port.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

constexpr std::chrono::milliseconds kReportPeriod{20};

struct Options {
  std::string pty;
  std::string udp;
  std::string vehicle = "kaylion";
  std::string simulation = "default";
  std::uint64_t seed = 1;
  std::array<double, 2> start{};  // m, north and east
  int imu_rate = 0;               // Hz; 0: as in the simulation file
  MicrocontrollerClock clock;
  double speed = 1.0;
  double command_timeout_s = 0.1;
  double patience_s = 0.0;
  dds::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  auto pty =
      app.add_option("--pty", options.pty,
                     "Link: a pseudo-terminal; this path becomes a link to the device that the host opens");
  app.add_option("--udp", options.udp, "Link: a UDP port of this computer, HOST:PORT").excludes(pty);
  app.add_option("--clock-offset", options.clock.offset_s, "Microcontroller's clock at the start, s")
      .range(0.0, 1e9)
      .show_default();
  app.add_option("--clock-drift", options.clock.drift_ppm,
                 "Microcontroller's clock against that of this computer, us per s; above 0: fast")
      .range(-10'000.0, 10'000.0)
      .show_default();
  app.add_option("--speed", options.speed,
                 "Simulation speed factor (1 = real time). At another speed the host cannot learn the "
                 "microcontroller's clock, and measures no times of the link")
      .range(0.01, 100.0)
      .show_default();
  app.add_option("--command-timeout", options.command_timeout_s,
                 "The microcontroller stops the rotors after this time without a valid command, s")
      .range(0.01, 10.0)
      .show_default();
  app.add_option(
         "--patience", options.patience_s,
         "While the rotors run, let time stand still until a sample is answered, at most this long, s: for "
         "a computer that is too busy for real time")
      .range(0.0, 10.0)
      .show_default();
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  app.add_option("--simulation", options.simulation, "Simulation file").show_default();
  app.add_option("--seed", options.seed, "Random seed of noise, biases and gusts")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  app.add_option("--start", options.start, "Initial position on the ground, m north and m east of the origin")
      .range(-1e3, 1e3);
  app.add_option("--imu-rate", options.imu_rate,
                 "IMU rate, Hz, 500 or 1000; default: as in the simulation file")
      .one_of({"500", "1000"});
  options.node.name = "microcontroller";
  dds::add_node_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

// Throws as the loaders do, and std::invalid_argument.
MicrocontrollerSettings load(const Options& options) {
  MicrocontrollerSettings settings;
  settings.vehicle = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  settings.simulation =
      io::load_simulation_settings(io::configuration_file(io::kinds::kSimulation, options.simulation));
  if (options.imu_rate != 0) settings.simulation.imu.rate_hz = options.imu_rate;
  if (settings.simulation.radio.on())
    throw std::invalid_argument(options.simulation + ": radio: swiftlet-plant alone simulates one");
  for (const plant::Violation& violation : plant::validate(settings.simulation))
    throw std::invalid_argument("--imu-rate: " + violation.key + " " + violation.message);
  for (const plant::Violation& violation :
       plant::validate_faults(settings.simulation.faults, settings.vehicle))
    throw std::invalid_argument(options.simulation + ": " + violation.key + ": " + violation.message);
  settings.seed = options.seed;
  settings.initial.position_ned.head<2>() = Eigen::Vector2d(options.start[0], options.start[1]);
  settings.clock = options.clock;
  settings.speed = options.speed;
  settings.patience_s = options.patience_s;
  settings.firmware.boot = std::random_device{}();
  settings.firmware.rotor_count = settings.vehicle.rotor_count();
  settings.firmware.imu_rate_hz = settings.simulation.imu.rate_hz;
  settings.firmware.command_timeout_s = options.command_timeout_s;
  return settings;
}

std::unique_ptr<Port> open_port(const Options& options) {
  if (!options.pty.empty()) return open_pseudo_terminal(options.pty);
  if (!options.udp.empty()) return open_udp_port(options.udp);
  throw std::invalid_argument("no link: give --pty PATH or --udp HOST:PORT");
}

void run(const Options& options) {
  MicrocontrollerSettings settings = load(options);
  std::unique_ptr<Port> port = open_port(options);
  runtime::StopSignal stop;
  const runtime::Logging logging("microcontroller", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);

  dds::NodeSettings network = options.node;
  network.hears_of_all = false;
  network.announcement_period = messages::kFixturePeriod;
  network.realtime_priority = settings.realtime.thread_priority();
  network.source_of = messages::topics::kGroundTruth.name;
  dds::Participant participant(network, {network.vehicle});
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  vehicles.push_back(
      std::make_unique<Microcontroller>(participant, network.vehicle, settings, std::move(port)));
  dds::log_reach(network);
  runtime::log_info(
      "ready: {}, link {}, IMU at {:g} Hz, command time-out {:g} s; ground_truth of {} in domain {}",
      settings.vehicle.name, options.pty.empty() ? options.udp : options.pty, settings.simulation.imu.rate_hz,
      options.command_timeout_s, network.vehicle, network.domain);
  runtime::host(std::move(vehicles), stop, kReportPeriod);
  source.check();
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"swiftlet-microcontroller",
       "Simulates the microcontroller of a vehicle, the far end of the link of swiftlet-vehicle-template, "
       "and "
       "the room that it flies in, whose ground_truth the simulated motion capture sees.",
       "--pty /tmp/kl1.tty --clock-offset 1000 --clock-drift 50", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
