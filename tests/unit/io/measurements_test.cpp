#include "swiftlet/io/measurements.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::measurements_test {

using tests::refusal;

const std::vector<Quantity> kAll = {Quantity::kTime,     Quantity::kSupplyVoltage, Quantity::kMotorVoltage,
                                    Quantity::kThrottle, Quantity::kPulseWidth,    Quantity::kSpeed,
                                    Quantity::kThrust,   Quantity::kTorque,        Quantity::kMass,
                                    Quantity::kLength,   Quantity::kSeparation,    Quantity::kArm,
                                    Quantity::kPeriod};

double read(const std::string& header, Quantity quantity) {
  return parse_measurements(header + "\n2\n", "f.csv", kAll).column(quantity).front();
}

std::string refused(const std::string& header, const std::vector<Quantity>& allowed = kAll) {
  return refusal([&] { parse_measurements(header + "\n2,3\n", "f.csv", allowed); });
}

TEST(Measurements, AcceptsCommonNamesAndUnits) {
  EXPECT_DOUBLE_EQ(read("speed [rad/s]", Quantity::kSpeed), 2.0);
  EXPECT_DOUBLE_EQ(read("omega [rpm]", Quantity::kSpeed), 2.0 * M_PI / 30.0);
  EXPECT_DOUBLE_EQ(read("Omega [RPM]", Quantity::kSpeed), 2.0 * M_PI / 30.0);
  EXPECT_DOUBLE_EQ(read("rpm", Quantity::kSpeed), 2.0 * M_PI / 30.0);
  EXPECT_DOUBLE_EQ(read("speed[Hz]", Quantity::kSpeed), 4.0 * M_PI);
  EXPECT_DOUBLE_EQ(read("thrust [g]", Quantity::kThrust), 2e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(read("force [mN]", Quantity::kThrust), 2e-3);
  EXPECT_DOUBLE_EQ(read("torque [mNm]", Quantity::kTorque), 2e-3);
  EXPECT_DOUBLE_EQ(read("torque [gf*cm]", Quantity::kTorque), 2e-5 * 9.80665);
  EXPECT_DOUBLE_EQ(read("throttle [%]", Quantity::kThrottle), 0.02);
  EXPECT_DOUBLE_EQ(read("pwm [percent]", Quantity::kThrottle), 0.02);
  EXPECT_DOUBLE_EQ(read("pwm [us]", Quantity::kPulseWidth), 2.0);
  EXPECT_DOUBLE_EQ(read("throttle [\xc2\xb5s]", Quantity::kPulseWidth), 2.0);
  EXPECT_DOUBLE_EQ(read("v_s [mV]", Quantity::kSupplyVoltage), 2e-3);
  EXPECT_DOUBLE_EQ(read("time [ms]", Quantity::kTime), 2e-3);
  EXPECT_DOUBLE_EQ(read("mass [g]", Quantity::kMass), 2e-3);
  EXPECT_DOUBLE_EQ(read("arm [cm]", Quantity::kArm), 2e-2);
}

TEST(Measurements, ReadsColumnsInAnyOrder) {
  const Measurements table = parse_measurements("thrust [N], rpm\r\n0.1,1000\r\n0.2,2000\r\n", "f.csv",
                                                {Quantity::kSpeed, Quantity::kThrust});
  EXPECT_EQ(table.column(Quantity::kThrust), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(table.row_count(), 2U);
  EXPECT_EQ(table.line(1), 3);
  EXPECT_FALSE(table.has(Quantity::kTorque));
}

TEST(Measurements, RefusesAmbiguousColumns) {
  EXPECT_EQ(refused("speed,thrust [N]"),
            "f.csv:1: header: has the column speed without a unit, must be speed [rad/s], speed [rpm] or "
            "speed [rev/s]");
  EXPECT_EQ(refused("throttle,thrust [N]"),
            "f.csv:1: header: has the column throttle without a unit, must be throttle [1], throttle [%], "
            "throttle [us] or "
            "throttle [ms]");
  EXPECT_EQ(refused("thrust [lb],rpm"),
            "f.csv:1: header: has the column thrust [lb] with an unknown unit, must be thrust [N], "
            "thrust [mN], "
            "thrust [g] or thrust [kg]");
  EXPECT_EQ(refused("speed [rad/s],rpm"),
            "f.csv:1: header: has the columns speed [rad/s] and rpm, must have one of them: both are speed");
}

TEST(Measurements, RefusesUnknownColumns) {
  EXPECT_EQ(refused("colour [1],rpm", {Quantity::kSpeed, Quantity::kThrust}),
            "f.csv:1: header: has the column colour [1], must be one of speed [rad/s] or thrust [N]");
  EXPECT_EQ(refused("mass [g],rpm", {Quantity::kSpeed, Quantity::kThrust}),
            "f.csv:1: header: has the column mass [g], must be one of speed [rad/s] or thrust [N]");
  EXPECT_EQ(refused("1,2"), "f.csv:1: header: is 1,2, must name every column");
}

const std::vector<Quantity> kFlightQuantities = {Quantity::kTime,
                                                 Quantity::kSpecificForceX,
                                                 Quantity::kSpecificForceZ,
                                                 Quantity::kBodyRateX,
                                                 Quantity::kBodyRateX + 1,
                                                 Quantity::kMotorCommand,
                                                 Quantity::kMotorCommand + 3,
                                                 Quantity::kMotorPulse,
                                                 Quantity::kMotorPulse + 3,
                                                 Quantity::kMotorSpeed,
                                                 Quantity::kMotorSpeed + 7,
                                                 Quantity::kPositionX + 1,
                                                 Quantity::kOrientationW,
                                                 Quantity::kOrientationX};

double read_flight(const std::string& header, Quantity quantity) {
  return parse_measurements(header + "\n2\n", "f.csv", kFlightQuantities).column(quantity).front();
}

TEST(Measurements, AcceptsCommonNamesAndUnitsOfFlightLogs) {
  EXPECT_DOUBLE_EQ(read_flight("acc_z [g]", Quantity::kSpecificForceZ), 2.0 * 9.80665);
  EXPECT_DOUBLE_EQ(read_flight("specific_force_x_frd [m/s^2]", Quantity::kSpecificForceX), 2.0);
  EXPECT_DOUBLE_EQ(read_flight("ax [mg]", Quantity::kSpecificForceX), 2e-3 * 9.80665);
  EXPECT_DOUBLE_EQ(read_flight("gyro_x [deg/s]", Quantity::kBodyRateX), M_PI / 90.0);
  EXPECT_DOUBLE_EQ(read_flight("q [rad/s]", Quantity::kBodyRateX + 1), 2.0);
  EXPECT_DOUBLE_EQ(read_flight("motor4 [0..65535]", Quantity::kMotorCommand + 3), 2.0 / 65535.0);
  EXPECT_DOUBLE_EQ(read_flight("m1 [%]", Quantity::kMotorCommand), 0.02);
  EXPECT_DOUBLE_EQ(read_flight("motor_4 [us]", Quantity::kMotorPulse + 3), 2.0);
  EXPECT_DOUBLE_EQ(read_flight("rpm8 [rpm]", Quantity::kMotorSpeed + 7), M_PI / 15.0);
  EXPECT_DOUBLE_EQ(read_flight("py_enu [mm]", Quantity::kPositionX + 1), 2e-3);
  EXPECT_DOUBLE_EQ(read_flight("qw_ned_from_frd [1]", Quantity::kOrientationW), 2.0);
}

TEST(Measurements, RefusesAmbiguousColumnsOfFlightLogs) {
  EXPECT_EQ(refused("motor1,time [s]", kFlightQuantities),
            "f.csv:1: header: has the column motor1 without a unit, must be motor1 [1], motor1 [%], motor1 "
            "[0..65535], "
            "motor1 [0..255], motor1 [us] or motor1 [ms]");
  EXPECT_EQ(refused("gyro_x,time [s]", kFlightQuantities),
            "f.csv:1: header: has the column gyro_x without a unit, must be gyro_x [rad/s], gyro_x [deg/s] "
            "or gyro_x "
            "[mrad/s]");
  EXPECT_EQ(refused("acc_x [g],ax_frd [g]", kFlightQuantities),
            "f.csv:1: header: has the columns acc_x [g] and ax_frd [g], must have one of them: both are "
            "specific_force_x_frd");
}

TEST(Measurements, KeepsTheHeader) {
  const Measurements table = parse_measurements("acc_x_flu [g]\n1\n", "f.csv", kFlightQuantities);
  EXPECT_EQ(table.header(Quantity::kSpecificForceX), "acc_x_flu [g]");
}

TEST(Measurements, NamesAMissingColumn) {
  const Measurements table = parse_measurements("rpm\n1\n", "f.csv", {Quantity::kSpeed, Quantity::kThrust});
  EXPECT_EQ(refusal([&] { (void)table.column(Quantity::kThrust); }),
            "f.csv:1: header: has no column thrust [N], must have one");
}

TEST(Measurements, ReadsWhatASpreadsheetWrites) {
  const std::vector<Quantity> both = {Quantity::kSpeed, Quantity::kThrust};
  const Measurements table = parse_measurements(
      "\xef\xbb\xbfsep=;\r\n\"speed [rad/s]\";\"thrust [N]\"\r\n100;0,25\r\n", "f.csv", both);
  EXPECT_EQ(table.column(Quantity::kThrust).front(), 0.25);
  EXPECT_EQ(table.line(0), 3);
}

TEST(Measurements, RefusesNumbersThatAreNotFinite) {
  EXPECT_EQ(refusal([] { parse_measurements("rpm\nnan\n", "f.csv", {Quantity::kSpeed}); }),
            "f.csv:2: rpm: is nan, must be a finite number");
}

}  // namespace swiftlet::io::measurements_test
