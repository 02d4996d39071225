#include "swiftlet/services/plant/plant_reporter.hpp"

#include <fmt/core.h>

#include "swiftlet/services/messages/vehicle_info.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000'000;
constexpr std::int64_t kTroublePeriodNs = 10'000'000'000;

messages::msg::VehicleInfo describe(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                                    const std::string& autopilot) {
  messages::msg::VehicleInfo info;
  messages::describe(vehicle, info);
  info.simulated(true);
  info.autopilot() = autopilot;
  info.imu_rate_hz(settings.imu.rate_hz);
  info.control_levels(settings.control_levels.bits());
  return info;
}

void update(messages::msg::VehicleInfo& info, const PlantReport& report, const std::string& fault) {
  info.stamp_ns(report.stamp_ns);
  info.boot(report.boot);
  info.sequence_number(info.sequence_number() + 1);
  info.rotors_running(report.rotors_running);
  info.paused(report.paused);
  info.answered(report.answered);
  info.unanswered(report.unanswered);
  info.late(report.late);
  info.sense_to_actuate_p50_us(static_cast<double>(report.answer_p50_ns) * 1e-3);
  info.sense_to_actuate_p99_us(static_cast<double>(report.answer_p99_ns) * 1e-3);
  info.sense_to_actuate_p999_us(static_cast<double>(report.answer_p999_ns) * 1e-3);
  info.sense_to_actuate_max_us(static_cast<double>(report.answer_max_ns) * 1e-3);
  info.fault() = fault;
}

}  // namespace

PlantReporter::PlantReporter(dds::Node& node, const plant::Vehicle& vehicle,
                             const plant::SimulationSettings& settings, const std::string& autopilot)
    : publisher_(node.publish(messages::topics::kVehicleInfo)),
      info_(describe(vehicle, settings, autopilot)),
      timeout_fault_(fmt::format("no actuator command for {:g} s", settings.command_timeout_s)),
      command_hold_s_(settings.command_hold_s),
      faults_(settings.faults) {}

void PlantReporter::publish_due(const PlantReport& report) {
  log_faults(report.stamp_ns);
  const bool changed = report.rotors_running != last_report_.rotors_running ||
                       report.timed_out != last_report_.timed_out || report.paused != last_report_.paused ||
                       (report.paused && report.stamp_ns != last_report_.stamp_ns);
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (!changed && now_ns < due_ns_) return;
  due_ns_ = now_ns + kPeriodNs;
  const std::string fault = report.timed_out ? timeout_fault_ : "";
  update(info_, report, fault);
  publisher_.publish(info_);
  log_rotors(report, fault);
  if (now_ns >= trouble_due_ns_ && log_trouble(report)) trouble_due_ns_ = now_ns + kTroublePeriodNs;
  last_report_ = report;
}

void PlantReporter::log_faults(std::int64_t stamp_ns) {
  const auto begins = [stamp_ns](const plant::Fault& fault) {
    return static_cast<double>(stamp_ns) * 1e-9 >= fault.at_s;
  };
  for (auto fault = faults_.begin(); fault != faults_.end();) {
    if (!begins(*fault)) {
      ++fault;
      continue;
    }
    runtime::log_info("fault: {}, at_s {:g}, for_s {:g}", to_string(fault->kind), fault->at_s, fault->for_s);
    fault = faults_.erase(fault);
  }
}

void PlantReporter::log_rotors(const PlantReport& report, const std::string& fault) {
  if (report.rotors_running == last_report_.rotors_running) return;
  if (report.rotors_running) {
    runtime::log_info("rotors started");
  } else if (report.timed_out) {
    runtime::log_error("rotors stopped: {}", fault);
  } else {
    runtime::log_info("rotors stopped on command");
  }
}

// Logs commands that ceased or were refused, and slips, since the last call. Returns true if there were any.
bool PlantReporter::log_trouble(const PlantReport& report) {
  const bool outdated = report.outdated > logged_report_.outdated;
  const bool refused = report.refused_commands > logged_report_.refused_commands;
  const bool slipped = report.slips > logged_report_.slips;
  if (outdated) {
    runtime::log_warning("commands ceased for more than {:g} s, {} times: obeyed none meanwhile",
                         command_hold_s_, report.outdated - logged_report_.outdated);
  }
  if (refused) {
    runtime::log_warning("refused {} actuator commands, the last: {}",
                         report.refused_commands - logged_report_.refused_commands, report.refusal.text);
  }
  if (slipped) {
    runtime::log_warning("fell behind real time: delayed simulated time {} times, by {:.1f} ms in total",
                         report.slips - logged_report_.slips,
                         static_cast<double>(report.slipped_ns - logged_report_.slipped_ns) * 1e-6);
  }
  logged_report_ = report;
  return outdated || refused || slipped;
}

void PlantReporter::log_end(const PlantReport& last) {
  runtime::log_info(
      "ended after {:.1f} s of simulated time: {} commands obeyed, {} refused; sense to actuate p50 {:.0f} "
      "us, "
      "p99 {:.0f} us, max {:.0f} us over {} samples, {} unanswered; behind real time {} times, {:.1f} ms",
      static_cast<double>(last.stamp_ns) * 1e-9, last.commands, last.refused_commands,
      static_cast<double>(last.answer_p50_ns) * 1e-3, static_cast<double>(last.answer_p99_ns) * 1e-3,
      static_cast<double>(last.answer_max_ns) * 1e-3, last.answered, last.unanswered, last.slips,
      static_cast<double>(last.slipped_ns) * 1e-6);
}

}  // namespace swiftlet::services
