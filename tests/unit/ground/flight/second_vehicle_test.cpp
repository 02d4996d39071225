// A second vehicle, config/vehicles/crazyflie2.yaml: flown, and compared with the data it comes from.
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/analysis/identify/bench_files.hpp"
#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::second_vehicle_test {

const std::string kConfig = tests::in_source("config/");

plant::Vehicle crazyflie() { return io::load_vehicle(kConfig + "vehicles/crazyflie2.yaml"); }

analysis::FlightReport fly(const std::string& mission, const std::string& control) {
  const tests::TemporaryFolder folder;
  FlyOptions options;
  options.launch_mode = LaunchMode::kInProcess;
  options.vehicle = "crazyflie2";
  options.mission = mission;
  options.control = control;
  options.record = folder.path().string();
  const LaunchConfiguration plan = plan_flight(options);
  simulation::ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
  record::Flight flight;
  return fly_in_process(loop, plan, plan.seed, flight, nullptr, {});
}

TEST(SecondVehicle, FliesTheSquare) {
  const analysis::FlightReport report = fly("square", "motor_lag");
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.003);
  EXPECT_LT(report.errors.peak_3d_m, 0.010);
}

TEST(SecondVehicle, FliesTheZigzag) {
  const analysis::FlightReport report = fly("zigzag", "motor_lag");
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.003);
}

TEST(SecondVehicle, FliesTheSquareWithThePapersControlLaws) {
  const analysis::FlightReport report = fly("square", "paper");
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.030);
}

TEST(SecondVehicle, MatchesTheIdentificationFromItsBench) {
  const plant::Vehicle vehicle = crazyflie();
  const std::string folder = tests::in_source("tests/data/crazyflie2_bench");
  const analysis::Bench bench =
      analysis::load_bench(folder, analysis::load_bench_settings(folder), vehicle.esc);
  const plant::Vehicle found = identification::identify_bench(bench.data, vehicle).vehicle;
  EXPECT_NEAR(found.motor.k2 / vehicle.motor.k2, 1.0, 1e-3);
  EXPECT_NEAR(found.motor.k3 / vehicle.motor.k3, 1.0, 1e-3);
  EXPECT_NEAR(found.rotor.thrust / vehicle.rotor.thrust, 1.0, 1e-3);
}

// Bitcraze's table: 15924 rpm and 24.4 g of four rotors at 50 % duty cycle and 3.71 V.
TEST(SecondVehicle, MatchesTheMeasuredRotorSpeedAndThrust) {
  const plant::Vehicle vehicle = crazyflie();
  const double throttle = 0.5 * 0.5;  // the square of the duty cycle
  EXPECT_NEAR(plant::steady_speed_from_throttle(vehicle, 3.71, throttle), 1667.6, 0.05 * 1667.6);
  EXPECT_NEAR(4.0 * plant::steady_thrust_from_throttle(vehicle, 3.71, throttle), 24.4e-3 * plant::kGravity,
              0.1 * 24.4e-3 * plant::kGravity);
}

}  // namespace swiftlet::ground::second_vehicle_test
