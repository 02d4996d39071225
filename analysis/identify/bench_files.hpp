// Reads and writes the data of a test bench: a folder with one CSV for each experiment and bench.yaml for
// common settings.
//
//   mass.csv             mass
//   esc.csv              supply_voltage, throttle or pulse_width, motor_voltage
//   thrust_torque.csv    speed, and thrust or torque or both
//   steady_motor.csv     motor_voltage, speed
//   motor_step.csv       time, speed, and motor_voltage if it was recorded
//   throttle_thrust.csv  supply_voltage, throttle or pulse_width, thrust (of one rotor)
//   inertia_roll.csv, inertia_pitch.csv, inertia_yaw.csv
//                        length, separation, period (bifilar pendulum), or arm, period (physical pendulum)
//
// At least one experiment is required. Headers declare `name [unit]`, as in io/measurements.hpp. All keys of
// bench.yaml are optional:
//   base_vehicle: kaylion     gives the parameters that are not measured: a file in this folder, a path, or
//                             the name of a vehicle in the configuration
//   name: kl2                 name of the identified vehicle
//   propeller:
//     radius: {value: 0.03, unit: m, source: ruler}
//     air_density: {value: 1.2, unit: kg/m^3, source: barometer}
//   instruments:              standard deviations of single readings, where known: speed, supply_voltage and
//                             motor_voltage (V), thrust (N), torque (N*m)
//     speed: {value: 3, unit: rad/s, source: data sheet}
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::analysis {

inline constexpr const char* kBenchSettingsFile = "bench.yaml";

// The settings of bench.yaml. Texts are empty if their key is absent.
struct BenchSettings {
  std::string base_vehicle;  // name, or path if it is a file in the folder
  int base_vehicle_line = 0;
  std::string name;
  std::optional<identification::Propeller> propeller;
  identification::Instruments instruments;
};

// File and line numbers of an experiment.
struct BenchFile {
  std::string file;
  std::vector<int> lines;  // line of each row
};

struct Bench {
  identification::BenchData data;
  std::map<std::string, BenchFile> files;  // by the experiment's name
};

// Throw io::ConfigError or InputError, also for a CSV with an unknown name. Pulse widths are converted
// to throttles with esc, Eq. (8).
BenchSettings load_bench_settings(const std::filesystem::path& folder);
Bench load_bench(const std::filesystem::path& folder, const BenchSettings& settings, const plant::Esc& esc);

// Writes the experiments of data to folder and creates it if necessary. Writes no physical pendulum data.
// Throws std::runtime_error.
void write_bench(const std::filesystem::path& folder, identification::BenchData data,
                 const std::string& settings_yaml);

}  // namespace swiftlet::analysis
