// The signals of the page, from the topics of a vehicle.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/pages/recorded/flight_topics.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::pages {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMmPerM = 1e3;
constexpr double kMsPerS = 1e3;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kBoundSigmas = 3.0;
constexpr std::int64_t kLongestInterpolationNs = 30'000'000;
constexpr std::size_t kMaxRotors = 8;

std::string element(const std::string& name, std::size_t i) { return name + "[" + std::to_string(i) + "]"; }

Vector3d vector_of(const TopicTable& table, const std::string& name, std::size_t row) {
  return {table.number(name + "[0]", row), table.number(name + "[1]", row), table.number(name + "[2]", row)};
}

Quaterniond quaternion_of(const TopicTable& table, const std::string& name, std::size_t row) {
  return {table.number(name + "[0]", row), table.number(name + "[1]", row), table.number(name + "[2]", row),
          table.number(name + "[3]", row)};
}

// Appends rows to a table of the flight.
class Rows {
 public:
  Rows(FlightLog& flight, const char* table, std::int64_t zero_ns)
      : table_(flight.tables[table]), zero_ns_(zero_ns) {}

  void begin(std::int64_t stamp_ns) {
    table_.time_s.push_back(static_cast<double>(stamp_ns - zero_ns_) / math::kNsPerS);
  }
  void add(const std::string& name, double value) {
    std::vector<double>& column = table_.signals[name];
    column.resize(table_.time_s.size() - 1, kNoValue);
    column.push_back(value);
  }
  void add(const std::array<const char*, 3>& names, const Vector3d& value) {
    for (int i = 0; i < 3; ++i) add(names[i], value[i]);
  }

 private:
  SignalTable& table_;
  std::int64_t zero_ns_;
};

constexpr std::array<const char*, 3> kAxes = {"north", "east", "down"};
constexpr std::array<const char*, 3> kVelocityAxes = {"v_north", "v_east", "v_down"};
constexpr std::array<const char*, 3> kEuler = {"roll", "pitch", "yaw"};
constexpr std::array<const char*, 3> kRates = {"p", "q", "r"};
constexpr std::array<const char*, 3> kRotation = {"rotation_north", "rotation_east", "rotation_down"};

struct Motion {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  Quaterniond attitude = Quaterniond::Identity();
};

Motion motion_at_row(const TopicTable& table, std::size_t row) {
  return {vector_of(table, "position_ned", row), vector_of(table, "velocity_ned", row),
          quaternion_of(table, "q_ned_from_frd", row)};
}

// Between rows that are close enough. The stamps that are asked for must ascend.
class MotionAt {
 public:
  explicit MotionAt(const TopicTable& table) : table_(table) {}

  std::optional<Motion> operator()(std::int64_t stamp_ns) {
    const std::vector<std::int64_t>& stamps = table_.stamp_ns;
    while (next_ < stamps.size() && stamps[next_] < stamp_ns) ++next_;
    if (next_ == stamps.size()) return std::nullopt;
    if (stamps[next_] == stamp_ns) return motion_at_row(table_, next_);
    if (next_ == 0 || stamps[next_] - stamps[next_ - 1] > kLongestInterpolationNs) return std::nullopt;
    const double share = static_cast<double>(stamp_ns - stamps[next_ - 1]) /
                         static_cast<double>(stamps[next_] - stamps[next_ - 1]);
    const Motion before = motion_at_row(table_, next_ - 1);
    const Motion after = motion_at_row(table_, next_);
    return Motion{before.position + share * (after.position - before.position),
                  before.velocity + share * (after.velocity - before.velocity),
                  before.attitude.slerp(share, after.attitude)};
  }

 private:
  const TopicTable& table_;
  std::size_t next_ = 0;
};

// NED, rad: from b to a.
Vector3d rotation_between(const Quaterniond& a, const Quaterniond& b) {
  return plant::rotation_vector((a * b.conjugate()).normalized());
}

// The last item of a mission that ended with a landing, vehicle clock.
struct LandingItem {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
};

std::vector<LandingItem> landing_items(const TopicTable& mission) {
  const std::string landed = control::to_string(control::Reason::kLanded);
  std::vector<LandingItem> landings;
  for (std::size_t end = 0; end < mission.rows(); ++end) {
    if (mission.text("reason", end) != landed) continue;
    std::size_t begin = end;
    while (begin > 0 && mission.number("mission_id", begin - 1) == mission.number("mission_id", end) &&
           mission.number("item_index", begin - 1) == mission.number("item_index", end))
      --begin;
    landings.push_back({mission.stamp_ns[begin], mission.stamp_ns[end]});
  }
  return landings;
}

// Errors count from take-off to landing: the ground stops the vehicle short of its reference.
bool is_tracked(double mode, std::int64_t stamp_ns, const std::vector<LandingItem>& landings) {
  return mode < static_cast<double>(control::Mode::kLanding) &&
         std::none_of(landings.begin(), landings.end(), [&](const LandingItem& landing) {
           return stamp_ns >= landing.from_ns && stamp_ns <= landing.to_ns;
         });
}

void add_path(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  const TopicTable& table = flight.has_truth ? topics.truth : topics.estimate;
  Rows rows(flight, "path", zero_ns);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Motion motion = motion_at_row(table, i);
    rows.begin(table.stamp_ns[i]);
    rows.add(kAxes, motion.position);
    rows.add(kVelocityAxes, motion.velocity);
    rows.add("speed", motion.velocity.norm());
    rows.add(kEuler, math::kDegPerRad * control::euler_angles(motion.attitude).vector());
    rows.add(kRates, vector_of(table, "body_rates_frd", i));
    const std::array<double, 4> q = {motion.attitude.w(), motion.attitude.x(), motion.attitude.y(),
                                     motion.attitude.z()};
    for (std::size_t k = 0; k < q.size(); ++k) rows.add(element("q", k), q[k]);
  }
}

void add_reference(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  MotionAt flown(flight.has_truth ? topics.truth : topics.estimate);
  const std::vector<LandingItem> landings = landing_items(topics.mission);
  Rows rows(flight, "reference", zero_ns);
  const TopicTable& table = topics.reference;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (!is_flying(table.number("mode", i))) continue;
    const Vector3d position = vector_of(table, "position_ned", i);
    const Vector3d velocity = vector_of(table, "velocity_ned", i);
    rows.begin(table.stamp_ns[i]);
    rows.add(kAxes, position);
    rows.add(kVelocityAxes, velocity);
    rows.add(kEuler,
             math::kDegPerRad * control::euler_angles(quaternion_of(table, "attitude_setpoint", i)).vector());
    rows.add("thrust", table.number("thrust_setpoint", i));
    if (!is_tracked(table.number("mode", i), table.stamp_ns[i], landings)) continue;
    const std::optional<Motion> motion = flown(table.stamp_ns[i]);
    if (!motion) continue;
    const Vector3d error = kMmPerM * (motion->position - position);
    rows.add({"error_north", "error_east", "error_down"}, error);
    rows.add("error_3d", error.norm());
    rows.add("speed_error", (motion->velocity - velocity).norm());
  }
}

void add_estimate(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  MotionAt truth(topics.truth);
  Rows rows(flight, "estimate", zero_ns);
  const TopicTable& table = topics.estimate;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    rows.begin(table.stamp_ns[i]);
    rows.add({"gyro_bias_x", "gyro_bias_y", "gyro_bias_z"}, vector_of(table, "gyro_bias", i));
    rows.add({"accelerometer_bias_x", "accelerometer_bias_y", "accelerometer_bias_z"},
             vector_of(table, "accelerometer_bias", i));
    rows.add("pose_age", kMsPerS * table.number("pose_age_s", i));
    rows.add("poses_refused", table.number("poses_refused", i));
    const auto bound = [&](std::size_t k) {
      return kBoundSigmas * table.number(element("standard_deviation", k), i);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      rows.add(std::string("bound_") + kAxes[k], kMmPerM * bound(k));
      rows.add(std::string("bound_") + kVelocityAxes[k], kMmPerM * bound(3 + k));
      rows.add(std::string("bound_") + kRotation[k], math::kDegPerRad * bound(6 + k));
    }
    const std::optional<Motion> motion = truth(table.stamp_ns[i]);
    if (!motion) continue;
    const Motion estimate = motion_at_row(table, i);
    rows.add({"deviation_north", "deviation_east", "deviation_down"},
             kMmPerM * (estimate.position - motion->position));
    rows.add({"deviation_v_north", "deviation_v_east", "deviation_v_down"},
             kMmPerM * (estimate.velocity - motion->velocity));
    rows.add({"deviation_rotation_north", "deviation_rotation_east", "deviation_rotation_down"},
             math::kDegPerRad * rotation_between(estimate.attitude, motion->attitude));
  }
}

// The standard deviation of a component at a stamp: that of the last estimate.
class DeviationAt {
 public:
  explicit DeviationAt(const TopicTable& estimate) : estimate_(estimate) {}
  void advance(std::int64_t stamp_ns) {
    while (row_ + 1 < estimate_.rows() && estimate_.stamp_ns[row_ + 1] <= stamp_ns) ++row_;
  }
  double operator()(std::size_t component) const {
    return estimate_.number(element("standard_deviation", component), row_);
  }

 private:
  const TopicTable& estimate_;
  std::size_t row_ = 0;
};

// Pose minus estimate at the time of the pose, with the deviation of both together.
void add_innovations(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  MotionAt estimate(topics.estimate);
  DeviationAt deviation(topics.estimate);
  Rows rows(flight, "innovation", zero_ns);
  const TopicTable& table = topics.pose;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const std::optional<Motion> motion = estimate(table.stamp_ns[i]);
    if (!motion || table.number("tracked", i) == 0.0) continue;
    deviation.advance(table.stamp_ns[i]);
    const Motion pose = motion_at_row(table, i);
    rows.begin(table.stamp_ns[i]);
    rows.add(kAxes, kMmPerM * (pose.position - motion->position));
    rows.add(kRotation, math::kDegPerRad * rotation_between(pose.attitude, motion->attitude));
    for (std::size_t k = 0; k < 3; ++k) {
      rows.add(std::string("bound_") + kAxes[k],
               kBoundSigmas * kMmPerM * std::hypot(deviation(k), topics.pose_deviation_m));
      rows.add(std::string("bound_") + kRotation[k],
               kBoundSigmas * math::kDegPerRad * std::hypot(deviation(6 + k), topics.pose_deviation_rad));
    }
  }
}

void add_imu(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  Rows rows(flight, "imu", zero_ns);
  for (std::size_t i = 0; i < topics.imu.rows(); ++i) {
    rows.begin(topics.imu.stamp_ns[i]);
    rows.add({"force_x", "force_y", "force_z"}, vector_of(topics.imu, "specific_force_frd", i));
    rows.add(kRates, vector_of(topics.imu, "body_rates_frd", i));
  }
}

void add_rotors(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  const auto add = [&](const char* name, const TopicTable& table, const std::string& column) {
    Rows rows(flight, name, zero_ns);
    for (std::size_t i = 0; i < table.rows(); ++i) {
      rows.begin(table.stamp_ns[i]);
      for (std::size_t k = 0; k < kMaxRotors && static_cast<double>(k) < table.number("rotor_count", i); ++k)
        rows.add(element("rotor", k + 1), table.number(element(column, k), i));
    }
  };
  add("command", topics.command, "throttle");
  add("rotor_speeds", topics.rotor_speeds, "speeds");
}

void add_supply(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  Rows battery(flight, "battery", zero_ns);
  for (std::size_t i = 0; i < topics.battery.rows(); ++i) {
    battery.begin(topics.battery.stamp_ns[i]);
    battery.add("voltage", topics.battery.number("voltage_v", i));
    battery.add("current", topics.battery.number("current_a", i));
    battery.add("charge", 100.0 * topics.battery.number("state_of_charge", i));
  }
}

double not_negative(double value) { return value < 0.0 ? kNoValue : value; }

void add_status(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  Rows status(flight, "status", zero_ns);
  const TopicTable& table = topics.status;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    status.begin(table.stamp_ns[i]);
    status.add("low_voltage", table.number("low_battery_voltage_v", i));
    status.add("critical_voltage", table.number("critical_battery_voltage_v", i));
    status.add("saturated", table.number("saturated", i));
    status.add("longest_step", table.number("step_time_max_us", i));
    status.add("jitter_p99", table.number("period_jitter_p99_us", i));
    status.add("loop_delay_p50", kMsPerS * not_negative(table.number("loop_delay_p50_s", i)));
    status.add("loop_delay_p95", kMsPerS * not_negative(table.number("loop_delay_p95_s", i)));
    status.add("delay_margin", kMsPerS * table.number("delay_margin_s", i));
  }
  Rows vehicle(flight, "vehicle", zero_ns);
  for (std::size_t i = 0; i < topics.vehicle.rows(); ++i) {
    vehicle.begin(topics.vehicle.stamp_ns[i]);
    vehicle.add("sense_to_actuate_p50", topics.vehicle.number("sense_to_actuate_p50_us", i));
    vehicle.add("sense_to_actuate_p99", topics.vehicle.number("sense_to_actuate_p99_us", i));
    vehicle.add("sense_to_actuate_max", topics.vehicle.number("sense_to_actuate_max_us", i));
  }
}

// From the write of an IMU sample to the write of the command that answers it, if the log times are of a clock.
void add_latency(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  if (topics.simulated_time) return;
  Rows rows(flight, "latency", zero_ns);
  std::size_t sample = 0;
  for (std::size_t i = 0; i < topics.command.rows(); ++i) {
    const std::int64_t stamp_ns = topics.command.stamp_ns[i];
    while (sample < topics.imu.rows() && topics.imu.stamp_ns[sample] < stamp_ns) ++sample;
    if (sample == topics.imu.rows()) return;
    if (topics.imu.stamp_ns[sample] != stamp_ns) continue;
    rows.begin(stamp_ns);
    rows.add("imu_to_command",
             static_cast<double>(topics.command.publish_ns[i] - topics.imu.publish_ns[sample]) / 1e3);
  }
}

}  // namespace

void add_signals(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  add_path(topics, zero_ns, flight);
  add_reference(topics, zero_ns, flight);
  add_estimate(topics, zero_ns, flight);
  add_innovations(topics, zero_ns, flight);
  add_imu(topics, zero_ns, flight);
  add_rotors(topics, zero_ns, flight);
  add_supply(topics, zero_ns, flight);
  add_status(topics, zero_ns, flight);
  add_latency(topics, zero_ns, flight);
  for (auto& [name, table] : flight.tables) {
    for (auto& [signal, values] : table.signals) values.resize(table.time_s.size(), kNoValue);
  }
}

}  // namespace swiftlet::pages
