#include "swiftlet/ground/pages/recorded/flight_topics.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/mcap/attached_file.hpp"

namespace swiftlet::pages {
namespace {

constexpr const char* kRecorder = "swiftlet/recorder";

std::string metadata_value(const mcap::Reader& file, const std::string& name, const std::string& key) {
  for (const mcap::Metadata& metadata : file.metadata()) {
    const auto found = metadata.values.find(key);
    if (metadata.name == name && found != metadata.values.end()) return found->second;
  }
  return "";
}

// Of the control settings that the recorder attaches.
void read_pose_deviations(const mcap::Reader& file, const std::string& vehicle, FlightTopics& topics) {
  const std::optional<std::string> settings = mcap::attached_file(file, vehicle, "control.yaml");
  if (!settings) return;
  for (const auto& [key, value] : runtime::flatten_yaml(*settings, file.name() + "/control.yaml")) {
    if (key == "estimator.mocap_position_m")
      topics.pose_deviation_m = runtime::parse_number(value).value_or(0.0);
    if (key == "estimator.mocap_orientation_rad")
      topics.pose_deviation_rad = runtime::parse_number(value).value_or(0.0);
  }
}

std::int64_t least_delay_ns(const TopicTable& table) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < table.rows(); ++i) least = std::min(least, table.log_ns[i] - table.stamp_ns[i]);
  return least;
}

}  // namespace

FlightTopics read_flight_topics(const mcap::Reader& file, const std::string& vehicle) {
  const auto read = [&](const char* topic, const std::vector<std::string>& numbers,
                        const std::vector<std::string>& texts = {}) {
    return read_topic(file, "/" + vehicle + "/" + topic, numbers, texts);
  };
  FlightTopics topics;
  topics.truth = read("ground_truth", {"position_ned", "velocity_ned", "q_ned_from_frd", "body_rates_frd"});
  topics.estimate = read("estimate", {"position_ned", "velocity_ned", "q_ned_from_frd", "body_rates_frd",
                                      "gyro_bias", "accelerometer_bias", "pose_age_s", "standard_deviation",
                                      "pose_fault", "poses_accepted", "poses_refused", "resets"});
  topics.reference =
      read("reference", {"mode", "position_ned", "velocity_ned", "attitude_setpoint", "thrust_setpoint"});
  topics.imu = read("imu", {"specific_force_frd", "body_rates_frd"});
  topics.command = read("actuator_command", {"rotor_state", "rotor_count", "throttle"});
  topics.rotor_speeds = read("rotor_speeds", {"rotor_count", "speeds"});
  topics.battery = read("battery", {"voltage_v", "current_a", "state_of_charge"});
  topics.pose = read("mocap_pose", {"tracked", "position_ned", "q_ned_from_frd"});
  topics.status = read("control_status",
                       {"mode", "low_battery_voltage_v", "critical_battery_voltage_v", "saturated",
                        "deadline_misses", "step_time_max_us", "period_jitter_p99_us", "loop_delay_p50_s",
                        "loop_delay_p95_s", "delay_margin_s", "cycles"},
                       {"reason", "source_conflict", "setpoint_refusal"});
  topics.mission = read("mission_status", {"mission_id", "state", "item_index", "item_count"}, {"reason"});
  topics.vehicle =
      read("vehicle_info",
           {"sense_to_actuate_p50_us", "sense_to_actuate_p99_us", "sense_to_actuate_max_us", "unanswered"},
           {"name", "fault"});
  topics.requests = read("command", {"kind"});
  topics.request_results = read("command_ack", {"accepted"}, {"reason"});
  topics.simulated_time = metadata_value(file, kRecorder, "time") == "vehicle";
  const TopicTable& stamped = topics.estimate.rows() > 0 ? topics.estimate : topics.truth;
  if (stamped.rows() == 0)
    throw runtime::ConfigError(file.name(), 0, vehicle, "has neither estimate nor ground_truth");
  topics.log_minus_stamp_ns = least_delay_ns(stamped);
  read_pose_deviations(file, vehicle, topics);
  return topics;
}

bool is_flying(double mode) {
  return mode >= static_cast<double>(control::Mode::kTakingOff) &&
         mode <= static_cast<double>(control::Mode::kDescent);
}

std::int64_t zero_of(const FlightTopics& topics) {
  for (std::size_t i = 0; i < topics.status.rows(); ++i) {
    if (is_flying(topics.status.number("mode", i))) return topics.status.stamp_ns[i];
  }
  return topics.estimate.rows() > 0 ? topics.estimate.stamp_ns.front() : topics.truth.stamp_ns.front();
}

}  // namespace swiftlet::pages
