#include "services/runtime/simulation_file.hpp"

#include <gtest/gtest.h>

#include "services/runtime/text_file.hpp"
#include "tests/unit/runtime/config_error_check.hpp"

namespace swiftlet::runtime {
namespace {

using plant::SimulationSettings;
using tests::refusal;

std::string file(const std::string& name) {
  return read_text_file(SWIFTLET_SOURCE_DIR "/config/simulation/" + name + ".yaml");
}

// default.yaml with one text in place of another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = file("default");
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << from << " is not in the file";
    return text;
  }
  return text.replace(at, from.size(), to);
}

std::string refused(const std::string& from, const std::string& to) {
  return refusal([&] { parse_simulation_settings(changed(from, to), "s.yaml"); });
}

TEST(SimulationFile, DefaultIsWhatTheStructSays) {
  const SimulationSettings file_says = parse_simulation_settings(file("default"), "s.yaml");
  const SimulationSettings struct_says;
  EXPECT_EQ(file_says.name, struct_says.name);
  EXPECT_EQ(file_says.step_ns, struct_says.step_ns);
  EXPECT_EQ(file_says.command_timeout_s, struct_says.command_timeout_s);
  EXPECT_EQ(file_says.rotor_speed_rate_hz, struct_says.rotor_speed_rate_hz);
  EXPECT_EQ(file_says.imu.rate_hz, struct_says.imu.rate_hz);
  EXPECT_EQ(file_says.imu.accelerometer_noise_density, struct_says.imu.accelerometer_noise_density);
  EXPECT_EQ(file_says.imu.gyro_noise_density, struct_says.imu.gyro_noise_density);
  EXPECT_EQ(file_says.imu.accelerometer_bias_sigma, struct_says.imu.accelerometer_bias_sigma);
  EXPECT_EQ(file_says.imu.gyro_bias_sigma, struct_says.imu.gyro_bias_sigma);
  EXPECT_EQ(file_says.imu.accelerometer_bias_walk, struct_says.imu.accelerometer_bias_walk);
  EXPECT_EQ(file_says.imu.gyro_bias_walk, struct_says.imu.gyro_bias_walk);
  EXPECT_NEAR(file_says.imu.accelerometer_range, struct_says.imu.accelerometer_range, 0.01);
  EXPECT_EQ(file_says.imu.gyro_range, struct_says.imu.gyro_range);
  EXPECT_EQ(file_says.mocap.rate_hz, struct_says.mocap.rate_hz);
  EXPECT_EQ(file_says.mocap.latency_s, struct_says.mocap.latency_s);
  EXPECT_EQ(file_says.mocap.position_error_m, struct_says.mocap.position_error_m);
  EXPECT_EQ(file_says.mocap.orientation_error_rad, struct_says.mocap.orientation_error_rad);
  EXPECT_EQ(file_says.mocap.misalignment_rad, struct_says.mocap.misalignment_rad);
  EXPECT_EQ(file_says.mocap.dropout_probability, struct_says.mocap.dropout_probability);
  EXPECT_EQ(file_says.mocap.dropout_length_s, struct_says.mocap.dropout_length_s);
  EXPECT_EQ(file_says.supply.ideal, struct_says.supply.ideal);
  EXPECT_EQ(file_says.supply.initial_state_of_charge, struct_says.supply.initial_state_of_charge);
  EXPECT_EQ(file_says.supply.rate_hz, struct_says.supply.rate_hz);
  EXPECT_EQ(file_says.air.drag, struct_says.air.drag);
  EXPECT_EQ(file_says.air.wind_ned, struct_says.air.wind_ned);
  EXPECT_EQ(file_says.air.gust_sigma_ned, struct_says.air.gust_sigma_ned);
  EXPECT_EQ(file_says.air.gust_time_constant_s, struct_says.air.gust_time_constant_s);
  EXPECT_EQ(file_says.ground.present, struct_says.ground.present);
  EXPECT_EQ(file_says.ground.leg_height_m, struct_says.ground.leg_height_m);
  EXPECT_EQ(file_says.ground.friction, struct_says.ground.friction);
}

TEST(SimulationFile, OptitrackDrawsItsIntervals) {
  const SimulationSettings s = parse_simulation_settings(file("optitrack"), "s.yaml");
  EXPECT_EQ(s.name, "optitrack");
  EXPECT_EQ(s.mocap.model, plant::MocapModel::kOptitrack);
  EXPECT_EQ(s.mocap.interval_quantiles_s, plant::MocapSettings().interval_quantiles_s);
  std::string text = file("optitrack");
  const std::string falls = "0.0400, 0.1300";
  text.replace(text.find(falls), falls.size(), "0.1300, 0.0400");
  EXPECT_NE(refusal([&] { parse_simulation_settings(text, "s.yaml"); }).find("interval_quantiles_s[9]"),
            std::string::npos);
}

TEST(SimulationFile, IdealHasNoErrors) {
  const SimulationSettings s = parse_simulation_settings(file("ideal"), "s.yaml");
  EXPECT_EQ(s.name, "ideal");
  for (const double error :
       {s.imu.accelerometer_noise_density, s.imu.gyro_noise_density, s.imu.accelerometer_bias_sigma,
        s.imu.gyro_bias_sigma, s.imu.accelerometer_bias_walk, s.imu.gyro_bias_walk, s.mocap.latency_s,
        s.mocap.position_error_m, s.mocap.orientation_error_rad, s.mocap.misalignment_rad,
        s.mocap.dropout_probability}) {
    EXPECT_EQ(error, 0.0);
  }
  EXPECT_TRUE(s.supply.ideal);
  EXPECT_FALSE(s.air.drag);
  EXPECT_TRUE(s.air.wind_ned.isZero(0.0));
  EXPECT_TRUE(s.air.gust_sigma_ned.isZero(0.0));
}

TEST(SimulationFile, FaultsHaveTheirSentence) {
  EXPECT_EQ(refused("  friction: 0.6", "  friction: -1"),
            "s.yaml:46: ground.friction: is -1, must be at least 0 and at most 10");
  EXPECT_EQ(refused("rate_hz: 500  #", "rate_hz: 400  #"),
            "s.yaml:11: imu.rate_hz: is 400, must have a period that is a whole number of steps of 0.001 s");
  EXPECT_EQ(refused("wind_ned_m_s: [0, 0, 0]", "wind_ned_m_s: [0, 99, 0]"),
            "s.yaml:38: air.wind_ned_m_s[1]: is 99, must be at least -30 and at most 30");
}

TEST(SimulationFile, RefusesWhatIsNoSetting) {
  EXPECT_NE(refused("  drag:", "  drug:").find("s.yaml:36: air.drag: "), std::string::npos);
  EXPECT_NE(refused("  drag: true", "  drag: true\n  lift: 1").find("s.yaml:38: air.lift: "),
            std::string::npos);
  EXPECT_NE(refused("  latency_s: 0.010", "  latency_s: soon").find("s.yaml:24: mocap.latency_s: is soon"),
            std::string::npos);
  EXPECT_NE(refused("  latency_s: 0.010", "  latency_s: .nan").find("s.yaml:24: mocap.latency_s: "),
            std::string::npos);
  EXPECT_NE(refused("step_s: 0.001", "step_s: 7").find("s.yaml:5: step_s: is 7"), std::string::npos);
}

TEST(SimulationFile, NamesAFileThatIsNotThere) {
  EXPECT_NE(refusal([] { load_simulation_settings("/nowhere/s.yaml"); }).find("/nowhere/s.yaml: "),
            std::string::npos);
}

}  // namespace
}  // namespace swiftlet::runtime
