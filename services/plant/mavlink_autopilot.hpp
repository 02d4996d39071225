// The protocol with an autopilot: PX4's simulator interface. Sends HIL_SENSOR, HIL_GPS, HIL_STATE_QUATERNION where the
// autopilot requests it, HEARTBEAT and SYSTEM_TIME; receives HIL_ACTUATOR_CONTROLS.
//
// All messages of a stamp are sent at once, HIL_SENSOR last: with it the autopilot's clock moves in lockstep.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "swiftlet/io/mavlink/frame_parser.hpp"
#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/navigation_sensors.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/plant/autopilot_connection.hpp"
#include "swiftlet/services/plant/autopilot_settings.hpp"

namespace swiftlet::services {

// The samples of a stamp.
struct HilSamples {
  std::optional<plant::ImuSample> imu;
  plant::NavigationSamples navigation;
  plant::TruthSample truth;
  std::int64_t unix_ns = 0;  // UTC at this stamp
};

struct ReceivedControls {
  mavlink::HilActuatorControls controls;
  std::int64_t received_ns = 0;  // monotonic

  bool lockstep() const { return (controls.flags & mavlink::HilActuatorControls::kLockstep) != 0; }
};

class MavlinkAutopilot {
 public:
  // Throws as AutopilotConnection does.
  MavlinkAutopilot(const AutopilotSettings& settings, const plant::SiteSettings& site);

  void send(const HilSamples& samples);
  // Waits until deadline_ns, monotonic, or for less, and appends the controls that have arrived.
  void receive(std::int64_t deadline_ns, std::vector<ReceivedControls>& controls);

  bool connected() const { return connection_.connected(); }
  bool introduced() const { return introduced_; }  // a heartbeat or controls have come on this connection
  bool heard() const { return heard_; }            // controls have come on this connection
  // True if the newest controls of this connection had the flag of lockstep.
  bool lockstep() const { return lockstep_; }

 private:
  void start_connection();
  void on_frame(const mavlink::Frame& frame, std::vector<ReceivedControls>& controls);
  bool is_from_autopilot(const mavlink::Frame& frame);
  void on_command(const mavlink::CommandLong& command);
  bool state_due(std::uint64_t time_usec);
  void log_trouble();
  template <class Message>
  void add(const Message& message);

  AutopilotConnection connection_;
  plant::SiteSettings site_;
  std::uint8_t system_id_setting_;
  std::uint64_t connection_number_ = 0;

  mavlink::FrameParser parser_;
  std::array<std::uint8_t, 4096> received_{};
  std::vector<std::uint8_t> message_bytes_;
  std::uint8_t sequence_ = 0;

  // The state of this connection:
  std::optional<std::uint8_t> system_id_;  // of the autopilot, once known
  bool introduced_ = false;
  bool heard_ = false;
  bool lockstep_ = false;
  std::int64_t state_interval_us_ = -1;  // of HIL_STATE_QUATERNION; below 0: not requested
  std::uint64_t next_state_us_ = 0;
  std::int64_t next_second_ns_ = 0;  // when HEARTBEAT and SYSTEM_TIME are due next, stamp

  struct Trouble {
    std::uint64_t skipped = 0;
    std::uint64_t wrong_checksum = 0;
    std::uint64_t other_system = 0;
    std::uint64_t unsent = 0;
  };
  Trouble trouble_;
  Trouble logged_;
  std::uint8_t other_system_id_ = 0;  // the last of other_system
  std::int64_t log_due_ns_ = 0;
};

}  // namespace swiftlet::services
