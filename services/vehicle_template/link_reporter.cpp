#include "swiftlet/services/vehicle_template/link_reporter.hpp"

#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/services/messages/vehicle_info.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

using protocol::text_of;

constexpr std::int64_t kPeriodNs = 1'000'000'000;
constexpr std::int64_t kFramesPeriodNs = 10'000'000'000;

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

std::string quantiles(const runtime::LatencyHistogram& times) {
  return fmt::format("p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us", us(times.quantile_ns(0.5)),
                     us(times.quantile_ns(0.99)), us(times.max_ns()));
}

}  // namespace

LinkReporter::LinkReporter(dds::Node& node, const plant::Vehicle& vehicle, std::string link,
                           std::uint32_t boot)
    : link_(std::move(link)),
      rotor_count_(vehicle.rotor_count()),
      publisher_(node.publish(messages::topics::kVehicleInfo)) {
  messages::describe(vehicle, info_);
  info_.boot(boot);
}

void LinkReporter::update(const LinkMeasurements& measurements) {
  updated_ = true;
  const LinkMeasurements before = std::exchange(last_, measurements);
  changed_ = changed_ || before.state.rotors_running != last_.state.rotors_running ||
             before.link.state != last_.link.state || before.link.sessions != last_.link.sessions;
  log_link(before);
  log_rotors(before);
  if (!clock_logged_ && last_.link.clock) {
    clock_logged_ = true;
    const std::int64_t now_ns = runtime::monotonic_ns();
    runtime::log_info(
        "microcontroller's clock minus this host's monotonic clock: {:+.6f} s (within {:.3f} ms)",
        static_cast<double>(last_.link.clock->offset_at(now_ns)) * 1e-9,
        last_.link.clock->uncertainty_ns(now_ns) * 1e-6);
  }
  if (runtime::monotonic_ns() >= frames_due_ns_) log_frames();
}

void LinkReporter::publish_due() {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (!updated_ || (!changed_ && now_ns < due_ns_)) return;
  changed_ = false;
  due_ns_ = now_ns + kPeriodNs;
  const runtime::LatencyHistogram& times = last_.sample_to_motor;
  info_.stamp_ns(protocol::ns_of_us(last_.state.stamp_us));
  info_.sequence_number(info_.sequence_number() + 1);
  if (last_.link.microcontroller) {
    info_.simulated(last_.link.microcontroller->simulated != 0);
    info_.imu_rate_hz(last_.link.microcontroller->imu_rate_hz);
  }
  info_.rotors_running(is_connected() && last_.state.rotors_running != 0);
  info_.answered(last_.answered);
  info_.unanswered(last_.samples - last_.answered);
  info_.late(last_.late);
  info_.sense_to_actuate_p50_us(us(times.quantile_ns(0.5)));
  info_.sense_to_actuate_p99_us(us(times.quantile_ns(0.99)));
  info_.sense_to_actuate_p999_us(us(times.quantile_ns(0.999)));
  info_.sense_to_actuate_max_us(us(times.max_ns()));
  info_.fault() = fault_of_vehicle();
  publisher_.publish(info_);
}

std::string LinkReporter::fault_of_vehicle() const {
  if (is_connected()) return std::string(text_of(last_.state.fault));
  const std::string why = last_.link.state == LinkState::kClosed
                              ? std::generic_category().message(last_.link.open_fault)
                              : "no answer";
  return fmt::format("{:.127}", "no link to the microcontroller: " + link_ + ": " + why);
}

std::string LinkReporter::fault_of_microcontroller() const {
  if (!last_.link.microcontroller) return "";
  const protocol::HelloReply& it = *last_.link.microcontroller;
  const std::string who = fmt::format("microcontroller '{}' at {}", text_of(it.name), link_);
  if (it.version != protocol::kVersion) {
    return fmt::format("{} speaks version {} of the protocol, must be version {}", who, it.version,
                       protocol::kVersion);
  }
  if (it.rotor_count != rotor_count_) {
    return fmt::format("{} has {} rotors, must be the {} of vehicle {}", who, it.rotor_count, rotor_count_,
                       info_.name().c_str());
  }
  if (it.imu_rate_hz != 500 && it.imu_rate_hz != 1000)
    return fmt::format("{} samples its IMU at {} Hz, must be 500 or 1000", who, it.imu_rate_hz);
  return "";
}

void LinkReporter::log_link(const LinkMeasurements& before) const {
  const bool was_connected = before.link.state == LinkState::kConnected;
  if (was_connected && !is_connected()) runtime::log_error("{}", fault_of_vehicle());
  if (is_connected() && before.link.sessions != last_.link.sessions) {
    const protocol::HelloReply& it = *last_.link.microcontroller;
    runtime::log_info(
        "session {} with microcontroller '{}': protocol {}, {} rotors, IMU at {} Hz, command time-out {} ms",
        last_.link.sessions, text_of(it.name), it.version, it.rotor_count, it.imu_rate_hz,
        it.command_timeout_ms);
    return;
  }
  if (is_connected() || was_connected) return;
  const bool is_new =
      before.link.state != last_.link.state || before.link.open_fault != last_.link.open_fault;
  if (is_new) runtime::log_warning("{}", fault_of_vehicle());
}

void LinkReporter::log_rotors(const LinkMeasurements& before) const {
  if (before.state.rotors_running == last_.state.rotors_running) return;
  const std::string_view fault = text_of(last_.state.fault);
  if (last_.state.rotors_running != 0) {
    runtime::log_info("rotors started");
  } else if (!fault.empty()) {
    runtime::log_error("rotors stopped by the microcontroller: {}", fault);
  } else {
    runtime::log_info("rotors stopped on command");
  }
}

// Frames and commands that did not get through since the last line.
void LinkReporter::log_frames() {
  const auto since = [](std::uint32_t now, std::uint32_t before) {
    return now >= before ? now - before : now;
  };
  const protocol::FrameDecoder::Counts& up = last_.link.frames;
  const protocol::FrameDecoder::Counts& up_before = logged_.link.frames;
  const std::uint32_t broken = since(up.refused, up_before.refused);
  const std::uint32_t lost = since(up.lost, up_before.lost);
  const std::uint32_t broken_down = since(last_.state.frames_refused, logged_.state.frames_refused);
  const std::uint32_t lost_down = since(last_.state.frames_lost, logged_.state.frames_lost);
  const std::uint32_t refused = since(last_.state.commands_refused, logged_.state.commands_refused);
  if (broken + lost + broken_down + lost_down + refused == 0) return;
  if (broken + lost + broken_down + lost_down > 0) {
    runtime::log_warning("frames from the microcontroller: {} broken, {} lost; to it: {} broken, {} lost",
                         broken, lost, broken_down, lost_down);
  }
  if (refused > 0)
    runtime::log_warning("the microcontroller refused {} commands, the last: {}", refused,
                         text_of(last_.state.refusal));
  logged_ = last_;
  frames_due_ns_ = runtime::monotonic_ns() + kFramesPeriodNs;
}

void LinkReporter::log_end() const {
  const protocol::FrameDecoder::Counts& up = last_.link.frames;
  runtime::log_info("link: sample to host {}; sample to motor {}; {} of {} samples answered, {} late",
                    quantiles(last_.sample_to_host), quantiles(last_.sample_to_motor), last_.answered,
                    last_.samples, last_.late);
  runtime::log_info(
      "ended: {} sessions; {} frames from the microcontroller, {} broken, {} lost; to it: {}, {} broken, {} "
      "lost, {} not sent; {} commands obeyed, {} refused",
      last_.link.sessions, up.received, up.refused, up.lost, last_.state.frames_received,
      last_.state.frames_refused, last_.state.frames_lost, last_.link.unsent, last_.state.commands_obeyed,
      last_.state.commands_refused);
}

}  // namespace swiftlet::services
