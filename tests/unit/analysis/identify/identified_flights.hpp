// Simulated flights with known truth, for tests of identification.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/identification/bench/sentences.hpp"

namespace swiftlet::analysis {

inline ground::LaunchConfiguration plan_of(const std::string& mission) {
  const tests::TemporaryFolder folder;
  ground::FlyOptions options;
  options.launch_mode = ground::LaunchMode::kInProcess;
  options.mission = mission;
  options.record = folder.path().string();
  return ground::plan_flight(options);
}

// The nominal vehicle with randomly perturbed parameters and the same mass.
inline plant::Vehicle perturbed(const plant::Vehicle& nominal, std::uint64_t seed) {
  math::RandomStream random(seed, 20250919);
  plant::Vehicle out = nominal;
  out.rotor.thrust *= random.uniform(0.9, 1.1);
  out.motor.time_constant_s *= random.uniform(0.8, 1.2);
  const double size = random.uniform(0.8, 1.2);
  for (int axis = 0; axis < 3; ++axis) out.inertia(axis, axis) *= size * random.uniform(0.95, 1.05);
  out.inertia(2, 2) = std::min(out.inertia(2, 2), 0.98 * (out.inertia(0, 0) + out.inertia(1, 1)));
  out.linear_drag = random.uniform(0.002, 0.01);
  return out;
}

inline identification::FlightLog flown(const ground::LaunchConfiguration& plan, const plant::Vehicle& truth,
                                       std::uint64_t seed) {
  simulation::ClosedLoop loop(truth, plan.vehicle, plan.simulation, plan.control, seed);
  record::Flight recorded;
  loop.sensors = &recorded;
  control::Mission mission = plan.mission.mission;
  mission.id = 1;
  const simulation::SimulatedFlight flight = simulation::fly(loop, mission, plan.planned_duration_s, {});
  EXPECT_TRUE(flight.completed) << flight.reason;
  return flight_log_of(recorded);
}

// Delays the commands to the motors.
inline void delay_commands(ground::LaunchConfiguration& plan, double delay_s) {
  plant::Fault late;
  late.kind = plant::FaultKind::kCommandsDelay;
  late.at_s = 0.0;
  late.for_s = 1000.0;
  late.delay_s = delay_s;
  plan.simulation.faults = {late};
}

// Swaps the motors of each side.
inline void swap_motors(identification::FlightLog& log) {
  const auto swap = [](plant::PerRotor& of) {
    std::swap(of[0], of[1]);
    std::swap(of[2], of[3]);
  };
  for (plant::PerRotor& command : log.command) swap(command);
  for (plant::PerRotor& speeds : log.rotor_speeds) swap(speeds);
}

inline void expect_refused(const std::vector<identification::FlightLog>& logs, const plant::Vehicle& base,
                           const std::string& part_of_sentence,
                           const identification::FlightOptions& options = {}) {
  const auto work = [&] { identification::identify_flight(logs, base, options); };
  EXPECT_TRUE(tests::contains({tests::refused(work)}, part_of_sentence));
}

}  // namespace swiftlet::analysis
