// Identification from commands and IMU alone: of simulated flights with known truth, and of a real vehicle.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/motor_order.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/analysis/identify/identified_flights.hpp"

namespace swiftlet::analysis::command_flight_test {

using identification::FlightIdentification;
using identification::FlightLog;
using identification::ParameterEstimate;
using identification::SpeedSource;

constexpr double kDelayS = 0.006;  // added to the commands of simulated flights

ground::LaunchConfiguration delayed_plan() {
  ground::LaunchConfiguration plan = plan_of("identification");
  plan.simulation.rotor_speed_rate_hz = 0.0;
  delay_commands(plan, kDelayS);
  return plan;
}

FlightLog with_commands_and_imu(FlightLog log) {
  log.poses.clear();
  log.supply_voltage_v.clear();
  log.rotor_speeds.clear();
  return log;
}

std::map<std::string, double> truth_of(const plant::Vehicle& v) {
  const plant::Effectiveness effectiveness = plant::effectiveness(v);
  std::map<std::string, double> out = {{"motor.time_constant", v.motor.time_constant_s}};
  const char* const names[3] = {"thrust_to_rate.roll", "thrust_to_rate.pitch", "thrust_to_rate.yaw"};
  for (int axis = 0; axis < 3; ++axis)
    out[names[axis]] = v.mass_kg * effectiveness.row(1 + axis).cwiseAbs().mean() / v.inertia(axis, axis);
  return out;
}

// Results of several flights of vehicles whose parameters and batteries differ from those of the plan.
struct Tally {
  int count = 0;
  int covered = 0;
  double bias = 0.0;    // sum of errors in half widths of their intervals
  double worst = 0.0;   // largest error in half widths
  double widest = 0.0;  // largest relative half width
};

std::map<std::string, Tally> recover(const ground::LaunchConfiguration& plan, const char* what, int seeds) {
  std::map<std::string, Tally> tallies;
  for (int i = 1; i <= seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    plant::Vehicle truth = perturbed(plan.vehicle, seed);
    truth.battery.internal_resistance_ohm *= i % 2 == 0 ? 1.2 : 0.8;
    const FlightIdentification found =
        identification::identify_flight({with_commands_and_imu(flown(plan, truth, seed))}, plan.vehicle, {});
    EXPECT_EQ(found.source, SpeedSource::kCommanded);
    EXPECT_TRUE(found.converged) << seed;
    for (const auto& [name, value] : truth_of(truth)) {
      const ParameterEstimate& estimate = *found.find(name);
      Tally& tally = tallies[name];
      ++tally.count;
      tally.covered += estimate.low() <= value && value <= estimate.high() ? 1 : 0;
      const double error = (estimate.value - value) / estimate.half_width;
      tally.bias += error;
      tally.worst = std::max(tally.worst, std::abs(error));
      tally.widest = std::max(tally.widest, estimate.half_width / value);
      std::printf("%s %d %-22s %9.5g +- %.2g, truth %9.5g\n", what, i, name.c_str(), estimate.value,
                  estimate.half_width, value);
    }
    std::printf("%s %d delay of rates %.5f +- %.5f\n", what, i, found.find("delay.rates")->value,
                found.find("delay.rates")->half_width);
    for (const identification::PredictionError& error : found.errors) {
      EXPECT_LT(error.one_step, error.persistence_one_step) << error.quantity;
      EXPECT_LT(error.half_second, error.persistence_half_second) << error.quantity;
    }
  }
  for (const auto& [name, tally] : tallies) {
    std::printf("%-10s %-22s covered %d of %d; in half widths bias %+.2f, worst %.2f; widest %.2f %%\n", what,
                name.c_str(), tally.covered, tally.count, tally.bias / tally.count, tally.worst,
                100.0 * tally.widest);
  }
  return tallies;
}

// The intervals must cover the truth and be narrow. A half width is two standard deviations of the error, so
// 1 error in 10,000 exceeds two half widths, and 1 mean of n errors in 300 exceeds 1.5 / sqrt(n). The vehicle
// files give moments of inertia to 25 %: the gains must be narrower than this, the lag to 5 %.
void expect_true_and_narrow(const std::map<std::string, Tally>& tallies) {
  for (const auto& [name, tally] : tallies) {
    EXPECT_GE(tally.covered, tests::least_covered(tally.count)) << name;
    EXPECT_LT(tally.worst, 2.0) << name;
    EXPECT_LT(std::abs(tally.bias) / tally.count, tests::bound_of_mean(1.5, tally.count)) << name;
    EXPECT_LT(tally.widest, name == "motor.time_constant" ? 0.05 : 0.25) << name;
  }
}

TEST(CommandFlight, RecoversLagAndGains) {
  expect_true_and_narrow(recover(delayed_plan(), "calm", tests::draws(1, 8)));
}

TEST(CommandFlight, RecoversLagAndGainsInGusts) {
  ground::LaunchConfiguration plan = delayed_plan();
  plan.simulation.air.wind_ned = {1.0, -0.7, 0.0};
  plan.simulation.air.gust_sigma_ned = {0.7, 0.7, 0.3};
  expect_true_and_narrow(recover(plan, "gusts", tests::draws(1, 8)));
}

// GIVEN the log of a real Crazyflie THEN the result is near values published for this type and this log
TEST(CommandFlight, AgreesWithPublishedValuesOfARealVehicle) {
  const plant::Vehicle base = io::load_vehicle(tests::in_source("config/vehicles/crazyflie2.yaml"));
  const ReadFlightLog read =
      read_flight_log(tests::in_source("tests/data/crazyflie_flight.csv.gz"), base, BodyAxes::kDetected);
  ASSERT_EQ(read.log.size(), 50496U);
  const FlightIdentification found = identification::identify_flight({read.log}, base, {});
  EXPECT_EQ(found.source, SpeedSource::kCommanded);
  EXPECT_TRUE(found.converged);
  ASSERT_EQ(found.lags.size(), 3U);
  EXPECT_NEAR(found.lags[0].value, 0.072, 0.006) << "Eschmann, from the specific force";
  const ParameterEstimate& lag = *found.find("motor.time_constant");
  EXPECT_LT(lag.low(), base.motor.time_constant_s);
  EXPECT_GT(lag.high(), base.motor.time_constant_s);
  EXPECT_LT(lag.half_width, 0.02);
  ASSERT_EQ(found.comparisons.size(), 4U);
  for (const identification::FileComparison& comparison : found.comparisons) {
    if (comparison.identified.parameter == "thrust_to_rate.yaw") continue;
    EXPECT_LT(comparison.identified.low(), comparison.file) << comparison.identified.parameter;
    EXPECT_GT(comparison.identified.high(), comparison.file) << comparison.identified.parameter;
    EXPECT_NEAR(comparison.ratio(), 1.0, 0.2) << comparison.identified.parameter;
    EXPECT_LT(comparison.identified.half_width, 0.3 * comparison.identified.value)
        << comparison.identified.parameter;
  }
  const ParameterEstimate& hover = *found.find("thrust_per_mass.hover_command");
  EXPECT_NEAR(hover.value, 0.64, 0.02);
  EXPECT_LT(hover.half_width, 0.02);
  for (const identification::PredictionError& error : found.errors) {
    EXPECT_LT(error.half_second, 0.75 * error.persistence_half_second) << error.quantity;
    EXPECT_LT(error.one_step,
              (error.quantity == "p" || error.quantity == "q" ? 0.3 : 0.85) * error.persistence_one_step)
        << error.quantity;
  }
  for (const identification::HorizonError& error : found.horizons) {
    if (error.horizon_s > 0.15) continue;
    EXPECT_LT(error.by_commands, error.persistence) << error.quantity << error.horizon_s;
  }
}

TEST(CommandFlight, RefusesSwappedMotors) {
  const ground::LaunchConfiguration plan = delayed_plan();
  FlightLog log = with_commands_and_imu(flown(plan, plan.vehicle, 4));
  swap_motors(log);
  expect_refused({log}, plan.vehicle, "are the motors in its order");
}

// GIVEN a log in whose columns two motors are exchanged THEN the sentence says which.
TEST(CommandFlight, NamesExchangedMotors) {
  const ground::LaunchConfiguration plan = delayed_plan();
  FlightLog log = with_commands_and_imu(flown(plan, plan.vehicle, 4));
  for (plant::PerRotor& command : log.command) std::swap(command[0], command[1]);
  expect_refused({log}, plan.vehicle,
                 "motor 1 acts like rotor 2 (front left), motor 2 acts like rotor 1 (front right)");
}

TEST(CommandFlight, NamesExchangedMotorsOfARealVehicle) {
  const plant::Vehicle base = io::load_vehicle(tests::in_source("config/vehicles/crazyflie2.yaml"));
  const FlightLog log =
      read_flight_log(tests::in_source("tests/data/crazyflie_flight.csv.gz"), base, BodyAxes::kDetected).log;
  const char* const places[] = {"front right", "rear right", "rear left", "front left"};
  for (std::size_t one = 0; one < 4; ++one) {
    for (std::size_t other = one + 1; other < 4; ++other) {
      FlightLog swapped = log;
      for (plant::PerRotor& command : swapped.command) std::swap(command[one], command[other]);
      expect_refused({swapped}, base,
                     fmt::format("motor {} acts like rotor {} ({}), motor {} acts like rotor {} ({})",
                                 one + 1, other + 1, places[other], other + 1, one + 1, places[one]));
    }
  }
}

// A hover excites too little to decide.
TEST(CommandFlight, AcceptsTheOrderOfACalmFlight) {
  const tests::TemporaryFolder folder;
  const ground::LaunchConfiguration plan = plan_of(folder.write("hover.yaml", R"(name: hover
frame: ned
tolerance_m: 0.2
items:
  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.3, hold_s: 10}
  - {kind: land, speed_m_s: 0.3}
)"));
  const FlightLog log = flown(plan, plan.vehicle, 2);
  EXPECT_NO_THROW(identification::require_motor_order(log, {0, log.size()}, plan.vehicle));
}

}  // namespace swiftlet::analysis::command_flight_test
