#include "swiftlet/services/px4/offboard_session.hpp"

#include <utility>

#include <fmt/core.h>

#include "swiftlet/services/px4/translate.hpp"
#include "swiftlet/services/px4/words.hpp"

namespace swiftlet::px4 {
namespace {

constexpr const char* kNoSamples = "the link to PX4 is lost: no samples";

}  // namespace

const char* to_string(Phase phase) {
  switch (phase) {
    case Phase::kDisconnected:
      return "not connected";
    case Phase::kDisarmed:
      return "disarmed";
    case Phase::kSwitching:
      return "switching to offboard mode";
    case Phase::kArming:
      return "arming";
    case Phase::kFlying:
      return "armed, in offboard mode";
    case Phase::kDisarming:
      return "disarming";
    case Phase::kLanding:
      return "told to land";
    case Phase::kTakenOver:
      return "taken over by PX4";
    case Phase::kRefused:
      return "refused by PX4";
  }
  return "";
}

bool OffboardSession::streams() const {
  return phase_ == Phase::kDisarmed || phase_ == Phase::kSwitching || phase_ == Phase::kArming ||
         phase_ == Phase::kFlying;
}

void OffboardSession::enter(Phase phase, std::string fault) {
  phase_ = phase;
  fault_ = std::move(fault);
  command_ = 0;
  sent_ = 0;
  sent_ns_ = 0;
  result_.reset();
}

void OffboardSession::on_ack(const msg::VehicleCommandAck& ack) {
  if (!is_for_us(ack) || ack.command() != command_ || sent_ == 0) return;
  if (ack.result() != kResultInProgress) result_ = ack.result();
}

std::string OffboardSession::link_fault(const OffboardInputs& inputs) const {
  if (!inputs.version_fault.empty()) return inputs.version_fault;
  if (!inputs.status) return "no status of PX4: is its uXRCE-DDS agent running?";
  const auto silence = [&](std::int64_t last_ns) { return inputs.now_ns - last_ns; };
  if (silence(inputs.status_ns) > settings_.status_silence_ns ||
      silence(inputs.sampled_ns) > settings_.samples_silence_ns)
    return kNoSamples;
  return {};
}

bool OffboardSession::is_silent(const OffboardInputs& inputs) const {
  return inputs.commanded_ns == 0 || inputs.now_ns - inputs.commanded_ns > settings_.control_silence_ns;
}

std::optional<msg::VehicleCommand> OffboardSession::update(const OffboardInputs& inputs) {
  if (inputs.status) {
    armed_ = inputs.status->arming_state() == kArmingStateArmed;
    offboard_ = inputs.status->nav_state() == kNavStateOffboard;
    system_ = inputs.status->system_id();
  }
  const std::string lost = link_fault(inputs);
  switch (phase_) {
    case Phase::kDisconnected:
      if (lost.empty()) {
        enter(Phase::kDisarmed);
      } else {
        fault_ = lost;
      }
      return std::nullopt;
    case Phase::kDisarmed:
      fault_ = inputs.arming_fault;
      if (lost.empty()) return start(inputs);
      enter(Phase::kDisconnected, lost);
      return std::nullopt;
    case Phase::kSwitching:
      return switch_mode(inputs);
    case Phase::kArming:
      return arm_vehicle(inputs);
    case Phase::kFlying:
      if (!lost.empty()) {  // PX4's failsafe acts when the setpoints end; the order to land may still arrive
        enter(Phase::kLanding, lost);
        return land_now(inputs);
      }
      return fly(inputs);
    case Phase::kDisarming:
      return disarm(inputs);
    case Phase::kLanding:
      return land_now(inputs);
    case Phase::kTakenOver:
    case Phase::kRefused:
      if (!inputs.rotors_wanted && lost.empty() && !armed_) enter(Phase::kDisarmed);
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<msg::VehicleCommand> OffboardSession::start(const OffboardInputs& inputs) {
  if (armed_) {
    enter(Phase::kTakenOver,
          fmt::format("PX4 was armed by another, it is in mode {}", mode_name(inputs.status->nav_state())));
    return std::nullopt;
  }
  if (!inputs.rotors_wanted || is_silent(inputs)) return std::nullopt;
  if (!inputs.arming_fault.empty()) {
    enter(Phase::kRefused, inputs.arming_fault);
    return std::nullopt;
  }
  enter(Phase::kSwitching);
  return switch_mode(inputs);
}

std::optional<msg::VehicleCommand> OffboardSession::switch_mode(const OffboardInputs& inputs) {
  if (!inputs.rotors_wanted || is_silent(inputs)) {
    enter(Phase::kDisarmed);
    return std::nullopt;
  }
  if (offboard_) {
    enter(Phase::kArming);
    return arm_vehicle(inputs);
  }
  const bool is_proven =
      inputs.streamed_since_ns != 0 && inputs.now_ns - inputs.streamed_since_ns >= settings_.proof_of_life_ns;
  if (!is_proven) return std::nullopt;
  return attempt(set_offboard_mode(system_), inputs, "switch to offboard mode");
}

std::optional<msg::VehicleCommand> OffboardSession::arm_vehicle(const OffboardInputs& inputs) {
  if (armed_) {
    enter(Phase::kFlying);
    return fly(inputs);
  }
  if (!inputs.rotors_wanted || is_silent(inputs)) {
    // The command to arm may be under way: it is taken back.
    enter(sent_ > 0 ? Phase::kDisarming : Phase::kDisarmed);
    return phase_ == Phase::kDisarming ? disarm(inputs) : std::nullopt;
  }
  if (!offboard_) {  // another has changed the mode: PX4 must not be armed in it
    enter(Phase::kRefused,
          fmt::format("PX4 must not be armed: it is in mode {}", mode_name(inputs.status->nav_state())));
    return std::nullopt;
  }
  return attempt(arm(system_), inputs, "arm");
}

std::optional<msg::VehicleCommand> OffboardSession::fly(const OffboardInputs& inputs) {
  if (!armed_ || !offboard_) {
    if (!armed_ && !inputs.rotors_wanted) {  // what was wanted anyway
      enter(Phase::kDisarmed);
    } else {
      enter(Phase::kTakenOver, takeover(*inputs.status));
    }
    return std::nullopt;
  }
  if (is_silent(inputs)) {
    // Control answers samples: without any it falls silent too.
    const bool unanswered = inputs.now_ns - inputs.sampled_ns < settings_.control_silence_ns / 2;
    enter(Phase::kLanding,
          unanswered ? "no command of the control service: PX4 was told to land" : kNoSamples);
    return land_now(inputs);
  }
  if (inputs.rotors_wanted) return std::nullopt;
  enter(Phase::kDisarming);
  return disarm(inputs);
}

std::optional<msg::VehicleCommand> OffboardSession::disarm(const OffboardInputs& inputs) {
  const bool is_overdue = sent_ > 0 && inputs.now_ns - sent_ns_ > settings_.retry_ns;
  if (!armed_ && (sent_ == 0 || result_ || is_overdue)) {
    enter(Phase::kDisarmed);
    return std::nullopt;
  }
  if (armed_ && !offboard_) {  // the pilot flies
    enter(Phase::kTakenOver, takeover(*inputs.status));
    return std::nullopt;
  }
  if (sent_ > 0 && !is_overdue) return std::nullopt;
  if (sent_ >= settings_.tries) fault_ = refusal(inputs, "disarm");
  command_ = kCommandArmDisarm;
  ++sent_;
  sent_ns_ = inputs.now_ns;
  result_.reset();
  return disarm_at_once(system_);
}

std::optional<msg::VehicleCommand> OffboardSession::land_now(const OffboardInputs& inputs) {
  if (!armed_) {
    if (!inputs.rotors_wanted || is_silent(inputs)) enter(Phase::kDisarmed);
    return std::nullopt;
  }
  if (!offboard_ || result_ == kResultAccepted)
    return std::nullopt;  // it lands, or its failsafe or its pilot flies
  if (sent_ > 0 && inputs.now_ns - sent_ns_ < settings_.retry_ns) return std::nullopt;
  command_ = kCommandLand;
  ++sent_;
  sent_ns_ = inputs.now_ns;
  result_.reset();
  return land(system_);
}

std::optional<msg::VehicleCommand> OffboardSession::attempt(const msg::VehicleCommand& command,
                                                            const OffboardInputs& inputs, const char* what) {
  const std::string lost = link_fault(inputs);
  const bool is_final = result_ && *result_ != kResultAccepted && *result_ != kResultTemporarilyRejected;
  const bool is_due = sent_ == 0 || inputs.now_ns - sent_ns_ >= settings_.retry_ns;
  if (!lost.empty() || is_final || (is_due && sent_ >= settings_.tries)) {
    enter(Phase::kRefused, lost.empty() ? refusal(inputs, what) : lost);
    return std::nullopt;
  }
  if (!is_due) return std::nullopt;
  command_ = command.command();
  ++sent_;
  sent_ns_ = inputs.now_ns;
  result_.reset();
  return command;
}

std::string OffboardSession::refusal(const OffboardInputs& inputs, const char* what) const {
  std::string text = fmt::format("PX4 does not {}: {}", what, result_ ? result_text(*result_) : "no answer");
  std::string checks = inputs.flags ? failing_checks(*inputs.flags) : "";
  if (checks.empty() && inputs.status && !inputs.status->pre_flight_checks_pass())
    checks = "its preflight checks fail";
  if (!checks.empty()) text += " (" + checks + ")";
  return text;
}

std::string OffboardSession::takeover(const msg::VehicleStatus& status) const {
  if (!armed_) {
    const std::string mode =
        status.nav_state() == kNavStateOffboard ? "" : ", mode " + mode_name(status.nav_state());
    return fmt::format("PX4 disarmed: {}{}", disarming_reason(status.latest_disarming_reason()), mode);
  }
  const char* by = status.failsafe() ? "failsafe" : "pilot or ground station";
  return fmt::format("PX4 is in mode {} ({})", mode_name(status.nav_state()), by);
}

}  // namespace swiftlet::px4
