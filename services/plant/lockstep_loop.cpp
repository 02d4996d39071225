#include "swiftlet/services/plant/lockstep_loop.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/plant/model/telemetry_rate.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

using namespace std::chrono_literals;
using Lock = std::lock_guard<std::mutex>;

constexpr auto kPollPeriod = 20ms;  // unanswered samples are sent again after this time
constexpr double kLongestPollS = 0.1;
constexpr double kPaceWithoutControl =
    0.25;  // simulated time per real time: a standby on a busy machine keeps up
constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

}  // namespace

LockstepLoop::LockstepLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings,
                           std::uint64_t seed, const LockstepSettings& lockstep, int rotor_count,
                           dds::Node& node)
    : vehicle_(vehicle),
      mocap_(settings.mocap, seed),
      lockstep_(lockstep),
      imu_period_ns_(plant::period_ns(settings.imu.rate_hz)),
      sends_every_truth_(!settings.faults.empty()),
      control_missing_(lockstep.goes_on),
      expected_(settings, 0),
      advance_to_ns_(lockstep.paused ? -1 : kNoLimit),
      paced_ns_(lockstep.speed > 0.0 || lockstep.goes_on ? 0 : kNoLimit) {
  if (!lockstep.trace.empty()) trace_.emplace(lockstep.trace, rotor_count);
  commands_ = subscribe_commands(node, settings.control_levels, dds::Delivery::kShared,
                                 [this](const ReceivedCommand& received) { on_command(received); });
  poses_ = node.subscribe<messages::msg::MocapPose>(
      messages::topics::kMocapPose, [this](const auto& message) { on_pose(message); }, dds::Delivery::kShared,
      dds::OneSource{dds::kSourceSilence});
  if (lockstep.paused) {
    clock_ = node.subscribe<messages::msg::SimulationClock>(
        messages::topics::kSimulationClock, [this](const auto& message) { on_clock(message); });
  }
}

void LockstepLoop::run(const std::atomic<bool>& stop) {
  std::int64_t polled_ns = runtime::monotonic_ns();
  while (!stop.load(std::memory_order_relaxed)) {
    std::chrono::nanoseconds period = kPollPeriod;
    {
      const Lock lock(mutex_);
      const std::int64_t now_ns = runtime::monotonic_ns();
      poll(std::min(static_cast<double>(now_ns - polled_ns) * 1e-9, kLongestPollS));
      polled_ns = now_ns;
      if (control_missing_) period = std::chrono::nanoseconds(imu_period_ns_);
    }
    std::this_thread::sleep_for(period);
  }
  const Lock lock(mutex_);
  if (trace_) trace_->close();
}

// An invalid command answers nothing: its sample number may be invalid too. While time goes on without control, commands
// may also answer earlier samples, as in real time.
void LockstepLoop::on_command(const ReceivedCommand& received) {
  const Lock lock(mutex_);
  if (!started_ || !command_due()) return;  // a repeated answer
  const bool answers = plant::header_of(received.command).imu_sequence == *vehicle_.awaited();
  if (!received.fault && !answers && !control_missing_) return;
  if (!vehicle_.obey(received)) return;
  if (control_missing_) return_of_control();
  control_heard_ = true;
  command_ = received.command;
  if (!answers) return;
  vehicle_.go_on_in_order();
  advance();
}

void LockstepLoop::on_pose(const messages::msg::MocapPose& message) {
  const Lock lock(mutex_);
  mocap_heard_ = true;
  mocap_missing_ = false;
  plant::PoseSample pose;
  const bool is_new = message.sequence_number() > mocap_sequence_;
  if (is_new && vehicle_.needs_poses() && !messages::from_message(message, pose)) vehicle_.on_pose(pose);
  mocap_sequence_ = std::max(mocap_sequence_, message.sequence_number());
  if (message.sequence_number() == 0) mocap_seen_ns_ = std::max(mocap_seen_ns_, message.stamp_ns());
  advance();
}

void LockstepLoop::on_clock(const messages::msg::SimulationClock& message) {
  const Lock lock(mutex_);
  clock_heard_ = true;
  clock_silence_s_ = 0.0;
  advance_to_ns_ = std::max(advance_to_ns_, message.advance_to_ns());
  advance();
}

bool LockstepLoop::is_paused() const {
  return vehicle_.simulation().stamp_ns() + imu_period_ns_ > advance_to_ns_;
}

bool LockstepLoop::may_advance() const {
  return !is_paused() && vehicle_.simulation().stamp_ns() + imu_period_ns_ <= paced_ns_;
}

// Advances the time limit by the time in which this process was running. Late answers are not made up for. Without control
// one sample follows after the other, so that a standby that is to take over can answer each.
void LockstepLoop::keep_pace(double awake_s) {
  if (paced_ns_ == kNoLimit) return;
  const std::int64_t next_ns = vehicle_.simulation().stamp_ns() + imu_period_ns_;
  std::int64_t step_ns = std::llround(1e9 * awake_s * lockstep_.speed);
  if (control_missing_)
    step_ns = std::min<std::int64_t>(std::llround(1e9 * kPaceWithoutControl * awake_s), imu_period_ns_);
  paced_ns_ = std::min(paced_ns_, next_ns) + step_ns;
  advance();
}

// Runs in the thread that received the last missing answer. Loops while simulated faults leave no answer to
// wait for.
void LockstepLoop::advance() {
  while (started_ && answered()) {
    vehicle_.note_pause(is_paused());
    vehicle_.report();
    if (!may_advance()) return;
    silence_s_ = 0.0;
    if (trace_) trace_->add(vehicle_.simulation().truth(), vehicle_.as_actuators(command_));
    advance_to_imu_stamp();
  }
}

void LockstepLoop::advance_to_imu_stamp() {
  do {
    vehicle_.step();
    publish();
  } while (!vehicle_.simulation().imu_due());
}

void LockstepLoop::publish() {
  const plant::PlantSimulation& simulation = vehicle_.simulation();
  bool truth_needed = false;
  if (simulation.imu_due()) {
    const std::int64_t stamp_ns = simulation.stamp_ns();
    const plant::MocapSchedule::Events events = mocap_.advance(stamp_ns);
    const bool frame = frame_is_due(stamp_ns, events.delivers);
    truth_needed = frame || events.exposes || events.delivers || sends_every_truth_ ||
                   plant::is_telemetry_sample(simulation.imu_count(), imu_period_ns_);
    if (truth_needed && !frame) truth_sent_ns_ = stamp_ns;
  }
  vehicle_.publish_samples_in_order(mocap_missing_ ? mocap_sequence_ : mocap_due_, truth_needed);
}

// True if the mocap path with its faults delivers a frame at this stamp.
bool LockstepLoop::frame_is_due(std::int64_t stamp_ns, bool delivered) {
  std::optional<plant::PoseSample> frame;
  if (delivered) {
    frame.emplace();
    frame->stamp_ns = stamp_ns;
    frame->sequence = mocap_.delivered();
  }
  const auto out = expected_.pass(frame, stamp_ns);
  if (out) mocap_due_ = out->sequence;
  return out.has_value();
}

void LockstepLoop::poll(double awake_s) {
  if (!started_) {
    if (advance_to_ns_ < 0) return;
    started_ = true;
    publish();
    return;
  }
  keep_pace(awake_s);
  if (clock_heard_ && (clock_silence_s_ += awake_s) > lockstep_.patience_s)
    throw std::runtime_error(silent_ground());
  if (answered()) {
    if (control_missing_) return;  // new samples follow
    // The controller evaluates requests with each sample, also with a repeated one. The first samples are all
    // repeated until time advances: a recorder may not have been discovered when they were first sent.
    if (vehicle_.simulation().stamp_ns() == 0) return vehicle_.publish_again();
    vehicle_.publish_imu_again();
    return;
  }
  note_silence(awake_s);
  if (silence_s_ > std::chrono::duration<double>(kPollPeriod).count()) vehicle_.publish_again();
}

void LockstepLoop::note_silence(double awake_s) {
  silence_s_ += awake_s;
  if (silence_s_ <= lockstep_.patience_s) return;
  const bool control_to_start = command_due() && !control_heard_;
  const bool mocap_to_start = mocap_silent() && !mocap_heard_;
  if (!control_to_start && !mocap_to_start) {
    if (!lockstep_.goes_on) throw std::runtime_error(silent_peer());
    return go_on_without_silent_peers();
  }
  const std::string peers = control_to_start ? mocap_to_start ? "mocap and control" : "control" : "mocap";
  if (std::exchange(logged_wait_, peers) != peers) runtime::log_info("waiting for {}", peers);
}

void LockstepLoop::go_on_without_silent_peers() {
  runtime::log_warning("{}; going on without it", silent_peer());
  mocap_missing_ = mocap_missing_ || mocap_silent();
  silence_s_ = 0.0;
  if (command_due() && !control_missing_) {
    control_missing_ = true;
    paced_ns_ = vehicle_.simulation().stamp_ns();
  }
  advance();
}

void LockstepLoop::return_of_control() {
  if (control_heard_) runtime::log_info("control answers again");
  control_missing_ = false;
  silence_s_ = 0.0;
  paced_ns_ = lockstep_.speed > 0.0 ? vehicle_.simulation().stamp_ns() : kNoLimit;
}

std::string LockstepLoop::silent_ground() const {
  return fmt::format("lockstep: ground is silent: no simulation_clock has come for {:g} s",
                     lockstep_.patience_s);
}

std::string LockstepLoop::silent_peer() const {
  const double time_s = static_cast<double>(vehicle_.simulation().stamp_ns()) * 1e-9;
  if (mocap_heard_ && mocap_sequence_ >= mocap_due_ && mocap_silent()) {
    return fmt::format("lockstep: mocap is silent: the truth of t = {:.3f} s has no answer for {:g} s",
                       static_cast<double>(truth_sent_ns_) * 1e-9, lockstep_.patience_s);
  }
  if (mocap_silent()) {
    return fmt::format("lockstep: mocap is silent: frame {}, due at t = {:.3f} s, has not come for {:g} s",
                       mocap_due_, time_s, lockstep_.patience_s);
  }
  return fmt::format("lockstep: control is silent: IMU sample {} of t = {:.3f} s has no answer for {:g} s",
                     *vehicle_.awaited(), time_s, lockstep_.patience_s);
}

}  // namespace swiftlet::services
