// Identification of the vehicle from a simulated flight with known truth.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/identification/flight/flight.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/analysis/identify/identified_flights.hpp"

namespace swiftlet::analysis::flight_identification_test {

using identification::FlightIdentification;
using identification::FlightLog;

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
  double square = 0.0;  // sum of their squares
};

// The channels in a log.
enum class Channels { kAll, kNoSpeeds };

std::map<std::string, Tally> recover(Channels channels, int seeds) {
  ground::LaunchConfiguration plan = plan_of("identification");
  if (channels == Channels::kNoSpeeds) plan.simulation.rotor_speed_rate_hz = 0.0;
  std::map<std::string, Tally> tallies;
  for (int seed = 1; seed <= seeds; ++seed) {
    const plant::Vehicle truth = perturbed(plan.vehicle, static_cast<std::uint64_t>(seed));
    const FlightLog log = flown(plan, truth, static_cast<std::uint64_t>(seed));
    const FlightIdentification found = identification::identify_flight({log}, plan.vehicle, {});
    EXPECT_TRUE(found.converged) << seed;
    for (const auto& [name, value] : truth_of(truth)) {
      const identification::ParameterEstimate* const estimate = found.find(name);
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
    const std::string key = (channels == Channels::kAll ? "all " : "no speeds ") + name;
    std::printf("%-32s covered %d of %d, bias %+.3f %%, RMS %.3f %%\n", key.c_str(), tally.covered,
                tally.count, 100.0 * tally.bias / tally.count, 100.0 * std::sqrt(tally.square / tally.count));
  }
  return tallies;
}

// The bounds of the mean relative error are a few times the error of 30 seeds.
void expect_unbiased(const std::map<std::string, Tally>& tallies,
                     const std::map<std::string, double>& bounds) {
  for (const auto& [name, tally] : tallies)
    EXPECT_LT(std::abs(tally.bias) / tally.count, bounds.at(name)) << name;
}

TEST(FlightIdentification, RecoversTheVehicleWithinItsIntervals) {
  const int seeds = tests::draws(3, 30);
  const auto tallies = recover(Channels::kAll, seeds);
  expect_unbiased(tallies, {{"motor.time_constant", 1e-4},
                            {"rotor.thrust_factor", 1e-4},
                            {"inertia.xx", 2e-3},
                            {"inertia.yy", 2e-3},
                            {"inertia.zz", 3e-3},
                            {"linear_drag", 0.01}});
  int covered = 0;
  int count = 0;
  for (const auto& [name, tally] : tallies) {
    EXPECT_EQ(tally.count, seeds) << name;
    covered += tally.covered;
    count += tally.count;
  }
  EXPECT_GE(covered, 0.9 * count);
}

TEST(FlightIdentification, RecoversTheVehicleWithoutRotorSpeeds) {
  const auto tallies = recover(Channels::kNoSpeeds, tests::draws(2, 30));
  for (const auto& [name, tally] : tallies)
    EXPECT_GE(tally.covered, tests::least_covered(tally.count)) << name;
  expect_unbiased(tallies, {{"motor.time_constant", 5e-3},
                            {"rotor.thrust_factor", 1e-3},
                            {"inertia.xx", 3e-3},
                            {"inertia.yy", 3e-3},
                            {"inertia.zz", 3e-3},
                            {"linear_drag", 0.02}});
}

TEST(FlightIdentification, IdentifiesMassWhenThrustIsKnown) {
  const ground::LaunchConfiguration plan = plan_of("identification");
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

TEST(FlightIdentification, RefusesLogsWithDifferentChannels) {
  const ground::LaunchConfiguration plan = plan_of("identification");
  const FlightLog log = flown(plan, plan.vehicle, 5);
  FlightLog without_poses = log;
  without_poses.poses.clear();
  expect_refused({log, without_poses}, plan.vehicle, "hold different data");
}

TEST(FlightIdentification, IdentifiesACommandDelay) {
  ground::LaunchConfiguration plan = plan_of("identification");
  plan.simulation.rotor_speed_rate_hz = 0.0;
  delay_commands(plan, 0.006);
  const FlightIdentification found =
      identification::identify_flight({flown(plan, plan.vehicle, 7)}, plan.vehicle, {});
  EXPECT_NEAR(found.find("delay.rates")->value, 0.006, 0.0015);
}

TEST(FlightIdentification, IdentifiesAndCorrectsAPoseDelay) {
  const ground::LaunchConfiguration plan = plan_of("identification");
  const plant::Vehicle truth = perturbed(plan.vehicle, 6);
  FlightLog log = flown(plan, truth, 6);
  const FlightIdentification on_time = identification::identify_flight({log}, plan.vehicle, {});
  for (identification::FlightPose& pose : log.poses) pose.time_s += 0.03;
  const FlightIdentification late = identification::identify_flight({log}, plan.vehicle, {});
  EXPECT_NEAR(on_time.find("delay.poses")->value, 0.0, 3e-4);
  EXPECT_NEAR(late.find("delay.poses")->value, 0.03, 3e-4);
  EXPECT_NEAR(on_time.find("linear_drag")->value / truth.linear_drag, 1.0, 0.03);
  for (const char* const same : {"linear_drag", "inertia.xx", "accelerometer_offset.z"})
    EXPECT_NEAR(late.find(same)->value / on_time.find(same)->value, 1.0, 1e-3) << same;
  EXPECT_TRUE(tests::contains(late.findings, "poses are stamped"));
  EXPECT_FALSE(tests::contains(on_time.findings, "poses are stamped"));
}

TEST(FlightIdentification, ReportsUnexcitedParametersOfAHover) {
  const ground::LaunchConfiguration plan = plan_of(tests::TemporaryFolder().write("hover.yaml", R"(name: hover
frame: ned
tolerance_m: 0.2
items:
  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.3, hold_s: 20}
  - {kind: land, speed_m_s: 0.3}
)"));
  const FlightIdentification found =
      identification::identify_flight({flown(plan, plan.vehicle, 2)}, plan.vehicle, {});
  for (const char* const inertia :
       {"inertia.xx: p changes by", "inertia.yy: q changes by", "inertia.zz: r changes by"})
    EXPECT_TRUE(tests::contains(found.unexcited, inertia));
  for (const char* const parameter :
       {"inertia.xx", "inertia.yy", "inertia.zz", "rotor_to_rate.roll", "rotor_to_rate.yaw"})
    EXPECT_FALSE(found.find(parameter)->identifiable) << parameter;
  EXPECT_TRUE(found.find("rotor.thrust_factor")->identifiable);
  EXPECT_EQ(found.vehicle.inertia(2, 2), plan.vehicle.inertia(2, 2));
}

TEST(FlightIdentification, RefusesSwappedMotors) {
  const ground::LaunchConfiguration plan = plan_of("identification");
  FlightLog log = flown(plan, plan.vehicle, 4);
  swap_motors(log);
  expect_refused({log}, plan.vehicle, "are the motors in its order");
}

}  // namespace swiftlet::analysis::flight_identification_test
