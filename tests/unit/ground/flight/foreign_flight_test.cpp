// Files of other projects, read unchanged and flown in one process with all sensor models.
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::foreign_flight_test {

const std::string kData = tests::in_source("tests/data/");

class ForeignFlight : public testing::Test {
 protected:
  void plan(const std::string& file, const std::string& control = "motor_lag") {
    FlyOptions options;
    options.launch_mode = LaunchMode::kInProcess;
    options.mission = kData + file;
    options.control = control;
    options.record = folder_.path().string();
    plan_ = plan_flight(options);
  }
  analysis::FlightReport fly() {
    simulation::ClosedLoop loop = closed_loop(plan_, draw(plan_, plan_.seed).world, plan_.seed);
    record::Flight flight;
    return fly_in_process(loop, plan_, plan_.seed, flight, nullptr, {});
  }
  // The path is feasible down to the low battery voltage.
  void expect_feasible() const {
    for (const control::WorstDemand& worst :
         control::worst_demands(plan_.vehicle, plan_.control.limits,
                                plan_.control.failsafe.low_battery_voltage, plan_.mission.mission.segments)) {
      EXPECT_FALSE(worst.exceeded()) << worst.sentence();
    }
  }

  tests::TemporaryFolder folder_;
  LaunchConfiguration plan_;
};

class ForeignCsv : public ForeignFlight, public testing::WithParamInterface<const char*> {};

TEST_P(ForeignCsv, IsFeasibleAndTrackedClosely) {
  plan(GetParam());
  expect_feasible();
  const analysis::FlightReport report = fly();
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.005);
  EXPECT_LT(report.errors.peak_3d_m, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Files, ForeignCsv, testing::Values("crazyswarm_figure8.csv", "uav_waypoints.csv"),
                         [](const auto& file) { return file.index == 0 ? "Crazyswarm" : "UavTrajectories"; });

TEST_F(ForeignFlight, TracksThePx4BoxMission) {
  std::string settings = io::read_text_file(tests::in_source("config/control/motor_lag.yaml"));
  const auto set = [&](const std::string& key, const std::string& value) {
    const std::size_t begin = settings.find(key + ":");
    settings.replace(begin, settings.find('\n', begin) - begin, key + ": " + value);
  };
  set("fence_min_ned_m", "[-30, -30, -12]");  // outdoors
  set("fence_max_ned_m", "[30, 30, 0.2]");
  plan("px4_mission_box.plan", folder_.write("field.yaml", settings));
  const analysis::FlightReport report = fly();
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.01);
}

}  // namespace swiftlet::ground::foreign_flight_test
