// A flight of one vehicle in memory: what it measured, did and said, a row for each message. Filled by a simulation in this
// process, or from a recorded file (record/file/flight_reader.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::record {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();  // the message has no such member

struct TruthRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_ned{};    // m
  std::array<double, 3> velocity_ned{};    // m/s
  std::array<double, 4> q_ned_from_frd{};  // w, x, y, z
  std::array<double, 3> body_rates_frd{};  // rad/s
  std::array<double, 8> rotor_speeds{};    // rad/s
  int rotor_count = 0;
  double supply_voltage_v = 0.0;
  bool on_ground = false;
};

struct ReferenceRow {
  std::int64_t stamp_ns = 0;
  int mode = 0;                              // control::Mode
  std::array<double, 3> position_ned{};      // m
  std::array<double, 3> velocity_ned{};      // m/s
  std::array<double, 3> acceleration_ned{};  // m/s^2
  double yaw_rad = 0.0;
  std::array<double, 4> q_ned_from_frd{};  // w, x, y, z: attitude that the position law asks for
  double thrust_n = 0.0;                   // commanded
  std::array<double, 3> moment_frd{};      // N m, commanded
};

// What the controller thinks of the vehicle's motion.
struct EstimateRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_ned{};
  std::array<double, 3> velocity_ned{};
  std::array<double, 4> q_ned_from_frd{};
  std::array<double, 3> body_rates_frd{};
  std::array<double, 3> gyro_bias{};            // rad/s
  std::array<double, 3> accelerometer_bias{};   // m/s^2
  std::array<double, 15> standard_deviation{};  // of Estimate.standard_deviation
  double pose_age_s = 0.0;
  int pose_fault = 0;  // Estimate_Constants::POSE_FAULT_*
  double poses_accepted = 0.0;
  double poses_refused = 0.0;
  double resets = 0.0;
};

struct MissionRow {
  std::int64_t stamp_ns = 0;
  std::uint64_t mission_id = 0;
  int state = 0;  // control::MissionState
  std::uint32_t item_index = 0;
  std::uint32_t item_count = 0;
  std::string reason{};
};

// What control says of itself.
struct StatusRow {
  std::int64_t stamp_ns = 0;
  int mode = 0;  // control::Mode
  std::string reason;
  std::string source_conflict;
  std::string setpoint_refusal;
  double low_battery_voltage_v = kNotGiven;
  double critical_battery_voltage_v = kNotGiven;
  double saturated = kNotGiven;
  double step_time_max_us = kNotGiven;
  double period_jitter_p99_us = kNotGiven;
  double loop_delay_p50_s = kNotGiven;  // < 0: not known
  double loop_delay_p95_s = kNotGiven;
  double delay_margin_s = kNotGiven;
};

// What the vehicle says of itself.
struct VehicleRow {
  std::int64_t stamp_ns = 0;
  std::string name;  // of the model
  std::string fault;
  double sense_to_actuate_p50_us = kNotGiven;
  double sense_to_actuate_p99_us = kNotGiven;
  double sense_to_actuate_max_us = kNotGiven;
};

// A request of a ground tool, or the answer to one. Neither has a stamp of the vehicle.
struct RequestRow {
  std::int64_t log_ns = 0;  // log time of the file
  int kind = 0;             // control::RequestKind; of a request
  bool accepted = false;    // of an answer
  std::string reason{};     // of an answer
};

// A fault that the simulation injected.
struct FaultRow {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  std::string text{};  // "push, at_s 8, for_s 0.05": its kind and its times in the simulation file
};

// The rows of each member are in ascending order of their stamps, each stamp once but in mission, status and vehicle. Numbers
// of motion are finite.
struct Flight {
  std::vector<TruthRow> truth;
  std::vector<ReferenceRow> reference;
  std::vector<EstimateRow> estimate;
  std::vector<MissionRow> mission;
  std::vector<plant::ImuSample> imu;
  std::vector<plant::ActuatorCommand> commands;  // stamp: of the IMU sample from which it was computed
  std::vector<plant::PoseSample> poses;          // those without a tracked body too
  std::vector<plant::BatterySample> batteries;
  std::vector<plant::RotorSpeedSample> rotor_speeds;
  std::vector<FaultRow> faults;
  // Only of a recorded file:
  std::vector<StatusRow> status;
  std::vector<VehicleRow> vehicle;
  std::vector<RequestRow> requests;
  std::vector<RequestRow> answers;
  std::vector<std::int64_t> imu_sent_ns;       // publish times of `imu`
  std::vector<std::int64_t> commands_sent_ns;  // publish times of `commands`
  // From the vehicle's clock to that of the log: log time minus stamp, of the estimate (or truth) with the least delay.
  std::int64_t log_minus_stamp_ns = 0;
};

}  // namespace swiftlet::record
