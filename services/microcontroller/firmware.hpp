// What the firmware of a vehicle does at its end of the link: answers the host, obeys its commands, and stops the rotors when
// they cease. Time comes in with each call, bytes go out through a function: it knows neither a device nor a thread, and
// allocates nothing after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/command_watchdog.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"
#include "swiftlet/services/microcontroller/protocol/frame.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"

namespace swiftlet::services {

struct FirmwareSettings {
  std::string name = "swiftlet simulated";  // at most 24 characters
  std::uint16_t version = protocol::kVersion;
  std::uint32_t boot = 1;
  int rotor_count = 4;
  double imu_rate_hz = 500.0;
  double command_timeout_s = 0.1;
};

// Not thread-safe. now_us and the stamps of samples are the microcontroller's clock.
class Firmware {
 public:
  using Send = std::function<void(const std::uint8_t* bytes, std::size_t size)>;

  Firmware(const FirmwareSettings& settings, Send send);

  // Bytes from the host, in pieces of any size. Returns true if a valid frame ended in them.
  bool take(const std::uint8_t* bytes, std::size_t size, std::int64_t now_us);

  // Motor command at now_us. A time-out of the commands turns the rotors off, and they stay off until the host has commanded
  // that too: a link that comes back in the air must not start them.
  plant::MotorCommand motor_command(std::int64_t now_us);

  // Each goes to the host if a session is open. The stamps of the samples are ignored.
  void send(const plant::ImuSample& sample, std::int64_t stamp_us);
  void send(const plant::RotorSpeedSample& sample, std::int64_t stamp_us);
  void send(const plant::BatterySample& sample, std::int64_t stamp_us);
  // Every 100 ms, and when the rotors have started or stopped.
  void send_state_if_due(std::int64_t now_us);

  bool in_session(std::int64_t now_us) const;
  // The last obeyed command answers the sample of this stamp, or a later one.
  bool has_obeyed(std::int64_t stamp_us) const;
  const protocol::State& state() const { return state_; }

 private:
  void on_hello(const protocol::Hello& hello, std::int64_t now_us);
  void on_time_request(const protocol::TimeRequest& request, std::int64_t now_us);
  void on_command(const protocol::Command& command, std::int64_t now_us);
  void refuse(const char* reason);
  template <class Message>
  void transmit(const Message& message);

  FirmwareSettings settings_;
  Send send_;
  protocol::FrameEncoder encoder_;
  protocol::FrameDecoder decoder_;
  plant::CommandWatchdog watchdog_;
  bool has_session_ = false;
  std::int64_t heard_us_ = 0;  // last frame of the session
  bool timed_out_ = false;     // until a command to turn the rotors off
  std::uint32_t command_age_us_ = 0;
  protocol::State state_;
  std::int64_t state_due_us_ = 0;
  bool rotors_reported_ = false;
};

}  // namespace swiftlet::services
