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

#include "swiftlet/analysis/pages/recorded/flight_pieces.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::pages {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMmPerM = 1e3;
constexpr double kMsPerS = 1e3;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kBoundSigmas = 3.0;

std::string element(const std::string& name, std::size_t i) { return name + "[" + std::to_string(i) + "]"; }

Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
Quaterniond quaternion(const std::array<double, 4>& q) { return {q[0], q[1], q[2], q[3]}; }

// Appends rows to a table of the flight.
class Rows {
 public:
  Rows(FlightLog& flight, const char* table, std::int64_t zero_ns)
      : table_(flight.tables[table]), zero_ns_(zero_ns) {}

  void begin(std::int64_t stamp_ns) {
    next_ = 0;
    table_.time_s.push_back(static_cast<double>(stamp_ns - zero_ns_) / math::kNsPerS);
  }
  void add(const std::string& name, double value) {
    std::vector<double>& column = column_of(name);
    column.resize(table_.time_s.size() - 1, kNoValue);
    column.push_back(value);
  }
  void add(const std::array<const char*, 3>& names, const Vector3d& value) {
    for (int i = 0; i < 3; ++i) add(names[i], value[i]);
  }

 private:
  // Most rows have the same columns in the same order, which are found without a search.
  std::vector<double>& column_of(const std::string& name) {
    if (next_ == columns_.size() || columns_[next_].first != name) {
      columns_.resize(next_);
      columns_.emplace_back(name, &table_.signals[name]);
    }
    return *columns_[next_++].second;
  }

  SignalTable& table_;
  std::int64_t zero_ns_;
  std::vector<std::pair<std::string, std::vector<double>*>> columns_;  // of the last row
  std::size_t next_ = 0;
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
  Vector3d rates = Vector3d::Zero();
};

template <class Row>
Motion motion_of(const Row& row) {
  return {vector(row.position_ned), vector(row.velocity_ned), quaternion(row.q_ned_from_frd),
          vector(row.body_rates_frd)};
}

// The stamps that are asked for must ascend.
template <class Row>
class MotionAt {
 public:
  explicit MotionAt(const std::vector<Row>& rows) : rows_(rows), after_(rows.begin()) {}

  std::optional<Motion> operator()(std::int64_t stamp_ns) {
    while (after_ != rows_.end() && after_->stamp_ns < stamp_ns) ++after_;
    const std::optional<Row> row = record::motion_at(rows_, after_, stamp_ns);
    return row ? std::optional(motion_of(*row)) : std::nullopt;
  }

 private:
  const std::vector<Row>& rows_;
  typename std::vector<Row>::const_iterator after_;
};

// NED, rad: from b to a.
Vector3d rotation_between(const Quaterniond& a, const Quaterniond& b) {
  return math::rotation_vector((a * b.conjugate()).normalized());
}

template <class Row>
void add_path(const std::vector<Row>& flown, std::int64_t zero_ns, FlightLog& flight) {
  Rows rows(flight, "path", zero_ns);
  for (const Row& row : flown) {
    const Motion motion = motion_of(row);
    rows.begin(row.stamp_ns);
    rows.add(kAxes, motion.position);
    rows.add(kVelocityAxes, motion.velocity);
    rows.add("speed", motion.velocity.norm());
    rows.add(kEuler, math::kDegPerRad * math::euler_angles(motion.attitude).vector());
    rows.add(kRates, motion.rates);
    const std::array<double, 4> q = {motion.attitude.w(), motion.attitude.x(), motion.attitude.y(),
                                     motion.attitude.z()};
    for (std::size_t k = 0; k < q.size(); ++k) rows.add(element("q", k), q[k]);
  }
}

// Errors count from take-off to landing: the ground stops the vehicle short of its reference.
template <class Row>
void add_reference(const record::Flight& recorded, const std::vector<Row>& flown_rows, std::int64_t zero_ns,
                   FlightLog& flight) {
  MotionAt flown(flown_rows);
  const std::vector<record::Window> landings = record::landing_items(recorded);
  const auto is_landing = [&](const record::ReferenceRow& row) {
    return row.mode >= static_cast<int>(control::Mode::kLanding) ||
           std::any_of(landings.begin(), landings.end(), [&](const record::Window& landing) {
             return row.stamp_ns >= landing.from_ns && row.stamp_ns < landing.to_ns;
           });
  };
  Rows rows(flight, "reference", zero_ns);
  for (const record::ReferenceRow& row : recorded.reference) {
    if (!is_flying(row.mode)) continue;
    const Vector3d position = vector(row.position_ned);
    const Vector3d velocity = vector(row.velocity_ned);
    rows.begin(row.stamp_ns);
    rows.add(kAxes, position);
    rows.add(kVelocityAxes, velocity);
    rows.add(kEuler, math::kDegPerRad * math::euler_angles(quaternion(row.q_ned_from_frd)).vector());
    rows.add("thrust", row.thrust_n);
    if (is_landing(row)) continue;
    const std::optional<Motion> motion = flown(row.stamp_ns);
    if (!motion) continue;
    const Vector3d error = kMmPerM * (motion->position - position);
    rows.add({"error_north", "error_east", "error_down"}, error);
    rows.add("error_3d", error.norm());
    rows.add("speed_error", (motion->velocity - velocity).norm());
  }
}

void add_estimate(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight) {
  MotionAt truth(recorded.truth);
  Rows rows(flight, "estimate", zero_ns);
  for (const record::EstimateRow& row : recorded.estimate) {
    rows.begin(row.stamp_ns);
    rows.add({"gyro_bias_x", "gyro_bias_y", "gyro_bias_z"}, vector(row.gyro_bias));
    rows.add({"accelerometer_bias_x", "accelerometer_bias_y", "accelerometer_bias_z"},
             vector(row.accelerometer_bias));
    rows.add("pose_age", kMsPerS * row.pose_age_s);
    rows.add("poses_refused", row.poses_refused);
    const auto bound = [&](std::size_t k) { return kBoundSigmas * row.standard_deviation[k]; };
    for (std::size_t k = 0; k < 3; ++k) {
      rows.add(std::string("bound_") + kAxes[k], kMmPerM * bound(k));
      rows.add(std::string("bound_") + kVelocityAxes[k], kMmPerM * bound(3 + k));
      rows.add(std::string("bound_") + kRotation[k], math::kDegPerRad * bound(6 + k));
    }
    const std::optional<Motion> motion = truth(row.stamp_ns);
    if (!motion) continue;
    const Motion estimate = motion_of(row);
    rows.add({"deviation_north", "deviation_east", "deviation_down"},
             kMmPerM * (estimate.position - motion->position));
    rows.add({"deviation_v_north", "deviation_v_east", "deviation_v_down"},
             kMmPerM * (estimate.velocity - motion->velocity));
    rows.add({"deviation_rotation_north", "deviation_rotation_east", "deviation_rotation_down"},
             math::kDegPerRad * rotation_between(estimate.attitude, motion->attitude));
  }
}

// Pose minus estimate at the time of the pose, with the deviation of both together. That of the estimate is the one that was
// published last.
void add_innovations(const record::Flight& recorded, const PoseDeviation& pose_deviation,
                     std::int64_t zero_ns, FlightLog& flight) {
  MotionAt estimate_at(recorded.estimate);
  auto estimate = recorded.estimate.begin();
  Rows rows(flight, "innovation", zero_ns);
  for (const plant::PoseSample& pose : recorded.poses) {
    const std::optional<Motion> motion = estimate_at(pose.stamp_ns);
    if (!motion || !pose.tracked) continue;
    while (estimate + 1 != recorded.estimate.end() && (estimate + 1)->stamp_ns <= pose.stamp_ns) ++estimate;
    rows.begin(pose.stamp_ns);
    rows.add(kAxes, kMmPerM * (pose.position_ned - motion->position));
    rows.add(kRotation, math::kDegPerRad * rotation_between(pose.q_ned_from_frd, motion->attitude));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<double, 15>& deviation = estimate->standard_deviation;
      rows.add(std::string("bound_") + kAxes[k],
               kBoundSigmas * kMmPerM * std::hypot(deviation[k], pose_deviation.position_m));
      rows.add(std::string("bound_") + kRotation[k],
               kBoundSigmas * math::kDegPerRad * std::hypot(deviation[6 + k], pose_deviation.rotation_rad));
    }
  }
}

void add_imu(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight) {
  Rows rows(flight, "imu", zero_ns);
  for (const plant::ImuSample& imu : recorded.imu) {
    rows.begin(imu.stamp_ns);
    rows.add({"force_x", "force_y", "force_z"}, imu.specific_force_frd);
    rows.add(kRates, imu.body_rates_frd);
  }
}

void add_rotors(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight) {
  const auto add = [](Rows& rows, const auto& row, const plant::PerRotor& values) {
    rows.begin(row.stamp_ns);
    for (std::size_t k = 0; k < values.size() && static_cast<int>(k) < row.rotor_count; ++k)
      rows.add(element("rotor", k + 1), values[k]);
  };
  Rows commands(flight, "command", zero_ns);
  for (const plant::ActuatorCommand& row : recorded.commands) add(commands, row, row.throttle);
  Rows speeds(flight, "rotor_speeds", zero_ns);
  for (const plant::RotorSpeedSample& row : recorded.rotor_speeds) add(speeds, row, row.speeds);
}

void add_supply(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight) {
  Rows battery(flight, "battery", zero_ns);
  for (const plant::BatterySample& row : recorded.batteries) {
    battery.begin(row.stamp_ns);
    battery.add("voltage", row.voltage_v);
    battery.add("current", row.current_a);
    battery.add("charge", 100.0 * row.state_of_charge);
  }
}

// In charts, yaw is continuous: without a jump at a full turn, from within half a turn of north on; the reference is on the turn
// that is nearest to the flown yaw. A heading that is printed is from 0 to 360 degrees.
void make_yaw_continuous(FlightLog& flight) {
  const auto near = [](double yaw_deg, double other_deg) {
    return yaw_deg + 360.0 * std::round((other_deg - yaw_deg) / 360.0);
  };
  SignalTable& path = flight.tables["path"];
  SignalTable& reference = flight.tables["reference"];
  std::vector<double>& flown = path.signals["yaw"];
  for (std::size_t i = 1; i < flown.size(); ++i) flown[i] = near(flown[i], flown[i - 1]);
  std::size_t k = 0;
  std::vector<double>& wanted = reference.signals["yaw"];
  for (std::size_t i = 0; i < wanted.size() && !flown.empty(); ++i) {
    while (k + 1 < flown.size() && path.time_s[k + 1] <= reference.time_s[i]) ++k;
    wanted[i] = near(wanted[i], flown[k]);
  }
}

double not_negative(double value) { return value < 0.0 ? kNoValue : value; }

void add_status(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight) {
  Rows status(flight, "status", zero_ns);
  for (const record::StatusRow& row : recorded.status) {
    status.begin(row.stamp_ns);
    status.add("low_voltage", row.low_battery_voltage_v);
    status.add("critical_voltage", row.critical_battery_voltage_v);
    status.add("saturated", row.saturated);
    status.add("longest_step", row.step_time_max_us);
    status.add("jitter_p99", row.period_jitter_p99_us);
    status.add("loop_delay_p50", kMsPerS * not_negative(row.loop_delay_p50_s));
    status.add("loop_delay_p95", kMsPerS * not_negative(row.loop_delay_p95_s));
    status.add("delay_margin", kMsPerS * row.delay_margin_s);
  }
  Rows vehicle(flight, "vehicle", zero_ns);
  for (const record::VehicleRow& row : recorded.vehicle) {
    vehicle.begin(row.stamp_ns);
    vehicle.add("sense_to_actuate_p50", row.sense_to_actuate_p50_us);
    vehicle.add("sense_to_actuate_p99", row.sense_to_actuate_p99_us);
    vehicle.add("sense_to_actuate_max", row.sense_to_actuate_max_us);
  }
}

// From the write of an IMU sample to the write of the command that answers it, if the log times are of a clock.
void add_latency(const record::Flight& recorded, const RecordedClock& clock, FlightLog& flight) {
  if (clock.simulated_time) return;
  Rows rows(flight, "latency", clock.zero_ns);
  std::size_t sample = 0;
  for (std::size_t i = 0; i < recorded.commands.size(); ++i) {
    const std::int64_t stamp_ns = recorded.commands[i].stamp_ns;
    while (sample < recorded.imu.size() && recorded.imu[sample].stamp_ns < stamp_ns) ++sample;
    if (sample == recorded.imu.size()) return;
    if (recorded.imu[sample].stamp_ns != stamp_ns) continue;
    rows.begin(stamp_ns);
    rows.add("imu_to_command",
             static_cast<double>(recorded.commands_sent_ns[i] - recorded.imu_sent_ns[sample]) / 1e3);
  }
}

}  // namespace

bool is_flying(int mode) {
  return mode >= static_cast<int>(control::Mode::kTakingOff) &&
         mode <= static_cast<int>(control::Mode::kDescent);
}

void add_signals(const record::Flight& recorded, const RecordedClock& clock, const PoseDeviation& deviation,
                 FlightLog& flight) {
  const std::int64_t zero_ns = clock.zero_ns;
  if (flight.has_truth) {
    add_path(recorded.truth, zero_ns, flight);
    add_reference(recorded, recorded.truth, zero_ns, flight);
  } else {
    add_path(recorded.estimate, zero_ns, flight);
    add_reference(recorded, recorded.estimate, zero_ns, flight);
  }
  make_yaw_continuous(flight);
  add_estimate(recorded, zero_ns, flight);
  add_innovations(recorded, deviation, zero_ns, flight);
  add_imu(recorded, zero_ns, flight);
  add_rotors(recorded, zero_ns, flight);
  add_supply(recorded, zero_ns, flight);
  add_status(recorded, zero_ns, flight);
  add_latency(recorded, clock, flight);
  for (auto& [name, table] : flight.tables) {
    for (auto& [signal, values] : table.signals) values.resize(table.time_s.size(), kNoValue);
  }
}

}  // namespace swiftlet::pages
