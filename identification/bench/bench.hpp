// Identifies a vehicle from test bench data. Runs each experiment that has data, in an order in which later
// experiments use the results of earlier ones.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/identification/bench/esc.hpp"
#include "swiftlet/identification/bench/inertia.hpp"
#include "swiftlet/identification/bench/instruments.hpp"
#include "swiftlet/identification/bench/mass.hpp"
#include "swiftlet/identification/bench/motor_step.hpp"
#include "swiftlet/identification/bench/propeller.hpp"
#include "swiftlet/identification/bench/steady_motor.hpp"
#include "swiftlet/identification/bench/throttle_thrust.hpp"
#include "swiftlet/identification/bench/thrust_torque.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {

// Names of the experiments: the stems of their files.
inline constexpr const char* kMassName = "mass";
inline constexpr const char* kEscName = "esc";
inline constexpr const char* kThrustTorqueName = "thrust_torque";
inline constexpr const char* kSteadyMotorName = "steady_motor";
inline constexpr const char* kMotorStepName = "motor_step";
inline constexpr const char* kThrottleThrustName = "throttle_thrust";
inline constexpr std::array<const char*, 3> kInertiaNames = {"inertia_roll", "inertia_pitch", "inertia_yaw"};

// Data about one body axis: exactly one of the two set-ups.
struct InertiaData {
  std::optional<BifilarData> bifilar;
  std::optional<SwingData> swing;
};

struct BenchData {
  std::optional<std::vector<double>> mass_kg;
  std::optional<EscData> esc;
  std::optional<ThrustTorqueData> thrust_torque;
  std::optional<SteadyMotorData> steady_motor;
  std::optional<MotorStepData> motor_step;
  std::optional<ThrottleThrustData> throttle_thrust;
  std::array<std::optional<InertiaData>, 3> inertia;  // about roll, pitch and yaw axis
  std::optional<Propeller> propeller;
  Instruments instruments;
};

struct BenchIdentification {
  std::optional<Experiment> mass;
  std::optional<Experiment> esc;
  std::optional<Experiment> thrust;
  std::optional<Experiment> torque;
  PropellerCoefficients propeller;
  std::optional<Experiment> steady_motor;
  std::optional<MotorStep> motor_step;
  std::optional<Experiment> throttle_thrust;
  std::array<std::optional<Experiment>, 3> inertia;

  plant::Vehicle vehicle;                      // base vehicle with the identified parameters
  plant::VehicleUncertainty uncertainty;       // of the identified parameters
  std::map<std::string, std::string> sources;  // of the identified parameters, by key of the file: "motor.k2"
  std::vector<std::string> warnings;           // that concern several experiments
};

// BadData with the name of the experiment. The name is empty if there is no experiment at all.
class BenchError : public std::runtime_error {
 public:
  BenchError(std::string experiment, const BadData& fault)
      : std::runtime_error(fault.what()), experiment_(std::move(experiment)), row_(fault.row()) {}
  const std::string& experiment() const { return experiment_; }
  std::optional<std::size_t> row() const { return row_; }

 private:
  std::string experiment_;
  std::optional<std::size_t> row_;
};

// Reports that an experiment begins, with the number of finished experiments and of all. Called repeatedly
// during a long fit.
using BenchProgress = std::function<void(const std::string& experiment, std::size_t done, std::size_t all)>;

// Parameters that are not measured keep the values of base. The vehicle may violate plant::validate(): the
// caller checks it. Throws BenchError, also if data contains no experiment.
BenchIdentification identify_bench(const BenchData& data, const plant::Vehicle& base,
                                   const BenchProgress& progress = {});

}  // namespace swiftlet::identification
