#include "swiftlet/services/plant/autopilot_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "swiftlet/math/time.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::max();
// UTC at stamp 0 in lockstep, where nothing may depend on the computer's clock: the start of 2026.
constexpr std::int64_t kLockstepEpochNs = 1'767'225'600'000'000'000;

constexpr int kMostSamplesPerAnswer = 8;
constexpr int kSoonerAnswers = 100;  // before time waits for more answers again

std::int64_t unix_ns(runtime::Clock clock, std::int64_t stamp_ns) {
  return clock == runtime::Clock::kLockstep ? kLockstepEpochNs + stamp_ns : runtime::system_ns();
}

}  // namespace

AutopilotLoop::AutopilotLoop(SimulatedVehicle& vehicle, const plant::Vehicle& parameters,
                             const plant::SimulationSettings& simulation, std::uint64_t seed,
                             const AutopilotLoopSettings& settings, dds::Node& node)
    : vehicle_(vehicle),
      settings_(settings),
      mapping_(settings.autopilot.controls, settings.autopilot.control_at_zero,
               settings.autopilot.control_at_full, parameters),
      sensors_(simulation, seed),
      truth_(simulation),
      autopilot_(settings.autopilot, simulation.site),
      steps_per_sample_(plant::period_ns(simulation.imu.rate_hz) / simulation.step_ns),
      imu_period_ns_(plant::period_ns(simulation.imu.rate_hz)),
      tick_period_ns_(std::llround(static_cast<double>(imu_period_ns_) / settings.speed)) {
  if (settings.autopilot.controls == "px4" && !spins_as_px4(parameters))
    runtime::log_warning(
        "the rotors of {} do not turn as those of PX4's quadrotor in X: change the signs of CA_ROTOR*_KM",
        parameters.name);
  if (!settings.trace.empty()) trace_.emplace(settings.trace, parameters.rotor_count());
  if (settings.autopilot.truth_only) {
    clock_client_.emplace(node, runtime::monotonic_ns);
  } else {
    clock_server_.emplace(node, [this] { return simulated_ns(); });
  }
}

void AutopilotLoop::run(const std::atomic<bool>& stop) {
  if (settings_.realtime.enabled) runtime::make_this_thread_realtime(settings_.realtime);
  publish();
  if (in_lockstep()) wait_for_connection(stop);
  tick_ns_ = runtime::monotonic_ns();
  while (!stop.load(std::memory_order_relaxed)) {
    if (waits_for_answer()) wait_for_answer(stop);
    wait_for_tick(stop);
    advance();
  }
  if (trace_) trace_->close();
}

// Repeats the first samples: a recorder may not have been discovered when they were first sent.
void AutopilotLoop::wait_for_connection(const std::atomic<bool>& stop) {
  runtime::log_info("waiting for the autopilot: {}", settings_.autopilot.description());
  while (!autopilot_.introduced() && !stop.load(std::memory_order_relaxed)) {
    receive(runtime::monotonic_ns() + AutopilotConnection::kLongestWaitNs);
    vehicle_.report();
    if (!settings_.autopilot.truth_only) vehicle_.publish_again();
  }
}

// Also before the first controls, so that an autopilot that answers every sample flies the same flight each time.
bool AutopilotLoop::waits_for_answer() const {
  const bool may_answer = autopilot_.lockstep() || !autopilot_.heard();
  return in_lockstep() && !silent_ && autopilot_.connected() && may_answer &&
         vehicle_.simulation().imu().has_value() && vehicle_.simulation().stamp_ns() > 0;
}

void AutopilotLoop::wait_for_answer(const std::atomic<bool>& stop) {
  const std::int64_t deadline_ns =
      runtime::monotonic_ns() + math::nanoseconds(settings_.autopilot.answer_timeout_s);
  while (!answered() && autopilot_.connected() && !stop.load(std::memory_order_relaxed)) {
    if (runtime::monotonic_ns() >= deadline_ns) {
      note_silence();
      return;
    }
    receive(deadline_ns);
  }
}

void AutopilotLoop::note_silence() {
  silent_ = true;
  if (!autopilot_.heard()) {
    runtime::log_info("autopilot: sends no controls yet; samples go on at the pace of real time");
    return;
  }
  runtime::log_warning(
      "autopilot: no answer to the sample of t = {:.3f} s for {:g} s; going on at the pace of real time",
      static_cast<double>(vehicle_.simulation().stamp_ns()) * 1e-9, settings_.autopilot.answer_timeout_s);
}

// Receives until the next sample is due by the computer's clock. In lockstep no sample is late, and with answers only a
// limited speed makes it wait.
void AutopilotLoop::wait_for_tick(const std::atomic<bool>& stop) {
  const auto goes_on = [&] {
    return in_lockstep() && !settings_.limited_in_lockstep && autopilot_.lockstep() && answered();
  };
  const std::int64_t next_ns = tick_ns_ + tick_period_ns_;
  while (!goes_on() && runtime::monotonic_ns() < next_ns && !stop.load(std::memory_order_relaxed))
    receive(next_ns);
  const std::int64_t late_ns = runtime::monotonic_ns() - next_ns;
  if (in_lockstep()) {
    const bool on_time = late_ns >= 0 && late_ns < tick_period_ns_;
    tick_ns_ = on_time ? next_ns : next_ns + late_ns;
    return;
  }
  receive(0);
  const std::int64_t left_out_ns = late_ns > tick_period_ns_ ? late_ns - late_ns % tick_period_ns_ : 0;
  if (left_out_ns > 0) vehicle_.note_slip(left_out_ns);
  tick_ns_ = next_ns + left_out_ns;
}

void AutopilotLoop::receive(std::int64_t deadline_ns) {
  const std::size_t before = received_.size();
  autopilot_.receive(deadline_ns, received_);
  for (std::size_t i = before; i < received_.size(); ++i) {
    const std::int64_t stamp_ns = stamp_answered_by(received_[i]);
    if (stamp_ns <= vehicle_.simulation().stamp_ns()) note_answer(stamp_ns);
  }
  if (silent_ && received_.size() > before && answered()) {
    silent_ = false;
    runtime::log_info("autopilot: answers again");
  }
}

void AutopilotLoop::note_answer(std::int64_t stamp_ns) {
  if (stamp_ns <= answered_stamp_ns_) return;
  const auto samples = static_cast<int>(std::min((stamp_ns - answered_stamp_ns_) / imu_period_ns_,
                                                 static_cast<std::int64_t>(kMostSamplesPerAnswer)));
  const bool is_known = answered_stamp_ns_ >= 0;
  answered_stamp_ns_ = stamp_ns;
  sooner_answers_ = samples < samples_per_answer_ ? sooner_answers_ + 1 : 0;
  const bool answers_less = is_known && silent_ && samples > samples_per_answer_;
  if (!answers_less && sooner_answers_ < kSoonerAnswers) return;
  sooner_answers_ = 0;
  samples_per_answer_ = std::max(samples, 1);
  if (samples > most_left_out_)
    runtime::log_warning(
        "autopilot: answers one of {} samples; PX4 answers all if its IMU_GYRO_RATEMAX is above {:g} Hz",
        samples, 1e9 / static_cast<double>(imu_period_ns_));
  most_left_out_ = std::max(most_left_out_, samples);
}

// Makes the steps up to the next sample. In real time each obeys the controls that had arrived when it was due.
void AutopilotLoop::advance() {
  if (in_lockstep()) obey_until(kAlways);
  if (trace_) trace_->add(vehicle_.simulation().truth(), command_);
  for (std::int64_t left = steps_per_sample_ - 1; left >= 0; --left) {
    obey_until(left == 0 ? kAlways : tick_ns_ - tick_period_ns_ * left / steps_per_sample_);
    vehicle_.step();
    publish();
    vehicle_.report();
  }
}

void AutopilotLoop::obey_until(std::int64_t due_ns) {
  std::size_t obeyed = 0;
  while (obeyed < received_.size() && received_[obeyed].received_ns <= due_ns) obey(received_[obeyed++]);
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(obeyed));
}

void AutopilotLoop::obey(const ReceivedControls& received) {
  plant::ActuatorCommand command = mapping_.command(received.controls);
  command.stamp_ns = stamp_answered_by(received);
  command.imu_sequence =
      static_cast<std::uint64_t>(std::max<std::int64_t>(command.stamp_ns, 0) / imu_period_ns_) + 1;
  if (vehicle_.obey({command, received.received_ns, {}})) command_ = command;
}

// With lockstep the autopilot's clock is that of the samples; otherwise the controls answer the newest sample.
std::int64_t AutopilotLoop::stamp_answered_by(const ReceivedControls& received) const {
  const std::int64_t stamp_ns = vehicle_.simulation().stamp_ns();
  if (!received.lockstep()) return stamp_ns - stamp_ns % imu_period_ns_;
  constexpr std::uint64_t kLatestUs = std::numeric_limits<std::int64_t>::max() / 1000;
  return static_cast<std::int64_t>(std::min(received.controls.time_usec, kLatestUs)) * 1000;
}

void AutopilotLoop::publish() {
  const plant::PlantSimulation& simulation = vehicle_.simulation();
  publish_samples(truth_.due(simulation));
  if (!simulation.imu_due()) return;
  HilSamples samples;
  samples.imu = simulation.imu();
  samples.truth = simulation.truth();
  samples.navigation = sensors_.sample(samples.truth);
  samples.unix_ns = unix_ns(settings_.clock, simulation.stamp_ns());
  if (simulation.stamp_ns() > 0) autopilot_.send(samples);
}

// If another process is the vehicle, its truth is known at the time by its clock at which the present sample was due.
void AutopilotLoop::publish_samples(bool truth_needed) {
  const std::int64_t pace_ns =
      std::llround(static_cast<double>(vehicle_.simulation().stamp_ns()) / settings_.speed);
  const bool is_paced = tick_ns_ > 0 && (!in_lockstep() || settings_.limited_in_lockstep);
  origin_ns_.store(is_paced ? tick_ns_ - pace_ns : 0, std::memory_order_relaxed);
  if (!clock_client_) return vehicle_.publish_samples(truth_needed);
  clock_client_->ask_if_due();
  if (!truth_needed || tick_ns_ == 0) return;
  if (const auto stamp_ns = clock_client_->to_vehicle(tick_ns_)) vehicle_.publish_truth(*stamp_ns);
}

// The vehicle's clock, also between its samples; nullopt while it runs as fast as the autopilot answers.
std::optional<std::int64_t> AutopilotLoop::simulated_ns() const {
  const std::int64_t origin_ns = origin_ns_.load(std::memory_order_relaxed);
  if (origin_ns == 0) return std::nullopt;
  return std::llround(static_cast<double>(runtime::monotonic_ns() - origin_ns) * settings_.speed);
}

}  // namespace swiftlet::services
