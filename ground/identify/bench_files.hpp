// A test bench as a folder: one CSV an experiment, and bench.yaml for what is the same for all of them.
//
//   mass.csv             mass
//   esc.csv              supply_voltage, throttle or pulse_width, motor_voltage
//   thrust_torque.csv    speed, and thrust or torque or both
//   steady_motor.csv     motor_voltage, speed
//   motor_step.csv       time, speed, and motor_voltage if it was recorded
//   throttle_thrust.csv  supply_voltage, throttle or pulse_width, thrust (of one rotor)
//   inertia_roll.csv, inertia_pitch.csv, inertia_yaw.csv
//                        length, separation, period (two strings), or arm, period (swung about an axis)
//
// All are optional, one at least. Headers declare `name [unit]`, as io/measurements.hpp reads
// them. bench.yaml may hold
//   base_vehicle: kaylion     what is not measured is from there: a file of this folder, a path, or a name of the configuration
//   name: kl2                 of the identified vehicle
//   propeller: {radius: {value: 0.03, unit: m, source: ruler}, air_density: {value: 1.2, unit: kg/m^3, source: barometer}}
//   instruments:              standard deviations of single readings, where known
//     speed: {value: 3, unit: rad/s, source: data sheet}     likewise supply_voltage, motor_voltage (V), thrust (N), torque (N*m)
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

inline constexpr const char* kBenchSettingsFile = "bench.yaml";

// What bench.yaml says; empty texts where it says nothing.
struct BenchSettings {
  std::string base_vehicle;  // a path, if it is a file of the folder
  int base_vehicle_line = 0;
  std::string name;
  std::optional<identification::Propeller> propeller;
  identification::Instruments instruments;
};

// Where an experiment's rows stand.
struct BenchFile {
  std::string file;
  std::vector<int> lines;  // of each row
};

struct Bench {
  identification::BenchData data;
  std::map<std::string, BenchFile> files;  // by the experiment's name
};

// Throw runtime::ConfigError or InputError. A CSV of another name is refused, lest a misspelt one go
// unnoticed. esc turns pulse widths into throttles, Eq. (8).
BenchSettings load_bench_settings(const std::filesystem::path& folder);
Bench load_bench(const std::filesystem::path& folder, const BenchSettings& settings, const plant::Esc& esc);

// Writes the experiments of data into folder, which is made. Two-string tests only. Throws
// std::runtime_error.
void write_bench(const std::filesystem::path& folder, const identification::BenchData& data,
                 const std::string& settings_yaml);

}  // namespace swiftlet::ground
