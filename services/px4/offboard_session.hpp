// Arms, flies and disarms a PX4 on behalf of the control service: PX4's offboard mode as a state machine. Pure: time, states and
// answers come in, commands and words go out.
//
//   disarmed --rotors running--> switching --offboard--> arming --armed--> flying --rotors off--> disarming --> disarmed
//
// What PX4 does by itself is never fought. When it leaves offboard mode or disarms, by its failsafe, its pilot or a kill switch, the
// session has been taken over: nothing more is sent until PX4 is disarmed and control commands rotors off.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/services/px4/px4_topics.hpp"

namespace swiftlet::px4 {

struct OffboardSettings {
  // Without a command for this time, PX4 is told to land. It would obey the last setpoint for another second.
  std::int64_t control_silence_ns = 200'000'000;
  std::int64_t status_silence_ns = 2'000'000'000;  // PX4 reports its status twice a second
  std::int64_t samples_silence_ns = 500'000'000;   // and its sensors 100 times
  std::int64_t proof_of_life_ns = 1'100'000'000;   // of OffboardControlMode before PX4 accepts the mode
  std::int64_t retry_ns = 500'000'000;  // of a command that was not answered, or temporarily rejected
  int tries = 6;
};

enum class Phase : std::uint8_t {
  kDisconnected,  // no status of PX4, or an unknown version
  kDisarmed,
  kSwitching,  // to offboard mode
  kArming,
  kFlying,
  kDisarming,
  kLanding,    // control has fallen silent, and PX4 was told to land
  kTakenOver,  // PX4 has left offboard mode, or disarmed, by itself
  kRefused,    // PX4 does not switch or arm
};
const char* to_string(Phase phase);

// What is known at a time, on one clock.
struct OffboardInputs {
  std::int64_t now_ns = 0;
  bool rotors_wanted = false;                // the last command of control
  std::int64_t commanded_ns = 0;             // when it arrived; 0: never
  std::int64_t streamed_since_ns = 0;        // since when commands came without a break; 0: they do not
  std::optional<msg::VehicleStatus> status;  // newest
  std::int64_t status_ns = 0;                // when it arrived
  std::int64_t sampled_ns = 0;               // when the last sensor sample arrived; 0: never
  std::optional<msg::FailsafeFlags> flags;   // newest
  std::string version_fault;                 // of version_of()
  std::string arming_fault;                  // why PX4 must not be armed now; empty: nothing is wrong
};

class OffboardSession {
 public:
  explicit OffboardSession(const OffboardSettings& settings = {}) : settings_(settings) {}

  // Call regularly. Returns the command to send to PX4, if there is one.
  std::optional<msg::VehicleCommand> update(const OffboardInputs& inputs);
  void on_ack(const msg::VehicleCommandAck& ack);

  Phase phase() const { return phase_; }
  // Setpoints of control are passed on to PX4, each once.
  bool streams() const;
  bool rotors_running() const { return armed_; }
  // The fault in vehicle_info: what PX4 or its link does other than to fly on command; empty in ordinary operation.
  const std::string& fault() const { return fault_; }

 private:
  void enter(Phase phase, std::string fault = {});
  std::string link_fault(const OffboardInputs& inputs) const;
  bool is_silent(const OffboardInputs& inputs) const;
  std::optional<msg::VehicleCommand> start(const OffboardInputs& inputs);
  std::optional<msg::VehicleCommand> switch_mode(const OffboardInputs& inputs);
  std::optional<msg::VehicleCommand> arm_vehicle(const OffboardInputs& inputs);
  std::optional<msg::VehicleCommand> fly(const OffboardInputs& inputs);
  std::optional<msg::VehicleCommand> disarm(const OffboardInputs& inputs);
  std::optional<msg::VehicleCommand> land_now(const OffboardInputs& inputs);
  // The command, if it is time to send it; nullopt: wait for the answer. Refuses after the last try.
  std::optional<msg::VehicleCommand> attempt(const msg::VehicleCommand& command, const OffboardInputs& inputs,
                                             const char* what);
  std::string refusal(const OffboardInputs& inputs, const char* what) const;
  std::string takeover(const msg::VehicleStatus& status) const;

  const OffboardSettings settings_;
  Phase phase_ = Phase::kDisconnected;
  std::string fault_;
  bool armed_ = false;
  bool offboard_ = false;
  std::uint8_t system_ = 1;
  // The command under way:
  std::uint32_t command_ = 0;
  int sent_ = 0;
  std::int64_t sent_ns_ = 0;
  std::optional<std::uint8_t> result_;
};

}  // namespace swiftlet::px4
