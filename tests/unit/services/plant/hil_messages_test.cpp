#include "swiftlet/services/plant/hil_messages.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

namespace swiftlet::services::hil_messages_test {

using Eigen::Vector3d;
using mavlink::HilSensor;

TEST(HilMessages, SensorHasTheUnitsOfMavlinkAndNamesWhatIsNew) {
  plant::ImuSample imu;
  imu.specific_force_frd = Vector3d(0.5, -0.25, -9.75);
  imu.body_rates_frd = Vector3d(0.125, 0.25, -0.5);
  plant::NavigationSamples navigation;
  HilSensor sensor = hil_sensor(2000, imu, navigation);
  EXPECT_EQ(sensor.time_usec, 2000U);
  EXPECT_EQ(sensor.acceleration, (std::array<float, 3>{0.5F, -0.25F, -9.75F}));
  EXPECT_EQ(sensor.gyro, (std::array<float, 3>{0.125F, 0.25F, -0.5F}));
  EXPECT_EQ(sensor.fields_updated, 0x3fU);
  navigation.barometer = plant::BarometerSample{95'600.0, 488.5, 11.75};
  navigation.magnetic_field_frd = Vector3d(0.25, 0.0, 0.5);
  sensor = hil_sensor(4000, std::nullopt, navigation);
  EXPECT_EQ(sensor.fields_updated, 0x1bc0U);
  EXPECT_FLOAT_EQ(sensor.abs_pressure, 956.0F);  // hPa
  EXPECT_FLOAT_EQ(sensor.pressure_alt, 488.5F);
  EXPECT_FLOAT_EQ(sensor.temperature, 11.75F);
  EXPECT_EQ(sensor.mag, (std::array<float, 3>{0.25F, 0.0F, 0.5F}));
}

TEST(HilMessages, GpsHasTheUnitsOfMavlink) {
  plant::GpsSample gps;
  gps.position = {47.3977418, -8.5455938};
  gps.altitude_m = 488.25;
  gps.velocity_ned = Vector3d(-3.0, -4.0, 0.5);
  gps.horizontal_accuracy_m = 0.42;
  gps.vertical_accuracy_m = 0.61;
  const mavlink::HilGps message = hil_gps(17, gps);
  EXPECT_EQ(message.time_usec, 17U);
  EXPECT_EQ(message.lat, 473'977'418);
  EXPECT_EQ(message.lon, -85'455'938);
  EXPECT_EQ(message.alt, 488'250);
  EXPECT_EQ(message.eph, 42);
  EXPECT_EQ(message.epv, 61);
  EXPECT_EQ(message.vel, 500);
  EXPECT_EQ(message.vn, -300);
  EXPECT_EQ(message.ve, -400);
  EXPECT_EQ(message.vd, 50);
  EXPECT_EQ(message.cog, 23'313);  // south-west
  EXPECT_EQ(message.fix_type, 3);
}

TEST(HilMessages, GpsHasNoCourseAtRestAndLimitsWhatDoesNotFit) {
  plant::GpsSample gps;
  EXPECT_EQ(hil_gps(0, gps).cog, mavlink::HilGps::kUnknown);
  gps.velocity_ned = Vector3d(1e4, std::numeric_limits<double>::quiet_NaN(), -1e4);
  const mavlink::HilGps message = hil_gps(0, gps);
  EXPECT_EQ(message.vn, 32'767);
  EXPECT_EQ(message.ve, 0);
  EXPECT_EQ(message.vd, -32'768);
}

TEST(HilMessages, StateIsTheTruth) {
  plant::TruthSample truth;
  truth.position_ned = Vector3d(0.0, 0.0, -2.0);
  truth.velocity_ned = Vector3d(1.0, -0.5, 0.25);
  truth.q_ned_from_frd = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitZ());
  truth.body_rates_frd = Vector3d(0.1, 0.2, 0.3);
  plant::ImuSample imu;
  imu.specific_force_frd = Vector3d(plant::kGravity, 0.0, -plant::kGravity);
  const mavlink::HilStateQuaternion state = hil_state(6000, truth, imu, plant::SiteSettings());
  EXPECT_EQ(state.time_usec, 6000U);
  EXPECT_FLOAT_EQ(state.attitude_quaternion[0], 0.70710678F);
  EXPECT_FLOAT_EQ(state.attitude_quaternion[3], 0.70710678F);
  EXPECT_EQ(state.lat, 473'977'420);
  EXPECT_EQ(state.lon, 85'455'940);
  EXPECT_EQ(state.alt, 490'000);
  EXPECT_EQ(state.velocity, (std::array<std::int16_t, 3>{100, -50, 25}));
  EXPECT_EQ(state.acceleration, (std::array<std::int16_t, 3>{0, 1000, 0}));  // forward is east
}

}  // namespace swiftlet::services::hil_messages_test
