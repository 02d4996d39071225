#include "tests/support/px4/rules.hpp"

#include <cmath>

namespace swiftlet::tests {
namespace {

constexpr std::uint8_t kDisarmed = 1, kArmed = 2;
constexpr std::uint8_t kHold = 4, kDescend = 12, kOffboard = 14, kLand = 18;
constexpr std::uint8_t kAccepted = 0, kTemporarilyRejected = 1, kUnsupported = 3;
constexpr std::uint32_t kCommandLand = 21, kCommandSetMode = 176, kCommandArmDisarm = 400;
constexpr std::uint8_t kExternalCommand = 4, kAfterLanding = 7, kBeforeFlight = 8, kKillSwitch = 9;
constexpr float kForced = 21196.0F;
constexpr float kMainModeOffboard = 6.0F;
constexpr std::uint8_t kRotaryWing = 1;

}  // namespace

Px4Rules::Px4Rules(const Px4RulesSettings& settings) : settings_(settings) {
  status_.arming_state(kDisarmed);
  status_.nav_state(kHold);
  status_.nav_state_user_intention(kHold);
  status_.vehicle_type(kRotaryWing);
  status_.system_id(1);
  status_.component_id(1);
  land_.ground_contact(true);
  land_.maybe_landed(true);
  land_.landed(true);
}

void Px4Rules::on_offboard_mode(const px4_msg::OffboardControlMode& mode, std::int64_t now_us) {
  if (streamed_us_ < 0 || now_us - streamed_us_ > settings_.longest_interval_us) streamed_since_us_ = now_us;
  streamed_us_ = now_us;
  mode_ = mode;
}

bool Px4Rules::signal_is_lost(std::int64_t now_us) const {
  const bool is_recent = streamed_us_ >= 0 && now_us - streamed_us_ < settings_.offboard_loss_us;
  const bool any = mode_.position() || mode_.velocity() || mode_.acceleration() || mode_.attitude() ||
                   mode_.body_rate() || mode_.thrust_and_torque() || mode_.direct_actuator();
  const bool needs_position = mode_.position() || mode_.velocity();
  return !is_recent || !any || (needs_position && !motion_.has_position);
}

bool Px4Rules::is_proven(std::int64_t now_us) const {
  return !signal_is_lost(now_us) && now_us - streamed_us_ <= settings_.longest_interval_us &&
         now_us - streamed_since_us_ >= settings_.proof_of_life_us;
}

// In Hold, the mode after the start, there is no global position.
bool Px4Rules::checks_pass(std::int64_t now_us) const {
  return !refuses_to_arm && status_.nav_state() == kOffboard && !signal_is_lost(now_us);
}

std::optional<px4_msg::VehicleCommandAck> Px4Rules::on_command(const px4_msg::VehicleCommand& command,
                                                               std::int64_t now_us) {
  const bool is_for_us = command.target_system() == 0 || command.target_system() == status_.system_id();
  if (!is_for_us) return std::nullopt;
  px4_msg::VehicleCommandAck ack;
  ack.command(command.command());
  ack.result(execute(command, now_us));
  ack.target_system(command.source_system());
  ack.target_component(command.source_component());
  return ack;
}

std::uint8_t Px4Rules::execute(const px4_msg::VehicleCommand& command, std::int64_t now_us) {
  switch (command.command()) {
    case kCommandLand:
      set_mode(kLand, now_us);
      return kAccepted;
    case kCommandSetMode:
      if (command.param1() != 1.0F || command.param2() != kMainModeOffboard) return kUnsupported;
      if (!is_proven(now_us)) return kTemporarilyRejected;
      set_mode(kOffboard, now_us);
      return kAccepted;
    case kCommandArmDisarm:
      return arm_or_disarm(command, now_us);
    default:
      return kUnsupported;
  }
}

std::uint8_t Px4Rules::arm_or_disarm(const px4_msg::VehicleCommand& command, std::int64_t now_us) {
  const bool is_forced = command.param2() == kForced;
  if (command.param1() == 1.0F) {
    if (armed()) return kAccepted;
    if (!checks_pass(now_us)) return kTemporarilyRejected;
    status_.arming_state(kArmed);
    status_.latest_arming_reason(kExternalCommand);
    armed_us_ = now_us;
    has_flown_ = false;
    return kAccepted;
  }
  if (!land_.landed() && !is_forced) return kTemporarilyRejected;
  if (armed()) disarm(kExternalCommand);
  return kAccepted;
}

void Px4Rules::set_mode(std::uint8_t nav_state, std::int64_t now_us) {
  status_.nav_state_user_intention(nav_state);
  status_.nav_state(nav_state);
  status_.nav_state_timestamp(static_cast<std::uint64_t>(now_us));
  status_.failsafe(false);
}

void Px4Rules::disarm(std::uint8_t reason) {
  status_.arming_state(kDisarmed);
  status_.latest_disarming_reason(reason);
}

void Px4Rules::update(const Motion& motion, std::int64_t now_us) {
  now_us_ = now_us;
  motion_ = motion;
  detect_landing(motion, now_us);
  const bool fails = status_.nav_state() == kOffboard && armed() && signal_is_lost(now_us);
  if (fails) {
    status_.failsafe(true);
    status_.nav_state(motion.has_position ? kLand : kDescend);
    status_.nav_state_timestamp(static_cast<std::uint64_t>(now_us));
  }
  if (!armed()) {
    status_.failsafe(false);
  } else if (has_flown_ && land_.landed() && now_us - landed_since_us_ >= settings_.disarm_after_landing_us) {
    disarm(kAfterLanding);
  } else if (!has_flown_ && now_us - armed_us_ >= settings_.disarm_preflight_us) {
    disarm(kBeforeFlight);
  }
  status_.pre_flight_checks_pass(checks_pass(now_us));
}

void Px4Rules::detect_landing(const Motion& motion, std::int64_t now_us) {
  const bool contact = motion.touches_ground && motion.low_thrust;
  if (!contact) contact_since_us_ = now_us;
  const bool was_landed = land_.landed();
  land_.ground_contact(contact);
  land_.maybe_landed(contact && now_us - contact_since_us_ >= settings_.land_step_us);
  land_.landed(contact && now_us - contact_since_us_ >= 2 * settings_.land_step_us);
  if (!motion.touches_ground) has_flown_ = true;
  if (land_.landed() && !was_landed) landed_since_us_ = now_us;
}

void Px4Rules::pilot_selects(std::uint8_t nav_state, std::int64_t now_us) { set_mode(nav_state, now_us); }

void Px4Rules::kill(std::int64_t) { disarm(kKillSwitch); }

px4_msg::FailsafeFlags Px4Rules::flags() const {
  px4_msg::FailsafeFlags flags;
  flags.local_position_invalid(!motion_.has_position);
  flags.offboard_control_signal_lost(signal_is_lost(now_us_));
  flags.fd_esc_arming_failure(refuses_to_arm);
  return flags;
}

}  // namespace swiftlet::tests
