#include "swiftlet/services/mocap/mocap_program.hpp"

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/mocap/captured_vehicle.hpp"
#include "swiftlet/services/mocap/frame_thread.hpp"
#include "swiftlet/services/mocap/motion_capture_simulator.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/mocap/sources/source_options.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{20};  // of the main thread
constexpr const char* kSimulation = "simulation";

struct Options {
  mocap::SourceOptions source;
  std::string simulation = "default";
  MotionCaptureSettings capture;
  dds::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  mocap::add_source_options(app, options.source, {kSimulation});
  app.add_option("--simulation", options.simulation, "Simulation file of --source simulation").show_default();
  app.add_option("--seed", options.capture.seed,
                 "Random seed of pose errors and dropouts; of several vehicles each has the next number")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  runtime::add_clock_option(app, options.capture.clock);
  app.add_choice("--frame-clock", options.capture.frame_clock,
                 {{"vehicle", FrameClock::kVehicle}, {"host", FrameClock::kHost}},
                 "Clock that stamps the frames: vehicle, or host: the system clock of this host, as cameras "
                 "do; the stamps are then translated to the vehicle's clock")
      .show_default("vehicle");
  options.node.name = "mocap";
  dds::add_service_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

std::string frame_rate(const plant::MocapSettings& settings) {
  if (settings.model == plant::MocapModel::kOptitrack) return "at irregular intervals";
  return fmt::format("at {:g} Hz", settings.rate_hz);
}

bool is_simulated(const mocap::SourceOptions& source) {
  return source.source == kSimulation || (source.source.empty() && source.room.empty());
}

void check_simulation(const Options& options) {
  const mocap::SourceOptions& source = options.source;
  for (const auto& [name, value] : {std::pair{"--room", &source.room}, std::pair{"--server", &source.server},
                                    std::pair{"--mocap-interface", &source.interface},
                                    std::pair{"--frame", &source.frame}, std::pair{"--file", &source.file}}) {
    if (!value->empty()) throw std::invalid_argument(std::string(name) + ": not with --source simulation");
  }
  if (options.capture.frame_clock == FrameClock::kHost && options.capture.clock == runtime::Clock::kLockstep)
    throw std::invalid_argument("--frame-clock host: not with --clock lockstep");
}

dds::NodeSettings network_of(const Options& options, const runtime::RealtimeSettings& realtime) {
  dds::NodeSettings network = options.node;
  network.announcement_period = messages::kFixturePeriod;
  network.hears_of_all = false;
  network.realtime_priority = realtime.thread_priority();
  network.source_of = messages::topics::kMocapPose.name;
  return network;
}

void simulate(const Options& options) {
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  check_simulation(options);
  MotionCaptureSettings settings = options.capture;
  settings.simulation =
      io::load_simulation_settings(io::configuration_file(io::kinds::kSimulation, options.simulation));

  runtime::StopSignal stop;
  const runtime::Logging logging("mocap", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, settings.clock);

  const dds::NodeSettings network = network_of(options, settings.realtime);
  dds::Participant participant(network, names);
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string log_label = runtime::log_label_of(names[i], names.size());
    const runtime::LogLabel label(log_label);
    vehicles.push_back(std::make_unique<MotionCaptureSimulator>(participant, names[i], settings));
    ++settings.seed;
  }
  dds::log_reach(network);
  runtime::log_info("ready: vehicle {}, domain {}, frames {}, seed {}", fmt::join(names, ","), network.domain,
                    frame_rate(settings.simulation.mocap), options.capture.seed);
  runtime::host(std::move(vehicles), stop, kPollPeriod);
  source.check();
}

void check_capture(const Options& options) {
  if (options.capture.clock == runtime::Clock::kLockstep)
    throw std::invalid_argument("--clock lockstep: only with --source simulation");
  if (options.capture.frame_clock == FrameClock::kHost)
    throw std::invalid_argument("--frame-clock host: only with --source simulation");
  if (options.source.room.empty() && options.source.frame.empty())
    throw std::invalid_argument(
        "--frame is required without --room: zup or yup, as the motion capture is set");
}

void log_end(const mocap::Source& source) {
  const mocap::SourceStatistics& statistics = source.statistics();
  runtime::log_info(
      "motion capture ended: {}: {} frames, {} lost, {} late, {} refused{}, {} of other servers, {} restarts",
      source.description(), statistics.frames, statistics.lost, statistics.late, statistics.refused,
      statistics.last_refusal.empty() ? "" : " (" + statistics.last_refusal + ")", statistics.strangers,
      statistics.restarts);
}

void capture(const Options& options) {
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  check_capture(options);
  const mocap::Room room = mocap::room_of(options.source, names);

  runtime::StopSignal stop;
  const runtime::Logging logging("mocap", options.process.log);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);
  FrameThread frames(mocap::open_source(room), realtime, [&stop] { stop.request(); });

  const dds::NodeSettings network = network_of(options, realtime);
  dds::Participant participant(network, names);
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (const std::string& name : names)
    vehicles.push_back(std::make_unique<CapturedVehicle>(participant, *mocap::find(room, name),
                                                         mocap::RoomFrame(room), frames));
  dds::log_reach(network);
  runtime::log_info("ready: vehicle {}, domain {}, source {}", fmt::join(names, ","), network.domain,
                    mocap::to_string(room.source));
  frames.start();
  runtime::host(std::move(vehicles), stop, kPollPeriod);
  frames.stop();
  log_end(frames.source());
  source.check();
}

void run(const Options& options) {
  if (is_simulated(options.source)) {
    simulate(options);
  } else {
    capture(options);
  }
}

}  // namespace

int run_mocap(int argc, char** argv) {
  Options options;
  options.process.realtime.priority = 50;
  return runtime::run_process(
      {"swiftlet-mocap",
       "Publishes the poses of vehicles: those of a motion capture, or those that a simulated one makes of "
       "the ground "
       "truth of simulated vehicles.",
       "--source natnet --frame yup --vehicle-name kl1..kl4", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { add_options(app, options); }, [&] { run(options); });
}

}  // namespace swiftlet::services
