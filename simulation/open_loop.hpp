// Open-loop simulation: Eq. (1)-(28) driven by given pulse widths, without ground, drag, wind or noise, with
// an ideal supply.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::simulation {

// Pulse widths that are held from time_ns to the time of the next row.
struct PulseWidths {
  std::int64_t time_ns = 0;
  plant::PerRotor throttle{};  // delta of Eq. (8), computed from the pulse widths
};

// Columns of the CSV files for a vehicle with rotor_count rotors.
// t,pwm1,...: s and microseconds. Zero-order hold; the time of the last row ends the run.
std::vector<std::string> pulse_columns(int rotor_count);
// px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,...: m and m/s in NED, q_ned_from_frd, body rates in rad/s FRD,
// rotor speeds in rad/s.
std::vector<std::string> state_columns(int rotor_count);

// Both throw io::ConfigError with file, line, column, value and limit for pulse widths outside the range
// of Eq. (8), times that do not increase, a run longer than 600 s, a quaternion whose length differs from 1
// by more than 1e-3 (otherwise it is normalised), a negative rotor speed, and a number of states other than
// one.
std::vector<PulseWidths> read_pulses(const io::Table& table, const plant::Vehicle& vehicle);
plant::VehicleState read_state(const io::Table& table, int rotor_count);

struct MotionRow {
  std::int64_t time_ns = 0;
  plant::VehicleState state;
};

// Simulates the motion from the first pulse time to the last, with one row per millisecond from the first on.
// At least two rows of pulses. Throws std::runtime_error if the body rate reaches 1e4 rad/s or the state is
// not finite.
std::vector<MotionRow> simulate_open_loop(const plant::Vehicle& vehicle, double supply_voltage_v,
                                          const plant::VehicleState& initial,
                                          const std::vector<PulseWidths>& pulses);

// Writes t and state_columns() as CSV. Each number has the shortest form that parses to the same value. The
// file has its name only when it is complete. Throws std::runtime_error if it cannot be written.
void write_motion(const std::string& path, const std::vector<MotionRow>& rows, int rotor_count);

}  // namespace swiftlet::simulation
