// swiftlet-mocap: simulates motion capture.
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/vehicle_list.hpp"
#include "swiftlet/services/mocap/motion_capture_simulator.hpp"
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

struct Options {
  std::string simulation = "default";
  MotionCaptureSettings capture;
  comms::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--simulation", options.simulation, "Simulation file").show_default();
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
  comms::add_service_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

std::string frame_rate(const plant::MocapSettings& settings) {
  if (settings.model == plant::MocapModel::kOptitrack) return "at irregular intervals";
  return fmt::format("at {:g} Hz", settings.rate_hz);
}

void run(const Options& options) {
  const std::vector<std::string> names = comms::vehicles_of_list(options.node.vehicle);
  MotionCaptureSettings settings = options.capture;
  if (settings.frame_clock == FrameClock::kHost && settings.clock == runtime::Clock::kLockstep)
    throw std::invalid_argument("--frame-clock host: not with --clock lockstep");
  settings.simulation = runtime::load_simulation_settings(
      runtime::configuration_file(runtime::kinds::kSimulation, options.simulation));

  runtime::StopSignal stop;
  const runtime::Logging logging("mocap", options.process.log);
  settings.realtime = runtime::prepare_realtime(options.process.realtime, settings.clock);

  comms::NodeSettings network = options.node;
  network.announcement_period = comms::kFixturePeriod;
  network.deadlines = settings.clock == runtime::Clock::kRealtime;
  network.source_of = comms::topics::kMocapPose.name;
  comms::Participant participant(network, names);
  const comms::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string log_label = runtime::log_label_of(names[i], names.size());
    const runtime::LogLabel label(log_label);
    vehicles.push_back(std::make_unique<MotionCaptureSimulator>(participant, names[i], settings));
    ++settings.seed;
  }
  spdlog::info("ready: vehicle {}, domain {}, frames {}, seed {}", fmt::join(names, ","), network.domain,
               frame_rate(settings.simulation.mocap), options.capture.seed);
  runtime::host(std::move(vehicles), stop, kPollPeriod);
  source.check();
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 50;
  return runtime::run_process(
      {"swiftlet-mocap",
       "Simulates motion capture: receives the ground truth of simulated vehicles, publishes their poses.",
       "--seed 7 --vehicle-name kl1..kl4 --localhost-only", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
