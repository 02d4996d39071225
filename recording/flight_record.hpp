// Record of a flight on the ground: all telemetry samples, in storage that is allocated before the flight.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "swiftlet/recording/sensor_record.hpp"
#include "swiftlet/recording/track.hpp"

namespace swiftlet::ground {

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
  int mode = 0;                              // ControlStatus_Constants::MODE_*
  std::array<double, 3> position_ned{};      // m
  std::array<double, 3> velocity_ned{};      // m/s
  std::array<double, 3> acceleration_ned{};  // m/s^2
  double yaw_rad = 0.0;
  std::array<double, 4> q_ned_from_frd{};  // w, x, y, z: attitude that the position law asks for
  double thrust_n = 0.0;                   // commanded
  std::array<double, 3> moment_frd{};      // N m, commanded
};

struct EstimateRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> position_ned{};
  std::array<double, 3> velocity_ned{};
};

struct MissionRow {
  std::int64_t stamp_ns = 0;
  std::uint64_t mission_id = 0;
  int state = 0;  // MissionStatus_Constants
  std::uint32_t item_index = 0;
};

struct FlightRecord {
  // capacity: rows of each track
  explicit FlightRecord(std::size_t capacity)
      : truth(capacity), reference(capacity), estimate(capacity), mission(capacity) {}

  void clear() noexcept {
    truth.clear();
    reference.clear();
    estimate.clear();
    mission.clear();
    if (sensors) sensors->clear();
  }

  Track<TruthRow> truth;
  Track<ReferenceRow> reference;
  Track<EstimateRow> estimate;
  Track<MissionRow> mission;
  std::unique_ptr<SensorRecord> sensors;  // null if the sensors are not recorded
};

// Half-open interval of stamps [from_ns, to_ns) in which errors are evaluated.
struct Window {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;

  double duration_s() const { return static_cast<double>(to_ns - from_ns) * 1e-9; }
};

}  // namespace swiftlet::ground
