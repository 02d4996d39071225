// From a flight back to the vehicle that flew it, in the plant, whose truth is known.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "ground/flight_log_files.hpp"
#include "ground/flight_plan.hpp"
#include "ground/in_process_flight.hpp"
#include "ground/simulation/simulated_flight.hpp"
#include "identification/flight.hpp"
#include "plant/simulation/random.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground {
namespace {

using identification::FlightIdentification;
using identification::FlightLog;

FlightPlan plan_of(const std::string& mission) {
  const tests::TemporaryFolder folder;
  FlyOptions options;
  options.parties = Parties::kInProcess;
  options.mission = mission;
  options.record = folder.path().string();
  return plan_flight(options);
}

// What may have come off the workbench in place of the plan's vehicle, of a weight that is known.
plant::Vehicle another(const plant::Vehicle& nominal, std::uint64_t seed) {
  plant::RandomStream random(seed, 20250919);
  plant::Vehicle out = nominal;
  out.rotor.thrust *= random.uniform(0.9, 1.1);
  out.motor.time_constant_s *= random.uniform(0.8, 1.2);
  const double size = random.uniform(0.8, 1.2);
  for (int axis = 0; axis < 3; ++axis) out.inertia(axis, axis) *= size * random.uniform(0.95, 1.05);
  out.inertia(2, 2) = std::min(out.inertia(2, 2), 0.98 * (out.inertia(0, 0) + out.inertia(1, 1)));
  out.linear_drag = random.uniform(0.002, 0.01);
  return out;
}

FlightLog flown(const FlightPlan& plan, const plant::Vehicle& truth, std::uint64_t seed) {
  ClosedLoop loop(truth, plan.vehicle, plan.simulation, plan.control, seed);
  SensorRecord record(plan.record_capacity());
  loop.sensors = &record;
  control::Mission mission = plan.mission.mission;
  mission.id = 1;
  const SimulatedFlight flight = fly(loop, mission, plan.planned_duration_s, {});
  EXPECT_TRUE(flight.completed) << flight.reason;
  return flight_log_of(record);
}

std::map<std::string, double> truth_of(const plant::Vehicle& v) {
  return {{"motor.time_constant", v.motor.time_constant_s},
          {"rotor.thrust_factor", v.rotor.thrust},
          {"inertia.xx", v.inertia(0, 0)},
          {"inertia.yy", v.inertia(1, 1)},
          {"inertia.zz", v.inertia(2, 2)},
          {"linear_drag", v.linear_drag}};
}

struct Tally {
  int count = 0;
  int covered = 0;
  double bias = 0.0;    // sum of relative errors
  double square = 0.0;  // of their squares
};

// What is left out of a log of all that a vehicle can send.
enum class Left { kAll, kNoSpeeds };

std::map<std::string, Tally> recover(Left left, int seeds) {
  FlightPlan plan = plan_of("identification");
  if (left == Left::kNoSpeeds) plan.simulation.rotor_speed_rate_hz = 0.0;
  std::map<std::string, Tally> tallies;
  for (int seed = 1; seed <= seeds; ++seed) {
    const plant::Vehicle truth = another(plan.vehicle, static_cast<std::uint64_t>(seed));
    const FlightLog log = flown(plan, truth, static_cast<std::uint64_t>(seed));
    const FlightIdentification found = identification::identify_flight({log}, plan.vehicle, {});
    EXPECT_TRUE(found.converged) << seed;
    for (const auto& [name, value] : truth_of(truth)) {
      const identification::Estimate* const estimate = found.find(name);
      if (estimate == nullptr) {
        ADD_FAILURE() << name << " was not estimated";
        continue;
      }
      const double error = estimate->value / value - 1.0;
      Tally& tally = tallies[name];
      ++tally.count;
      tally.covered += estimate->low() <= value && value <= estimate->high() ? 1 : 0;
      tally.bias += error;
      tally.square += error * error;
    }
  }
  for (const auto& [name, tally] : tallies) {
    const std::string key = (left == Left::kAll ? "all " : "no speeds ") + name;
    std::printf("%-32s covered %d of %d, bias %+.3f %%, RMS %.3f %%\n", key.c_str(), tally.covered,
                tally.count, 100.0 * tally.bias / tally.count, 100.0 * std::sqrt(tally.square / tally.count));
  }
  return tallies;
}

// Bounds of the mean relative error are a few times what 30 seeds leave.
void expect_unbiased(const std::map<std::string, Tally>& tallies,
                     const std::map<std::string, double>& bounds) {
  for (const auto& [name, tally] : tallies)
    EXPECT_LT(std::abs(tally.bias) / tally.count, bounds.at(name)) << name;
}

TEST(FlightIdentification, RecoversAVehicleWithItsIntervals) {
  constexpr int kSeeds = 12;
  const auto tallies = recover(Left::kAll, kSeeds);
  expect_unbiased(tallies, {{"motor.time_constant", 1e-4},
                            {"rotor.thrust_factor", 1e-4},
                            {"inertia.xx", 2e-3},
                            {"inertia.yy", 2e-3},
                            {"inertia.zz", 3e-3},
                            {"linear_drag", 0.01}});
  int covered = 0;
  int count = 0;
  for (const auto& [name, tally] : tallies) {
    EXPECT_EQ(tally.count, kSeeds) << name;
    covered += tally.covered;
    count += tally.count;
  }
  EXPECT_GE(covered, 0.9 * count);
}

TEST(FlightIdentification, RecoversAVehicleThatDoesNotTellItsRotorSpeeds) {
  constexpr int kSeeds = 5;
  expect_unbiased(recover(Left::kNoSpeeds, kSeeds), {{"motor.time_constant", 5e-3},
                                                     {"rotor.thrust_factor", 1e-3},
                                                     {"inertia.xx", 3e-3},
                                                     {"inertia.yy", 3e-3},
                                                     {"inertia.zz", 3e-3},
                                                     {"linear_drag", 0.02}});
}

TEST(FlightIdentification, TellsMassInsteadWhereTheThrustIsKnown) {
  const FlightPlan plan = plan_of("identification");
  plant::Vehicle truth = plan.vehicle;
  truth.mass_kg *= 1.1;
  truth.inertia *= 1.1;
  identification::FlightOptions options;
  options.known = identification::Known::kThrust;
  const FlightIdentification found =
      identification::identify_flight({flown(plan, truth, 3)}, plan.vehicle, options);
  EXPECT_NEAR(found.vehicle.mass_kg / truth.mass_kg, 1.0, 0.005);
  EXPECT_NEAR(found.vehicle.inertia(0, 0) / truth.inertia(0, 0), 1.0, 0.01);
  EXPECT_EQ(found.vehicle.rotor.thrust, plan.vehicle.rotor.thrust);
  EXPECT_EQ(found.find("rotor.thrust_factor"), nullptr);
}

TEST(FlightIdentification, RefusesLogsWithoutPosesOrVoltage) {
  const FlightPlan plan = plan_of("identification");
  const FlightLog log = flown(plan, plan.vehicle, 5);
  const auto refusal = [&](const FlightLog& without) -> std::string {
    try {
      identification::identify_flight({without}, plan.vehicle, {});
    } catch (const identification::BadData& fault) {
      return fault.what();
    }
    return "";
  };
  FlightLog blind = log;
  blind.poses.clear();
  EXPECT_NE(refusal(blind).find("has 0 poses"), std::string::npos) << refusal(blind);
  FlightLog powerless = log;
  powerless.supply_voltage_v.clear();
  EXPECT_NE(refusal(powerless).find("has no supply voltage"), std::string::npos) << refusal(powerless);
}

TEST(FlightIdentification, TellsADelayOfTheCommands) {
  FlightPlan plan = plan_of("identification");
  plan.simulation.rotor_speed_rate_hz = 0.0;
  plant::Fault late;
  late.kind = plant::FaultKind::kCommandsDelay;
  late.at_s = 0.0;
  late.for_s = 1000.0;
  late.delay_s = 0.006;
  plan.simulation.faults = {late};
  const FlightIdentification found =
      identification::identify_flight({flown(plan, plan.vehicle, 7)}, plan.vehicle, {});
  EXPECT_NEAR(found.find("delay.rates")->value, 0.006, 0.0015);
}

TEST(FlightIdentification, SaysWhatAHoverDoesNotTell) {
  const FlightPlan plan = plan_of(tests::TemporaryFolder().write("hover.yaml", R"(name: hover
frame: ned
tolerance_m: 0.2
items:
  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.3, hold_s: 20}
  - {kind: land, speed_m_s: 0.3}
)"));
  const FlightIdentification found =
      identification::identify_flight({flown(plan, plan.vehicle, 2)}, plan.vehicle, {});
  std::string all;
  for (const std::string& sentence : found.unexcited) all += sentence + "\n";
  EXPECT_NE(all.find("inertia.zz: the interval is"), std::string::npos) << all;
  EXPECT_NE(all.find("coupling about roll"), std::string::npos) << all;
  EXPECT_EQ(found.vehicle.inertia(2, 2), plan.vehicle.inertia(2, 2));
}

TEST(FlightIdentification, RefusesMotorsInAnotherOrder) {
  const FlightPlan plan = plan_of("identification");
  FlightLog log = flown(plan, plan.vehicle, 4);
  for (std::size_t row = 0; row < log.size(); ++row) {
    std::swap(log.rotor_speeds[row][0], log.rotor_speeds[row][1]);
    std::swap(log.rotor_speeds[row][2], log.rotor_speeds[row][3]);
    std::swap(log.command[row][0], log.command[row][1]);
    std::swap(log.command[row][2], log.command[row][3]);
  }
  try {
    identification::identify_flight({log}, plan.vehicle, {});
    ADD_FAILURE() << "was not refused";
  } catch (const identification::BadData& fault) {
    EXPECT_NE(std::string(fault.what()).find("are the motors in its order"), std::string::npos)
        << fault.what();
  }
}

}  // namespace
}  // namespace swiftlet::ground
