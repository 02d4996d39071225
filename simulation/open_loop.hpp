// Open-loop simulation: given pulse widths, Eq. (1)-(28) and nothing else - no ground, drag, wind or noise,
// an ideal supply.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::ground {

// Pulse widths from a time on, until the next.
struct PulseWidths {
  std::int64_t time_ns = 0;
  plant::PerRotor throttle{};  // delta of Eq. (8)
};

// Columns of the three files, for a vehicle of rotor_count rotors.
// t,pwm1,...: s and microseconds; zero-order hold, the last row's time ends the run.
std::vector<std::string> pulse_columns(int rotor_count);
// px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,...: m and m/s NED, q_ned_from_frd, rad/s FRD, rad/s.
std::vector<std::string> state_columns(int rotor_count);

// Throw runtime::ConfigError with file, line, column, value and limit: pulse widths outside Eq. (8)'s range,
// times that do not rise, a quaternion that is off unit length by more than 1e-3 (within, it is normalised),
// a negative rotor speed, not exactly one state.
std::vector<PulseWidths> read_pulses(const runtime::CsvTable& table, const plant::Vehicle& vehicle);
plant::VehicleState read_state(const runtime::CsvTable& table, int rotor_count);

struct MotionRow {
  std::int64_t time_ns = 0;
  plant::VehicleState state;
};

// The motion from the first pulse time to the last, a row for each whole millisecond from the first on. At
// least two pulses. Throws std::runtime_error if the numbers run away.
std::vector<MotionRow> simulate_open_loop(const plant::Vehicle& vehicle, double supply_voltage_v,
                                          const plant::VehicleState& initial,
                                          const std::vector<PulseWidths>& pulses);

// t and state_columns(), each number in the shortest form that reads back as the same. The file appears whole
// or not at all. Throws std::runtime_error.
void write_motion(const std::string& path, const std::vector<MotionRow>& rows, int rotor_count);

}  // namespace swiftlet::ground
