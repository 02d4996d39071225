// swiftlet-px4: joins vehicles with PX4 to the network, over PX4's uXRCE-DDS client and agent. docs/px4.md is its manual.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/px4/parameters.hpp"
#include "swiftlet/services/px4/px4_bridge.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::px4 {
namespace {

constexpr std::chrono::milliseconds kReportPeriod{20};
constexpr double kLeastVisionRate_hz = 10.0;

struct Options {
  std::string vehicle = "kaylion";
  std::string levels = "rates,attitude,trajectory";
  BridgeSettings bridge;
  bool check_parameters = false;
  bool set_parameters = false;
  bool has_remote_control = false;
  std::string mavlink_host = "127.0.0.1";
  dds::NodeSettings node;
  runtime::ProcessOptions process;
};

// PX4's ports of its link to an onboard computer, for instance 0.
constexpr int kPx4Port = 14580;
constexpr int kOwnPort = 14540;

void add_vision_options(runtime::CommandLine app, VisionSettings& vision) {
  app.add_option(
         "--vision-rate", vision.rate_hz,
         "Most poses of motion capture sent to PX4, Hz, 10 to 200; 0: none, to PX4 with sensors of its own")
      .range(0.0, 200.0)
      .show_default();
  app.add_choice(
         "--vision-stamps", vision.stamps, {{"now", VisionStamps::kNow}, {"agent", VisionStamps::kAgent}},
         "Stamps of these poses: now, PX4 takes their arrival, or agent: the time of their exposure by the "
         "system clock, for an agent on this host")
      .show_default("now");
  app.add_option("--vision-position-deviation", vision.deviation.position_m,
                 "Standard deviation of their position, m")
      .range(1e-4, 1.0)
      .show_default();
  app.add_option("--vision-attitude-deviation", vision.deviation.attitude_rad,
                 "Standard deviation of their attitude, rad")
      .range(1e-4, 1.0)
      .show_default();
}

void add_parameter_options(runtime::CommandLine app, Options& options) {
  app.add_flag("--check-parameters", options.check_parameters,
               "List the parameters of PX4 that flights with Swiftlet need, read over MAVLink from UDP port "
               "14580 + N, and "
               "end; exit code 1 if one differs");
  app.add_flag("--set-parameters", options.set_parameters, "The same, and set those that differ");
  app.add_flag("--remote-control", options.has_remote_control,
               "With these: a pilot has a remote control, whose absence stays a failsafe");
  app.add_option("--mavlink-host", options.mavlink_host, "With these: IPv4 address of PX4").show_default();
}

void add_options(runtime::CommandLine app, Options& options) {
  BridgeSettings& bridge = options.bridge;
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  app.add_option("--instance", bridge.instance,
                 "Instance of PX4: its topics are in the namespace px4_N, those of 0 in none; of several "
                 "vehicles each "
                 "has the next one")
      .range(0, 254)
      .show_default();
  app.add_option(
         "--namespace-prefix", bridge.namespace_prefix,
         "The namespace of each instance is this and its number: uav_ for a PX4 with UXRCE_DDS_NS_IDX")
      .check(messages::fault_of_vehicle_name, "NAME");
  app.add_option(
         "--levels", options.levels,
         "Levels at which control may command, a list of rates, attitude, trajectory; without --level "
         "of swiftlet-control it takes the first of them")
      .check(
          [](const std::string& list) {
            const auto levels = plant::control_levels_from(list);
            const bool is_valid = levels && !levels->has(plant::ControlLevel::kActuators);
            return is_valid ? std::string() : "must be a list of rates, attitude, trajectory";
          },
          "LEVELS")
      .show_default();
  app.add_choice(
         "--samples", bridge.samples, {{"imu", Samples::kImu}, {"odometry", Samples::kOdometry}},
         "What control is sent: imu, PX4's sensor_combined, or odometry: PX4's own estimate, its "
         "vehicle_odometry, in its place; by which estimate control then flies is a setting of its file")
      .show_default("imu");
  app.add_option("--hover-throttle", bridge.hover_throttle,
                 "PX4's throttle of hover to begin with, its MPC_THR_HOVER; otherwise that of the vehicle "
                 "file. It is "
                 "learnt in flight")
      .range(0.05, 0.95);
  app.add_option("--control-silence", bridge.control_silence_s,
                 "Time without a command of control after which PX4 is told to land, s")
      .range(0.1, 1.0)
      .show_default();
  add_vision_options(app, bridge.vision);
  add_parameter_options(app, options);
  options.node.name = "px4";
  dds::add_service_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

// Throws std::runtime_error if a parameter differs.
void check_parameters(const Options& options) {
  const int instance = options.bridge.instance;
  ParameterClient client(options.mavlink_host, kPx4Port + instance, kOwnPort + instance,
                         static_cast<std::uint8_t>(instance + 1));
  const std::vector<ParameterCheck> checks =
      check_parameters(client, required_parameters(options.has_remote_control), options.set_parameters);
  fmt::print("{}", table_of(checks));
  const auto differ = std::count_if(checks.begin(), checks.end(), [](const ParameterCheck& check) {
    return check.found && !check.holds();
  });
  const auto silent =
      std::count_if(checks.begin(), checks.end(), [](const ParameterCheck& check) { return !check.found; });
  if (silent > 0)
    throw std::runtime_error(fmt::format("PX4 did not answer for {} parameters, at {} port {}", silent,
                                         options.mavlink_host, kPx4Port + instance));
  if (differ > 0)
    throw std::runtime_error(fmt::format("{} parameters of PX4 differ{}", differ,
                                         options.set_parameters ? "" : "; --set-parameters sets them"));
}

void run(const Options& options) {
  if (options.check_parameters || options.set_parameters) return check_parameters(options);
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  BridgeSettings settings = options.bridge;
  if (const double rate_hz = settings.vision.rate_hz; rate_hz > 0.0 && rate_hz < kLeastVisionRate_hz)
    throw std::invalid_argument(fmt::format("--vision-rate: is {:g}, must be 0, or 10 to 200", rate_hz));
  settings.vehicle = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  settings.levels = *plant::control_levels_from(options.levels);

  runtime::StopSignal stop;
  const runtime::Logging logging("px4", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);

  dds::NodeSettings network = options.node;
  network.announcement_period = messages::kFixturePeriod;
  network.realtime_priority = settings.realtime.thread_priority();
  network.source_of = messages::topics::kImu.name;
  dds::Participant participant(network, names);
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  const int first_instance = settings.instance;
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (const std::string& name : names) {
    const std::string log_label = runtime::log_label_of(name, names.size());
    const runtime::LogLabel label(log_label);
    vehicles.push_back(std::make_unique<Px4Bridge>(participant, name, settings));
    ++settings.instance;
  }
  dds::log_reach(network);
  runtime::log_info("ready: vehicle {} in domain {}, PX4 instance {}, topics rt{}", fmt::join(names, ","),
                    network.domain, first_instance, topic_folder(first_instance, settings.namespace_prefix));
  runtime::host(std::move(vehicles), stop, kReportPeriod);
  source.check();
}

}  // namespace
}  // namespace swiftlet::px4

int main(int argc, char** argv) {
  using namespace swiftlet;
  px4::Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"swiftlet-px4",
       "Joins vehicles with PX4 to the network, over PX4's uXRCE-DDS agent: passes its samples to the "
       "control service, "
       "and setpoints, commands and poses of motion capture to PX4.",
       "--instance 0 --vehicle kaylion --levels trajectory", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { px4::add_options(app, options); },
      [&] { px4::run(options); });
}
