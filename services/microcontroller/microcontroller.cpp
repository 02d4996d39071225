#include "swiftlet/services/microcontroller/microcontroller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {

std::int64_t MicrocontrollerClock::us_at(std::int64_t room_ns) const {
  const auto gained_ns = std::llround(static_cast<double>(room_ns) * drift_ppm * 1e-6);
  return (std::llround(offset_s * 1e9) + room_ns + gained_ns) / 1000;
}

Microcontroller::Microcontroller(const dds::Participant& participant, const std::string& vehicle,
                                 const MicrocontrollerSettings& settings, std::unique_ptr<Port> port)
    : HostedVehicle(vehicle),
      realtime_(settings.realtime),
      clock_(settings.clock),
      speed_(settings.speed),
      steps_per_sample_(plant::period_ns(settings.simulation.imu.rate_hz) / settings.simulation.step_ns),
      period_ns_(plant::period_ns(settings.simulation.imu.rate_hz)),
      patience_ns_(std::llround(settings.patience_s * 1e9)),
      simulation_(settings.vehicle, settings.simulation, settings.seed, settings.initial),
      port_(std::move(port)),
      firmware_(settings.firmware,
                [this](const std::uint8_t* bytes, std::size_t size) { port_->write(bytes, size); }),
      node_(participant, vehicle, [this](const std::string& fault) { fail(fault); }),
      ground_truth_(node_.publish(messages::topics::kGroundTruth)) {}

void Microcontroller::run(const std::atomic<bool>& stop) {
  if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
  origin_ns_ = runtime::monotonic_ns();
  while (!stop.load(std::memory_order_relaxed)) {
    const std::int64_t due_ns = origin_ns_ + real_ns(next_sample_ns());
    const std::int64_t give_up_ns = due_ns + patience_ns_;
    if (port_->wait_until(awaits_answer() ? give_up_ns : due_ns)) serve_link();
    const std::int64_t now_ns = runtime::monotonic_ns();
    if (now_ns < due_ns || (awaits_answer() && now_ns < give_up_ns)) continue;
    gave_up_ = gave_up_ || awaits_answer();
    stand_still(now_ns - due_ns);
    step_to_sample();
    report();
  }
}

std::int64_t Microcontroller::next_sample_ns() const { return simulation_.stamp_ns() + period_ns_; }

std::int64_t Microcontroller::real_ns(std::int64_t room_ns) const {
  return std::llround(static_cast<double>(room_ns) / speed_);
}

// The room never passes the next sample before its step, so that its clock does not go back when it has stood still.
std::int64_t Microcontroller::now_us() const {
  const double elapsed_ns = static_cast<double>(runtime::monotonic_ns() - origin_ns_);
  return clock_.us_at(std::min<std::int64_t>(std::llround(speed_ * elapsed_ns), next_sample_ns()));
}

bool Microcontroller::is_answered() const {
  return firmware_.has_obeyed(clock_.us_at(simulation_.stamp_ns()));
}

bool Microcontroller::awaits_answer() const {
  return patience_ns_ > 0 && !gave_up_ && firmware_.state().rotors_running != 0 && !is_answered();
}

void Microcontroller::stand_still(std::int64_t late_ns) {
  if (late_ns <= real_ns(period_ns_)) return;
  origin_ns_ += late_ns;
  stood_still_ns_ += late_ns;
}

void Microcontroller::serve_link() {
  while (const std::size_t count = port_->read(received_.data(), received_.size())) {
    if (!firmware_.take(received_.data(), count, now_us())) port_->refuse_sender();
  }
  if (is_answered()) gave_up_ = false;
}

void Microcontroller::step_to_sample() {
  for (std::int64_t left = steps_per_sample_; left > 0; --left) {
    simulation_.step(firmware_.motor_command(clock_.us_at(simulation_.stamp_ns())));
    send_samples();
  }
  firmware_.send_state_if_due(clock_.us_at(simulation_.stamp_ns()));
}

void Microcontroller::send_samples() {
  const std::int64_t stamp_us = clock_.us_at(simulation_.stamp_ns());
  if (simulation_.imu()) firmware_.send(*simulation_.imu(), stamp_us);
  if (simulation_.rotor_speeds()) firmware_.send(*simulation_.rotor_speeds(), stamp_us);
  if (simulation_.battery()) firmware_.send(*simulation_.battery(), stamp_us);
  if (!simulation_.imu_due()) return;
  messages::msg::GroundTruth truth = messages::to_message(simulation_.truth());
  truth.stamp_ns(stamp_us * 1000);  // as the vehicle's samples, so that they can be compared
  truth.sequence_number(++truths_);
  ground_truth_.publish(truth);
}

void Microcontroller::report() {
  const std::int64_t stamp_us = clock_.us_at(simulation_.stamp_ns());
  reports_.put(
      {firmware_.in_session(stamp_us), firmware_.state(), static_cast<double>(stood_still_ns_) * 1e-9});
}

void Microcontroller::attend() {
  const Report before = last_;
  if (!reports_.take(last_)) return;
  const protocol::State& state = last_.state;
  if (last_.in_session != before.in_session)
    runtime::log_info(
        "{}", last_.in_session ? "a host has begun a session" : "the host is silent: the session has ended");
  if (state.rotors_running == before.state.rotors_running) return;
  if (state.rotors_running != 0) {
    runtime::log_info("rotors started");
  } else if (state.fault.front() != '\0') {
    runtime::log_error("rotors stopped: {}", protocol::text_of(state.fault));
  } else {
    runtime::log_info("rotors stopped on command");
  }
}

void Microcontroller::log_end() {
  const protocol::State& state = last_.state;
  runtime::log_info(
      "ended: {} commands obeyed, {} refused; {} frames received, {} broken, {} lost; stood still {:.1f} ms",
      state.commands_obeyed, state.commands_refused, state.frames_received, state.frames_refused,
      state.frames_lost, last_.stood_still_s * 1e3);
}

}  // namespace swiftlet::services
