// swiftlet-mocap: simulates motion capture. Receives ground truth, publishes poses. Uses the samples' stamps
// only, no clock.
#include <atomic>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/services/dds/discovery/peer_log.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

struct Options {
  std::string simulation = "default";
  std::uint64_t seed = 1;
  runtime::Clock clock = runtime::Clock::kRealtime;
  comms::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--simulation", options.simulation, "Simulation file").show_default();
  app.add_option("--seed", options.seed, "Random seed of pose errors and dropouts")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  runtime::add_clock_option(app, options.clock);
  comms::add_node_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

// Runs in the thread that receives ground_truth.
class MotionCaptureSimulator {
 public:
  MotionCaptureSimulator(const plant::SimulationSettings& settings, std::uint64_t seed, comms::Node& node,
                         const runtime::RealtimeSettings& realtime, runtime::Clock clock,
                         runtime::StopSignal& stop)
      : mocap_(settings.mocap, seed),
        path_(settings, seed),
        realtime_(realtime),
        clock_(clock),
        stop_(stop),
        poses_(node.publish(comms::topics::kMocapPose)),
        truth_(node.subscribe<comms::msg::GroundTruth>(
            comms::topics::kGroundTruth, [this](const auto& message) { on_truth(message); },
            comms::Delivery::kOwnThread, comms::kSourceSilence)) {}

  std::uint64_t frames() const { return frames_; }
  std::uint64_t untracked() const { return untracked_; }
  // Lockstep: true if a sample of the ground truth was lost; its frame cannot be made.
  bool lost_truth() const { return lost_truth_; }

 private:
  void on_truth(const comms::msg::GroundTruth& message) {
    thread_.enter(realtime_);
    plant::TruthSample truth;
    const comms::Fault fault = comms::from_message(message, truth);
    if (fault) {
      if (!logged_fault_) spdlog::warn("ground truth refused: {}", fault.text);
      logged_fault_ = true;
      return;
    }
    if (clock_ == runtime::Clock::kLockstep && !is_next(truth)) return;
    const auto pose = path_.pass(mocap_.update(truth), truth.stamp_ns);
    made_frame_ = pose.has_value();
    if (!pose) {
      if (clock_ == runtime::Clock::kLockstep) publish_heartbeat(truth.stamp_ns);
      return;
    }
    last_pose_ = comms::to_message(*pose);
    poses_.publish(last_pose_);
    frames_.fetch_add(1, std::memory_order_relaxed);
    if (!pose->tracked) untracked_.fetch_add(1, std::memory_order_relaxed);
  }

  // Lockstep: returns true for the next sample in sequence. Answers a repeated sample again. Stops the
  // process at a gap.
  bool is_next(const plant::TruthSample& truth) {
    if (truth.sequence <= truth_sequence_) {
      answer_again(truth.stamp_ns);
      return false;
    }
    if (truth.sequence != truth_sequence_ + 1) {
      lost_truth_ = true;
      stop_.request();
      return false;
    }
    truth_sequence_ = truth.sequence;
    return true;
  }

  // Repeats the last frame for control and the heartbeat for the plant, alternately: of two messages sent at
  // once the first may be lost.
  void answer_again(std::int64_t stamp_ns) {
    heartbeat_is_next_ = !heartbeat_is_next_;
    if (made_frame_ || (last_pose_.sequence_number() > 0 && !heartbeat_is_next_)) {
      poses_.publish(last_pose_);
    } else {
      publish_heartbeat(stamp_ns);
    }
  }

  // A pose with sequence 0: the truth up to this stamp has arrived and its frames have been published.
  void publish_heartbeat(std::int64_t stamp_ns) {
    comms::msg::MocapPose heartbeat;
    heartbeat.stamp_ns(stamp_ns);
    poses_.publish(heartbeat);
  }

  plant::Mocap mocap_;
  plant::MocapPath path_;
  runtime::RealtimeSettings realtime_;
  runtime::Clock clock_;
  runtime::StopSignal& stop_;
  std::uint64_t truth_sequence_ = 0;
  comms::msg::MocapPose last_pose_;  // sequence 0 before the first frame
  bool made_frame_ = false;          // of the newest truth
  bool heartbeat_is_next_ = false;
  std::atomic<bool> lost_truth_{false};
  runtime::RealtimeThread thread_;
  bool logged_fault_ = false;
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> untracked_{0};
  comms::Publisher<comms::msg::MocapPose> poses_;
  comms::Subscription truth_;  // last: its callback uses all members above
};

std::string frame_rate(const plant::MocapSettings& settings) {
  if (settings.model == plant::MocapModel::kOptitrack) return "at irregular intervals";
  return fmt::format("at {:g} Hz", settings.rate_hz);
}

void run(const Options& options) {
  const plant::SimulationSettings settings = runtime::load_simulation_settings(
      runtime::configuration_file(runtime::kinds::kSimulation, options.simulation));

  runtime::StopSignal stop;
  const runtime::Logging logging("mocap", options.process.log);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, options.clock);

  comms::NodeSettings node_settings = options.node;
  node_settings.name = "mocap";
  node_settings.announcement_period = comms::kFixturePeriod;
  node_settings.deadlines = options.clock == runtime::Clock::kRealtime;
  node_settings.source_of = comms::topics::kMocapPose.name;
  comms::Node node(node_settings);
  comms::log_peers(node);
  const comms::SoleSource source(node, [&stop] { stop.request(); });
  const MotionCaptureSimulator simulator(settings, options.seed, node, realtime, options.clock, stop);
  spdlog::info("ready: vehicle {}, domain {}, frames {}, seed {}", node_settings.vehicle,
               node_settings.domain, frame_rate(settings.mocap), options.seed);
  stop.wait();
  source.check();
  if (simulator.lost_truth()) throw std::runtime_error("lockstep: a ground_truth sample was lost");
  spdlog::info("ended: {} frames, {} untracked", simulator.frames(), simulator.untracked());
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 50;
  return runtime::run_process(
      {"swiftlet-mocap",
       "Simulates motion capture: receives the ground truth of a simulated vehicle, publishes its pose.",
       "--seed 7 --localhost-only", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
