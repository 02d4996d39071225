#include "swiftlet/services/plant/mavlink_autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "swiftlet/math/time.hpp"
#include "swiftlet/services/plant/hil_messages.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::uint8_t kDefaultSystemId = 1;
constexpr std::uint8_t kSimulatorComponent = 200;  // as PX4's other simulators
constexpr std::int64_t kLogPeriodNs = 5 * math::kSecond_ns;
constexpr std::int64_t kDefaultStateIntervalUs = 20'000;

}  // namespace

MavlinkAutopilot::MavlinkAutopilot(const AutopilotSettings& settings, const plant::SiteSettings& site)
    : connection_(settings), site_(site), system_id_setting_(static_cast<std::uint8_t>(settings.system_id)) {
  start_connection();
}

void MavlinkAutopilot::start_connection() {
  connection_number_ = connection_.connections();
  parser_.reset();
  system_id_.reset();
  if (system_id_setting_ != 0) system_id_ = system_id_setting_;
  introduced_ = false;
  heard_ = false;
  lockstep_ = false;
  state_interval_us_ = -1;
  next_second_ns_ = 0;
}

template <class Message>
void MavlinkAutopilot::add(const Message& message) {
  const mavlink::Address sender{system_id_.value_or(kDefaultSystemId), kSimulatorComponent};
  const mavlink::FrameBytes bytes =
      mavlink::encode(mavlink::to_frame(message, sender, sequence_++), Message::kCrcExtra);
  message_bytes_.insert(message_bytes_.end(), bytes.data.begin(),
                        bytes.data.begin() + static_cast<std::ptrdiff_t>(bytes.size));
}

void MavlinkAutopilot::send(const HilSamples& samples) {
  if (!connected()) return;
  const std::int64_t stamp_ns = samples.truth.stamp_ns;
  const auto time_usec = static_cast<std::uint64_t>(stamp_ns / 1000);
  const auto unix_usec = static_cast<std::uint64_t>(samples.unix_ns / 1000);
  message_bytes_.clear();
  if (stamp_ns >= next_second_ns_) {
    next_second_ns_ = stamp_ns + math::kSecond_ns;
    add(mavlink::Heartbeat{});
    add(mavlink::SystemTime{unix_usec, static_cast<std::uint32_t>(time_usec / 1000)});
  }
  if (samples.navigation.gps) add(hil_gps(unix_usec, *samples.navigation.gps));
  if (state_due(time_usec)) add(hil_state(time_usec, samples.truth, samples.imu, site_));
  add(hil_sensor(time_usec, samples.imu, samples.navigation));
  if (!connection_.send(message_bytes_.data(), message_bytes_.size())) ++trouble_.unsent;
}

bool MavlinkAutopilot::state_due(std::uint64_t time_usec) {
  if (state_interval_us_ < 0 || time_usec < next_state_us_) return false;
  next_state_us_ = time_usec + static_cast<std::uint64_t>(state_interval_us_);
  return true;
}

void MavlinkAutopilot::receive(std::int64_t deadline_ns, std::vector<ReceivedControls>& controls) {
  const std::size_t size = connection_.receive(deadline_ns, received_.data(), received_.size());
  if (connection_.connections() != connection_number_) start_connection();
  parser_.feed(received_.data(), size, [&](const mavlink::Frame& frame) { on_frame(frame, controls); });
  trouble_.skipped = parser_.counts().skipped;
  trouble_.wrong_checksum = parser_.counts().wrong_checksum;
  log_trouble();
}

void MavlinkAutopilot::on_frame(const mavlink::Frame& frame, std::vector<ReceivedControls>& controls) {
  if (!is_from_autopilot(frame)) return;
  if (frame.message_id == mavlink::CommandLong::kId)
    on_command(mavlink::from_frame<mavlink::CommandLong>(frame));
  if (frame.message_id != mavlink::HilActuatorControls::kId) return;
  controls.push_back({mavlink::from_frame<mavlink::HilActuatorControls>(frame), runtime::monotonic_ns()});
  heard_ = true;
  lockstep_ = controls.back().lockstep();
}

// The first that sends controls or a heartbeat of an autopilot is the one.
bool MavlinkAutopilot::is_from_autopilot(const mavlink::Frame& frame) {
  const bool introduces =
      frame.message_id == mavlink::HilActuatorControls::kId ||
      (frame.message_id == mavlink::Heartbeat::kId &&
       mavlink::from_frame<mavlink::Heartbeat>(frame).autopilot != mavlink::Heartbeat::kNoAutopilot);
  if (!system_id_ && introduces) {
    system_id_ = frame.system_id;
    runtime::log_info("autopilot is MAVLink system {}", frame.system_id);
  }
  if (system_id_ == frame.system_id) {
    introduced_ = introduced_ || introduces;
    return true;
  }
  if (!system_id_) return frame.message_id == mavlink::CommandLong::kId;
  ++trouble_.other_system;
  other_system_id_ = frame.system_id;
  return false;
}

void MavlinkAutopilot::on_command(const mavlink::CommandLong& command) {
  if (command.command != mavlink::CommandLong::kSetMessageInterval) return;
  if (command.params[0] != static_cast<float>(mavlink::HilStateQuaternion::kId)) return;
  const float interval_us = command.params[1];
  if (!(std::abs(interval_us) < 1e9F)) return;
  state_interval_us_ = interval_us == 0.0F ? kDefaultStateIntervalUs : std::lround(interval_us);
}

void MavlinkAutopilot::log_trouble() {
  const std::uint64_t skipped = trouble_.skipped - logged_.skipped;
  const std::uint64_t wrong_checksum = trouble_.wrong_checksum - logged_.wrong_checksum;
  const std::uint64_t other_system = trouble_.other_system - logged_.other_system;
  const std::uint64_t unsent = trouble_.unsent - logged_.unsent;
  if (skipped + wrong_checksum + other_system + unsent == 0) return;
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (now_ns < log_due_ns_) return;
  log_due_ns_ = now_ns + kLogPeriodNs;
  logged_ = trouble_;
  if (skipped > 0)
    runtime::log_warning(
        "autopilot: ignored {} bytes that are no MAVLink frame, {} frames with a wrong checksum", skipped,
        wrong_checksum);
  if (other_system > 0)
    runtime::log_warning("autopilot: ignored {} messages of other systems than {}, the last of {}",
                         other_system, system_id_.value_or(0), other_system_id_);
  if (unsent > 0)
    runtime::log_warning("autopilot: {} samples were not sent: the link is slower than their rate", unsent);
}

}  // namespace swiftlet::services
