// Flight logs whose readings contradict each other or physics are refused before the fit.
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/analysis/identify/identified_flights.hpp"

namespace swiftlet::analysis::flight_checks_test {

using identification::FlightIdentification;
using identification::FlightLog;
using identification::FlightPose;
using tests::contains;

class FlightChecks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    plan_ = new ground::LaunchConfiguration(plan_of("identification"));
    log_ = new FlightLog(flown(*plan_, plan_->vehicle, 11));
  }
  static void TearDownTestSuite() {
    delete log_;
    delete plan_;
  }

  void expect_refused_with(const std::function<void(FlightLog&)>& change, const std::string& sentence) const {
    FlightLog log = *log_;
    change(log);
    expect_refused({log}, plan_->vehicle, sentence);
  }
  FlightIdentification identified(const std::function<void(FlightLog&)>& change) const {
    FlightLog log = *log_;
    change(log);
    return identification::identify_flight({log}, plan_->vehicle, {});
  }

  inline static ground::LaunchConfiguration* plan_ = nullptr;
  inline static FlightLog* log_ = nullptr;
};

std::function<void(FlightLog&)> poses(const std::function<void(FlightPose&)>& change) {
  return [change](FlightLog& log) {
    for (FlightPose& pose : log.poses) change(pose);
  };
}

std::function<void(FlightLog&)> rows(const std::function<void(FlightLog&, std::size_t)>& change) {
  return [change](FlightLog& log) {
    for (std::size_t row = 0; row < log.size(); ++row) change(log, row);
  };
}

TEST_F(FlightChecks, RefusesWrongUnits) {
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.specific_force_frd[row] /= 9.81; }),
                      "specific force: has the median 0.98");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.specific_force_frd[row] *= 1000.0; }),
                      "s ends it: is the unit right?");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.body_rates_frd[row] *= 180.0 / M_PI; }),
                      "body rates: the poses turn 0.017");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.supply_voltage_v[row] *= 1000.0; }),
                      "supply voltage: has the median 39");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) {
                        for (double& speed : log.rotor_speeds[row]) speed *= 9.549;
                      }),
                      "rotor speeds: are 9.5");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.time_s[row] *= 1000.0; }),
                      "time: the median sample period is 2 s");
  expect_refused_with(poses([](FlightPose& pose) { pose.position_ned *= 1000.0; }),
                      "positions: north velocity changes by");
  expect_refused_with(poses([](FlightPose& pose) { pose.position_ned /= 1000.0; }),
                      "has no pose more than 0.1 m above");
}

TEST_F(FlightChecks, RefusesWrongUnitsInALogWithoutPoses) {
  const auto keep_commands_and_imu = [](FlightLog& log) {
    log.poses.clear();
    log.supply_voltage_v.clear();
    log.rotor_speeds.clear();
  };
  expect_refused_with(
      [&](FlightLog& log) {
        keep_commands_and_imu(log);
        for (Eigen::Vector3d& rates : log.body_rates_frd) rates *= 180.0 / M_PI;
      },
      "body rates: leads to J_xx");
}

TEST_F(FlightChecks, RefusesConstantReadings) {
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.body_rates_frd[row].y() = 0.0; }),
                      "body rate y: is 0 rad/s all through the flight, must vary");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.specific_force_frd[row].x() = 0.1; }),
                      "specific force x: is 0.1 m/s^2 all through the flight, must vary");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.command[row][2] = 0.6; }),
                      "command of motor 3: is 0.6 of full command all through the flight, must vary");
  expect_refused_with(rows([](FlightLog& log, std::size_t row) { log.rotor_speeds[row][1] = 0.0; }),
                      "speed of rotor 2: is 0 rad/s all through the flight, must vary");
}

TEST_F(FlightChecks, RefusesInconsistentFramesAndClocks) {
  expect_refused_with(
      poses([](FlightPose& pose) {
        pose.position_ned = {-pose.position_ned.x(), -pose.position_ned.y(), pose.position_ned.z()};
      }),
      "positions: north velocity disagrees with the specific force");
  expect_refused_with(poses([](FlightPose& pose) { pose.q_ned_from_frd = pose.q_ned_from_frd.conjugate(); }),
                      "poses: do not turn as the gyro does");
  expect_refused_with(poses([](FlightPose& pose) { pose.time_s += 1.7e9; }), "must have both on one clock");
}

TEST_F(FlightChecks, WarnsWhenPosesEndBeforeTheFlight) {
  const double end_s = log_->time_s.back() - 20.0;
  const auto cut = [end_s](FlightLog& log) {
    while (log.poses.back().time_s > end_s) log.poses.pop_back();
  };
  EXPECT_TRUE(contains(identified(cut).warnings, "poses end at"));
  FlightLog log = *log_;
  cut(log);
  identification::FlightOptions options;
  options.bounds.until_s = end_s + 5.0;
  expect_refused({log}, plan_->vehicle, "must have them all through the flight", options);
}

TEST_F(FlightChecks, WarnsOfDataAfterAGap) {
  const FlightIdentification found = identified([](FlightLog& log) {
    for (std::size_t row = log.size() / 2; row < log.size(); ++row) log.time_s[row] += 2.0;
    for (FlightPose& pose : log.poses) {
      if (pose.time_s >= log.time_s[log.size() / 2] - 2.0) pose.time_s += 2.0;
    }
  });
  EXPECT_TRUE(contains(found.warnings, "rotors ran for another"));
}

TEST_F(FlightChecks, IdentifiesPoseDelaysUpTo600Ms) {
  const FlightIdentification found = identified(poses([](FlightPose& pose) { pose.time_s += 0.6; }));
  EXPECT_NEAR(found.find("delay.poses")->value, 0.6, 3e-4);
  EXPECT_NEAR(found.find("rotor.thrust_factor")->value / plan_->vehicle.rotor.thrust, 1.0, 1e-3);
}

TEST_F(FlightChecks, PredictionErrorGrowsWithWrongCommands) {
  const FlightIdentification found = identified([](FlightLog& log) {
    for (std::size_t row = log.size() - 12000; row < log.size(); ++row) log.command[row].fill(0.3);
  });
  const FlightIdentification right = identified([](FlightLog&) {});
  EXPECT_GT(found.errors[0].half_second, 5.0 * right.errors[0].half_second);
}

TEST_F(FlightChecks, RefusesLogsOfDifferentRatesWithoutPoses) {
  FlightLog fast = *log_;
  fast.poses.clear();
  FlightLog slow = fast;
  slow.name = "slow.csv";
  const auto keep_every_fifth = [](auto& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); i += 5) values[kept++] = values[i];
    values.resize(kept);
  };
  keep_every_fifth(slow.time_s);
  keep_every_fifth(slow.specific_force_frd);
  keep_every_fifth(slow.body_rates_frd);
  keep_every_fifth(slow.command);
  keep_every_fifth(slow.running);
  keep_every_fifth(slow.supply_voltage_v);
  keep_every_fifth(slow.rotor_speeds);
  expect_refused({fast, slow}, plan_->vehicle, "slow.csv has a sample every 10 ms");
}

TEST(CalmFlight, DoesNotIdentifyMomentsOfInertia) {
  const ground::LaunchConfiguration plan = plan_of("square");
  const FlightIdentification found =
      identification::identify_flight({flown(plan, plan.vehicle, 2)}, plan.vehicle, {});
  EXPECT_LT(found.find("inertia.zz")->high(), plan.vehicle.inertia(2, 2))
      << "the fit must be biased here, or the test checks nothing";
  EXPECT_EQ(found.vehicle.inertia, plan.vehicle.inertia);
  EXPECT_EQ(found.sources.count("inertia.zz"), 0U);
}

TEST(CalmFlight, DoesNotIdentifyInertiaOrLagWithoutPoses) {
  const ground::LaunchConfiguration plan = plan_of("square");
  FlightLog log = flown(plan, plan.vehicle, 2);
  log.poses.clear();
  const FlightIdentification found = identification::identify_flight({log}, plan.vehicle, {});
  EXPECT_EQ(found.vehicle.inertia, plan.vehicle.inertia);
  EXPECT_EQ(found.vehicle.motor.time_constant_s, plan.vehicle.motor.time_constant_s);
  EXPECT_TRUE(contains(found.unexcited, "thrust_to_rate.yaw: r changes by"));
  for (const identification::FileComparison& row : found.comparisons)
    EXPECT_FALSE(row.identified.identifiable) << row.identified.parameter;
}

}  // namespace swiftlet::analysis::flight_checks_test
