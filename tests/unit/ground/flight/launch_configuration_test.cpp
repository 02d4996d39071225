// A flight is refused before it begins if a dry run shows that the vehicle cannot fly it.
#include "swiftlet/ground/flight/launch_configuration.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "swiftlet/ground/flight/flight_inputs.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/plant/model/endurance.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::launch_configuration_test {

// At 100 Hz: to `reach_m` and back, and a tremble of `tremble_m` at 8 Hz.
std::string samples(double reach_m, double tremble_m, double duration_s = 8.0) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i <= std::lround(100.0 * duration_s); ++i) {
    const double t = 0.01 * i;
    const double s = std::sin(M_PI * t / duration_s);
    text += fmt::format("{:.2f},{:.6f},{:.6f},1.000000\n", t, reach_m * s * s * s * s,
                        tremble_m * s * s * s * s * std::sin(2.0 * M_PI * 8.0 * t));
  }
  return text;
}

class LaunchConfigurationTest : public testing::Test {
 protected:
  FlyOptions options(const std::string& mission) const {
    FlyOptions options;
    options.launch_mode = LaunchMode::kInProcess;
    options.mission = mission;
    options.record = (folder_.path() / "record").string();
    return options;
  }
  static std::string refusal(const FlyOptions& options) {
    try {
      plan_flight(options);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "it was accepted";
  }
  static analysis::FlightReport fly(const LaunchConfiguration& plan) {
    simulation::ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
    record::Flight flight;
    return fly_in_process(loop, plan, plan.seed, flight, nullptr, {});
  }

  tests::TemporaryFolder folder_;
};

TEST_F(LaunchConfigurationTest, RefusesWhatTheRotorsCannotFlyAndSaysWhatTheyCan) {
  FlyOptions flight = options(folder_.write("tremble.csv", samples(1.0, 0.001)));
  const std::string reason = refusal(flight);
  EXPECT_NE(reason.find("tremble.csv: kaylion cannot fly it: item 2 (trajectory): "), std::string::npos)
      << reason;
  EXPECT_NE(reason.find("of a rotor is "), std::string::npos) << reason;
  EXPECT_NE(reason.find(", 1.00, -1.00) m NED; "), std::string::npos) << "time and place: " << reason;
  const std::size_t scale = reason.find("slower by ");
  const std::size_t tolerance = reason.find("mm: --tolerance ");
  ASSERT_NE(scale, std::string::npos) << reason;
  ASSERT_NE(tolerance, std::string::npos) << reason;
  flight.reading.time_scale = std::stod(reason.substr(reason.find("--time-scale ") + 13));
  EXPECT_GT(flight.reading.time_scale, 1.1);
  EXPECT_TRUE(fly(plan_flight(flight)).completed);
  flight.reading.time_scale = 1.0;
  flight.reading.tolerance_m = std::stod(reason.substr(tolerance + 16));
  EXPECT_LT(*flight.reading.tolerance_m, 0.002);
  EXPECT_TRUE(fly(plan_flight(flight)).completed);
}

TEST_F(LaunchConfigurationTest, DoesNotJudgeAVehicleThatIsNotKnown) {
  FlyOptions flight = options(folder_.write("tremble.csv", samples(1.0, 0.001)));
  flight.launch_mode = LaunchMode::kAttached;
  EXPECT_EQ(refusal(flight), "it was accepted");
}

std::string hover_for(double duration_s) {
  return fmt::format(
      "frame: ned\ntolerance_m: 0.1\nitems:\n  - {{kind: takeoff, height_m: 1, speed_m_s: 0.5}}\n"
      "  - {{kind: wait, duration_s: {}}}\n  - {{kind: land, speed_m_s: 0.5}}\n",
      duration_s);
}

// The battery lands the vehicle after the hover that was told, of a full and of a nearly empty one.
TEST_F(LaunchConfigurationTest, RefusesWhatOutlastsTheBattery) {
  const FlyOptions flight = options(folder_.write("long.yaml", hover_for(3000.0)));
  EXPECT_NE(refusal(flight).find("longer than the battery lasts: "), std::string::npos) << refusal(flight);
  LaunchConfiguration plan = plan_flight(options(folder_.write("hover.yaml", hover_for(300.0))));
  plan.simulation.supply.initial_state_of_charge = 0.3;
  const double endurance_s =
      plant::hover_endurance_s(plan.vehicle, 0.3, plan.control.failsafe.low_battery_voltage);
  EXPECT_LT(endurance_s, 300.0);
  const analysis::FlightReport report = fly(plan);
  EXPECT_NE(report.reason.find("battery is low"), std::string::npos) << report.reason;
  EXPECT_NEAR(report.duration_s, endurance_s, 0.05 * endurance_s);
}

TEST_F(LaunchConfigurationTest, HasNoGreatestDuration) {
  FlyOptions flight = options(folder_.write("long.yaml", hover_for(720.0)));
  flight.simulation = "ideal";
  const LaunchConfiguration plan = plan_flight(flight);
  EXPECT_NEAR(plan.planned_duration_s, 729.0, 2.0);
  const analysis::FlightReport report = fly(plan);
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_NEAR(report.duration_s, plan.planned_duration_s, 2.0);
}

// The controller descends at 0.4 m/s, whatever the item says.
TEST_F(LaunchConfigurationTest, KnowsHowLongALandingFromHighUpTakes) {
  std::ostringstream settings;
  settings << std::ifstream(tests::in_source("config/control/motor_lag.yaml")).rdbuf();
  std::string high = settings.str();
  const std::string fence = "fence_min_ned_m: [-3.0, -3.0, -2.5]";
  high.replace(high.find(fence), fence.size(), "fence_min_ned_m: [-3.0, -3.0, -12.0]");
  FlyOptions flight = options(
      folder_.write("high.yaml",
                    "frame: ned\ntolerance_m: 0.2\nitems:\n  - {kind: takeoff, height_m: 11, speed_m_s: 2}\n"
                    "  - {kind: land, speed_m_s: 2}\n"));
  flight.control = folder_.write("control.yaml", high);
  const LaunchConfiguration plan = plan_flight(flight);
  const analysis::FlightReport report = fly(plan);
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_NEAR(report.duration_s, plan.planned_duration_s, 2.0);
}

TEST_F(LaunchConfigurationTest, SaysHowMuchSlowerAFileIsWithinTheLimits) {
  FlyOptions flight = options(folder_.write("fast.csv", samples(2.9, 0.0, 5.0)));
  std::string reason = "it was accepted";
  try {
    plan_flight(flight);
  } catch (const io::ConfigError& error) {
    reason = error.what();
  }
  EXPECT_NE(reason.find("the limit is 2.00 m/s; slower by 1."), std::string::npos) << reason;
  flight.reading.time_scale = std::stod(reason.substr(reason.find("--time-scale ") + 13));
  EXPECT_EQ(refusal(flight), "it was accepted");
}

TEST_F(LaunchConfigurationTest, FliesModelsThatAreInNoFile) {
  FlightInputs given;
  given.vehicle = plan_flight(options("square")).vehicle;
  given.vehicle->name = "heavy";
  given.vehicle->mass_kg *= 1.05;
  given.mission = plan_flight(options("square")).mission;
  given.mission->name = "mine";
  const LaunchConfiguration plan = plan_flight(options("not used"), given);
  EXPECT_EQ(plan.vehicle.mass_kg, given.vehicle->mass_kg);
  const analysis::FlightReport report = fly(plan);
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_EQ(report.vehicle + " " + report.mission, "heavy mine");
}

TEST_F(LaunchConfigurationTest, RefusesAModelThatBreaksARuleOrCannotFlyTheMission) {
  const auto refusal_of = [&](const FlightInputs& given) -> std::string {
    try {
      plan_flight(options("square"), given);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "it was accepted";
  };
  FlightInputs given;
  given.vehicle = plan_flight(options("square")).vehicle;
  given.vehicle->mass_kg = -1.0;
  EXPECT_EQ(refusal_of(given), "vehicle: mass: is -1, must be a finite number above 0");
  given.vehicle = plan_flight(options("square")).vehicle;
  given.control = plan_flight(options("square")).control;
  given.mission = plan_flight(options("square")).mission;
  given.mission->name = "mine";
  given.control->limits.max_tilt_rad = 0.01;
  EXPECT_EQ(refusal_of(given).rfind("mine: ", 0), 0U) << refusal_of(given);
}

}  // namespace swiftlet::ground::launch_configuration_test
