#include "swiftlet/services/mocap/motion_capture_simulator.hpp"

#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {

MotionCaptureSimulator::MotionCaptureSimulator(const dds::Participant& participant,
                                               const std::string& vehicle,
                                               const MotionCaptureSettings& settings)
    : HostedVehicle(vehicle),
      node_(participant, vehicle, [this](const std::string& fault) { fail(fault); }),
      mocap_(settings.simulation.mocap, settings.seed),
      path_(settings.simulation, settings.seed),
      realtime_(settings.realtime),
      clock_(settings.clock),
      poses_(node_.publish(messages::topics::kMocapPose)) {
  if (settings.frame_clock == FrameClock::kHost) host_clock_.emplace(node_, runtime::system_ns);
  dds::log_peers(node_);
  truth_ = node_.subscribe<messages::msg::GroundTruth>(
      messages::topics::kGroundTruth, [this](const auto& message) { on_truth(message); },
      dds::Delivery::kSamples, dds::OneSource{dds::kSourceSilence});
}

void MotionCaptureSimulator::log_end() {
  const std::uint64_t withheld = withheld_.load();
  runtime::log_info(
      "ended: {} frames, {} untracked{}", frames_.load(), untracked_.load(),
      withheld == 0 ? "" : fmt::format(", {} withheld: the vehicle's clock was unknown", withheld));
}

void MotionCaptureSimulator::on_truth(const messages::msg::GroundTruth& message) {
  const std::int64_t arrived_ns = runtime::system_ns();
  thread_.enter(realtime_);
  if (host_clock_) host_clock_->ask_if_due();
  plant::TruthSample truth;
  const messages::Fault fault = messages::from_message(message, truth);
  if (fault) {
    if (!logged_fault_) runtime::log_warning("ground truth refused: {}", fault.text);
    logged_fault_ = true;
    return;
  }
  if (clock_ == runtime::Clock::kLockstep && !is_next(truth)) return;
  auto pose = path_.pass(mocap_.update(truth), truth.stamp_ns);
  made_frame_ = pose.has_value();
  if (!pose) {
    if (clock_ == runtime::Clock::kLockstep) publish_heartbeat(truth.stamp_ns);
    return;
  }
  if (host_clock_ && !stamp_by_host(*pose, truth.stamp_ns, arrived_ns)) {
    withheld_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  last_pose_ = messages::to_message(*pose);
  poses_.publish(last_pose_);
  frames_.fetch_add(1, std::memory_order_relaxed);
  if (!pose->tracked) untracked_.fetch_add(1, std::memory_order_relaxed);
}

bool MotionCaptureSimulator::stamp_by_host(plant::PoseSample& pose, std::int64_t truth_stamp_ns,
                                           std::int64_t arrived_ns) {
  const std::int64_t exposed_ns = arrived_ns - (truth_stamp_ns - pose.stamp_ns);
  const std::optional<std::int64_t> stamp_ns = host_clock_->to_vehicle(exposed_ns);
  if (!stamp_ns) return false;
  pose.stamp_ns = *stamp_ns;
  return true;
}

// Lockstep: returns true for the next sample in sequence. Answers a repeated sample again. Fails at a gap.
bool MotionCaptureSimulator::is_next(const plant::TruthSample& truth) {
  if (truth.sequence <= truth_sequence_) {
    answer_again(truth.stamp_ns);
    return false;
  }
  if (truth.sequence != truth_sequence_ + 1) {
    fail("lockstep: a ground_truth sample was lost");
    return false;
  }
  truth_sequence_ = truth.sequence;
  return true;
}

// Repeats the last frame for control and the heartbeat for the plant, alternately: of two messages sent at
// once the first may be lost.
void MotionCaptureSimulator::answer_again(std::int64_t stamp_ns) {
  heartbeat_is_next_ = !heartbeat_is_next_;
  if (made_frame_ || (last_pose_.sequence_number() > 0 && !heartbeat_is_next_)) {
    poses_.publish(last_pose_);
  } else {
    publish_heartbeat(stamp_ns);
  }
}

// A pose with sequence 0: the truth up to this stamp has arrived and its frames have been published.
void MotionCaptureSimulator::publish_heartbeat(std::int64_t stamp_ns) {
  messages::msg::MocapPose heartbeat;
  heartbeat.stamp_ns(stamp_ns);
  poses_.publish(heartbeat);
}

}  // namespace swiftlet::services
