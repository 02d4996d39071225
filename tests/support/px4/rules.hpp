// The rules of PX4's commander, as a program beside it meets them: proof of life, commands and their answers, modes, failsafe,
// land detector, automatic disarming. Pure: time comes in, in us on PX4's clock.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/services/px4/px4_topics.hpp"

namespace swiftlet::tests {

namespace px4_msg = px4::msg;

struct Px4RulesSettings {
  std::int64_t offboard_loss_us = 1'000'000;   // COM_OF_LOSS_T
  std::int64_t proof_of_life_us = 1'000'000;   // of a stream before offboard mode is accepted
  std::int64_t longest_interval_us = 500'000;  // of that stream: 2 Hz
  std::int64_t land_step_us = 1'000'000;       // from ground contact to "maybe landed", and on to "landed"
  std::int64_t disarm_after_landing_us = 2'000'000;  // COM_DISARM_LAND
  std::int64_t disarm_preflight_us = 10'000'000;     // COM_DISARM_PRFLT
};

class Px4Rules {
 public:
  explicit Px4Rules(const Px4RulesSettings& settings = {});

  void on_offboard_mode(const px4_msg::OffboardControlMode& mode, std::int64_t now_us);
  // The answer; nullopt: the command is for another system.
  std::optional<px4_msg::VehicleCommandAck> on_command(const px4_msg::VehicleCommand& command,
                                                       std::int64_t now_us);
  struct Motion {
    bool touches_ground = true;
    bool low_thrust = true;
    bool has_position = true;  // of the estimator
  };
  // Call often.
  void update(const Motion& motion, std::int64_t now_us);

  // What others do.
  void pilot_selects(std::uint8_t nav_state, std::int64_t now_us);
  void kill(std::int64_t now_us);  // kill switch
  bool refuses_to_arm = false;     // a preflight check fails

  bool armed() const { return status_.arming_state() == 2; }
  bool offboard() const { return status_.nav_state() == 14; }
  const px4_msg::VehicleStatus& status() const { return status_; }
  const px4_msg::VehicleLandDetected& land_detected() const { return land_; }
  px4_msg::FailsafeFlags flags() const;

 private:
  bool signal_is_lost(std::int64_t now_us) const;
  bool is_proven(std::int64_t now_us) const;
  std::uint8_t execute(const px4_msg::VehicleCommand& command, std::int64_t now_us);
  std::uint8_t arm_or_disarm(const px4_msg::VehicleCommand& command, std::int64_t now_us);
  void set_mode(std::uint8_t nav_state, std::int64_t now_us);
  void disarm(std::uint8_t reason);
  bool checks_pass(std::int64_t now_us) const;
  void detect_landing(const Motion& motion, std::int64_t now_us);

  const Px4RulesSettings settings_;
  px4_msg::VehicleStatus status_;
  px4_msg::VehicleLandDetected land_;
  px4_msg::OffboardControlMode mode_;
  Motion motion_;
  std::int64_t now_us_ = 0;
  std::int64_t streamed_us_ = -1;        // last proof of life; -1: none
  std::int64_t streamed_since_us_ = -1;  // begin of the stream
  std::int64_t armed_us_ = 0;
  std::int64_t contact_since_us_ = 0;
  std::int64_t landed_since_us_ = 0;
  bool has_flown_ = false;
};

}  // namespace swiftlet::tests
