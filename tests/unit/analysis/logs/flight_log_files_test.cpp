#include "swiftlet/analysis/logs/flight_log_files.hpp"

#include <cmath>
#include <string>
#include <zlib.h>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::analysis::flight_log_files_test {

using identification::FlightLog;

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }

// 8 IMU samples 2 ms apart; a pose and a battery sample with every fourth.
FlightLog recorded() {
  record::Flight flight;
  for (int i = 0; i < 8; ++i) {
    const std::int64_t stamp_ns = std::int64_t{2'000'000} * i;
    plant::ImuSample imu;
    imu.stamp_ns = stamp_ns;
    imu.specific_force_frd = {0.1 * i, -0.2, -9.8};
    imu.body_rates_frd = {0.01, 0.02 * i, -0.03};
    flight.imu.push_back(imu);
    plant::ActuatorCommand command;
    command.stamp_ns = stamp_ns;
    command.rotor_state = i < 2 ? plant::RotorState::kOff : plant::RotorState::kRunning;
    command.rotor_count = 4;
    command.throttle = {0.1 * i, 0.2, 0.3, 0.4};
    flight.commands.push_back(command);
    plant::RotorSpeedSample speeds;
    speeds.stamp_ns = stamp_ns;
    speeds.rotor_count = 4;
    speeds.speeds = {100.0 + i, 200.0, 300.0, 400.0};
    flight.rotor_speeds.push_back(speeds);
    if (i % 4 != 0) continue;
    plant::PoseSample pose;
    pose.stamp_ns = stamp_ns;
    pose.tracked = true;
    pose.position_ned = {1.0, 2.0, -3.0 - i};
    pose.q_ned_from_frd = Eigen::Quaterniond(0.8, 0.0, 0.6, 0.0);
    flight.poses.push_back(pose);
    plant::BatterySample battery;
    battery.stamp_ns = stamp_ns;
    battery.voltage_v = 4.0 - 0.1 * i;
    flight.batteries.push_back(battery);
  }
  return flight_log_of(flight);
}

ReadFlightLog read(const std::string& text, BodyAxes axes = BodyAxes::kDetected) {
  const tests::TemporaryFolder folder;
  return read_flight_log(folder.write("log.csv", text), kaylion(), axes);
}

std::string refused(const std::string& text) {
  try {
    read(text);
  } catch (const io::ConfigError& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "was not refused";
  return "";
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(FlightLogFiles, JoinsSamplesByTheirStamps) {
  const FlightLog log = recorded();
  ASSERT_EQ(log.size(), 8U);
  EXPECT_DOUBLE_EQ(log.time_s[3], 0.006);
  EXPECT_DOUBLE_EQ(log.command[3][0], 0.3);
  EXPECT_EQ(log.running[1], 0);
  EXPECT_EQ(log.running[2], 1);
  EXPECT_DOUBLE_EQ(log.supply_voltage_v[2], 3.8);  // half way between 4.0 and 3.6
  EXPECT_DOUBLE_EQ(log.rotor_speeds[7][0], 107.0);
  ASSERT_EQ(log.poses.size(), 2U);
}

const std::string kRow = "0.0,1,2,9.8,0.1,0.2,0.3,0.5\n0.01,1,2,9.8,0.1,0.2,0.3,0.5\n";

TEST(FlightLogFiles, DetectsBodyAxesFromGravity) {
  const ReadFlightLog up = read(
      "t [s],acc_x [m/s^2],acc_y [m/s^2],acc_z [m/s^2],gyro_x [rad/s],gyro_y [rad/s],gyro_z [rad/s],motor1 "
      "[1]\n" +
      kRow);
  ASSERT_EQ(up.assumptions.size(), 2U);
  expect_contains(up.assumptions[0], "forward-left-up");
  EXPECT_TRUE(up.log.specific_force_frd[0].isApprox(Eigen::Vector3d(1.0, -2.0, -9.8)));
  EXPECT_TRUE(up.log.body_rates_frd[0].isApprox(Eigen::Vector3d(0.1, -0.2, -0.3)));
}

TEST(FlightLogFiles, UsesTheAxesInColumnNames) {
  const std::string header =
      "t [s],acc_x_frd [m/s^2],acc_y_frd [m/s^2],acc_z_frd [m/s^2],p_frd [rad/s],q_frd [rad/s],r_frd "
      "[rad/s],motor1 [1]\n";
  const std::string row = "0,1,2,-9.8,0.1,0.2,0.3,0.5\n";
  EXPECT_TRUE(read(header + row).log.specific_force_frd[0].isApprox(Eigen::Vector3d(1.0, 2.0, -9.8)));
}

TEST(FlightLogFiles, RefusesAxesThatGravityContradicts) {
  const std::string values =
      "acc_x [m/s^2],acc_y [m/s^2],acc_z [m/s^2],p [rad/s],q [rad/s],r [rad/s],m1 [1]\n";
  expect_contains(refused("t [s],acc_x_frd [m/s^2],acc_y_frd [m/s^2],acc_z_frd [m/s^2],p_frd [rad/s],q_frd "
                          "[rad/s],r_frd [rad/s],m1 [1]\n" +
                          kRow),
                  "must be negative in forward-right-down axes");
  EXPECT_NO_THROW(read("t [s]," + values + kRow, BodyAxes::kFlu));
  EXPECT_THROW(read("t [s]," + values + kRow, BodyAxes::kFrd), io::ConfigError);
}

TEST(FlightLogFiles, ConvertsPosesFromEnuToNed) {
  const double h = std::sqrt(0.5);
  const std::string header =
      "t [s],ax_flu [g],ay_flu [g],az_flu [g],p_flu [rad/s],q_flu [rad/s],r_flu [rad/s],m1 [1],pose_time "
      "[s],x_enu [m],y_enu "
      "[m],z_enu [m],qw_enu_from_flu [1],qx_enu_from_flu [1],qy_enu_from_flu [1],qz_enu_from_flu [1]\n";
  // Level, nose to the north: 90 degrees about up from east.
  const std::string row =
      ",0,0,1,0,0,0,0.5,0,1,2,3," + std::to_string(h) + ",0,0," + std::to_string(h) + "\n";
  const ReadFlightLog log = read(header + "0" + row + "0.1" + row);
  ASSERT_EQ(log.log.poses.size(), 1U);
  EXPECT_TRUE(log.log.poses[0].position_ned.isApprox(Eigen::Vector3d(2.0, 1.0, -3.0)));
  EXPECT_LT(log.log.poses[0].q_ned_from_frd.angularDistance(Eigen::Quaterniond::Identity()), 1e-5);
}

TEST(FlightLogFiles, ConvertsPulseWidthsToThrottles) {
  const ReadFlightLog log = read(
      "t [s],acc_x [g],acc_y [g],acc_z [g],gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s],pwm1 [us]\n"
      "0,0,0,1,0,0,0,1539\n0.01,0,0,1,0,0,0,1039\n");
  EXPECT_DOUBLE_EQ(log.log.command[0][0], 0.5);
  expect_contains(
      refused("t [s],acc_x [g],acc_y [g],acc_z [g],gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s],pwm1 "
              "[us]\n0,0,0,1,0,0,0,15390\n"),
      "log.csv:2: pwm1 [us]: is 15390.000000 us, must be 0 or between 539.000000 and 2539.000000 us");
}

TEST(FlightLogFiles, RefusesAmbiguousOrIncompleteLogs) {
  const std::string head = "t [s],acc_x [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s],m1 [1]";
  expect_contains(refused(head + "\n0,0,0,0.1,0,0,0,0.5\n"), "give --axes frd or --axes flu");
  expect_contains(refused(head + "\n0,0,0,1,0,0,0,1.5\n"), "of full command, must be between 0 and 1");
  expect_contains(refused(head + "\n0.1,0,0,1,0,0,0,1\n0.1,0,0,1,0,0,0,1\n"), "s after the previous row");
  expect_contains(
      refused(
          head +
          ",pose_time [s],x [m],y [m],z [m],qw [1],qx [1],qy [1],qz [1]\n0,0,0,1,0,0,0,1,0,0,0,0,1,0,0,0\n"),
      "does not name the frame of its poses");
  expect_contains(
      refused(
          "t [s],acc_x_frd [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s],m1 [1]\n0,0,0,1,0,0,0,1\n"),
      "names axes in some columns only");
  for (const char* const telemetry : {"t [s],mode,ref_x_ned [m]\n0,mission,1\n", "t,mode,ref_px\n0,4,1\n"})
    expect_contains(refused(telemetry), "is that of the telemetry of a flight; an identification");
  expect_contains(
      refused("t [s],acc_x [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s]\n0,0,0,1,0,0,0\n"),
      "has no column throttle1 [1]");
  expect_contains(refused("t [s],acc_x [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s],m1 [1],m3 "
                          "[1]\n0,0,0,1,0,0,0,1,1\n"),
                  "has m3 [1] but none of motor 2");
}

TEST(FlightLogFiles, ReadsGzipAndReportsCorruptArchives) {
  const tests::TemporaryFolder folder;
  const std::string file = (folder.path() / "log.csv.gz").string();
  const gzFile out = gzopen(file.c_str(), "wb");
  const std::string text =
      "t [s],acc_x [g],acc_y [g],acc_z [g],p [rad/s],q [rad/s],r [rad/s],m1 [1]\n0,0,0,1,0,0,0,1\n";
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  EXPECT_EQ(read_flight_log(file, kaylion(), BodyAxes::kDetected).log.size(), 1U);

  const std::string broken = folder.write("broken.csv.gz", io::read_text_file(file).substr(0, 40));
  try {
    read_flight_log(broken, kaylion(), BodyAxes::kDetected);
    ADD_FAILURE() << "was not refused";
  } catch (const io::ConfigError& fault) {
    expect_contains(fault.what(), "cannot be unpacked");
  }
}

}  // namespace swiftlet::analysis::flight_log_files_test
