#include "swiftlet/analysis/identify/bench_files.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::analysis::bench_files_test {

const plant::Vehicle& kaylion() {
  static const plant::Vehicle vehicle = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  return vehicle;
}

class BenchFolder : public testing::Test {
 protected:
  Bench load() { return load_bench(folder_.path(), load_bench_settings(folder_.path()), kaylion().esc); }
  std::string refused() {
    try {
      load();
    } catch (const std::exception& error) {
      return error.what();
    }
    ADD_FAILURE() << "expected an exception";
    return "";
  }
  std::string at(const char* name) const { return (folder_.path() / name).string(); }

  tests::TemporaryFolder folder_;
};

TEST_F(BenchFolder, ReadsBackWhatWasWritten) {
  const identification::BenchData data = identification::simulate_bench(kaylion(), {}, 7);
  write_bench(folder_.path(), data, "base_vehicle: kaylion\n");
  const Bench bench = load();
  EXPECT_EQ(bench.data.esc->motor_voltage_v, data.esc->motor_voltage_v);
  EXPECT_EQ(bench.data.thrust_torque->torque_n_m, data.thrust_torque->torque_n_m);
  EXPECT_EQ(bench.data.steady_motor->speed_rad_s, data.steady_motor->speed_rad_s);
  EXPECT_EQ(bench.data.motor_step->motor_voltage_v, data.motor_step->motor_voltage_v);
  EXPECT_EQ(bench.data.throttle_thrust->thrust_n, data.throttle_thrust->thrust_n);
  EXPECT_EQ(bench.data.inertia[2]->bifilar->period_s, data.inertia[2]->bifilar->period_s);
  EXPECT_EQ(*bench.data.mass_kg, *data.mass_kg);
  EXPECT_EQ(bench.files.size(), 9U);
  EXPECT_EQ(bench.files.at("esc").lines[3], 5);
}

TEST_F(BenchFolder, ConvertsPulseWidthToThrottleByEq8) {
  folder_.write("esc.csv", "v_s [V],pwm [us],v_a [mV]\n4.0,1539,2500\n");
  const identification::EscData data = *load().data.esc;
  EXPECT_DOUBLE_EQ(data.throttle[0], 0.5);
  EXPECT_DOUBLE_EQ(data.motor_voltage_v[0], 2.5);
}

TEST_F(BenchFolder, RefusesPulseWidthsOutsideEq8) {
  folder_.write("esc.csv", "v_s [V],pwm [us],v_a [V]\n4.0,1539,2.5\n4.0,2500,2.5\n");
  EXPECT_NE(refused().find("esc.csv:3: pulse_width: is 2500 us, must be at least 1039 and at most 2039 us"),
            std::string::npos);
}

TEST_F(BenchFolder, RefusesThrottleAndPulseWidthTogether) {
  folder_.write("esc.csv", "v_s [V],pwm [us],delta [1],v_a [V]\n4.0,1539,0.5,2.5\n");
  EXPECT_NE(refused().find("has a throttle and a pulse width"), std::string::npos);
}

TEST_F(BenchFolder, RefusesUnknownFiles) {
  EXPECT_NE(refused().find("contains no experiment, must contain at least one of mass.csv, esc.csv"),
            std::string::npos);
  folder_.write("stedy_motor.csv", "x\n1\n");
  EXPECT_EQ(refused().find(at("stedy_motor.csv") + ": is not a known experiment"), 0U);
  std::filesystem::rename(at("stedy_motor.csv"), at("mass.CSV"));
  EXPECT_EQ(refused().find(at("mass.CSV") + ": is not a known experiment"), 0U);
}

TEST_F(BenchFolder, ReadsSwingAndBifilarInertiaFiles) {
  folder_.write("inertia_yaw.csv", "arm [cm],period [s]\n5,0.5\n");
  EXPECT_DOUBLE_EQ(load().data.inertia[2]->swing->arm_m[0], 0.05);
  folder_.write("inertia_yaw.csv", "arm [cm],length [m],period [s]\n5,1,0.5\n");
  EXPECT_NE(refused().find("must have either length and separation"), std::string::npos);
}

TEST_F(BenchFolder, ReadsItsSettings) {
  folder_.write("mine.yaml", "");
  folder_.write(
      "bench.yaml",
      "base_vehicle: mine.yaml\nname: kl2\n"
      "propeller: {radius: {value: 0.03, unit: m, source: ruler}, air_density: {value: 1.2, unit: kg/m^3, "
      "source: barometer}}\n"
      "instruments: {speed: {value: 3, unit: rad/s, source: data sheet}}\n");
  const BenchSettings settings = load_bench_settings(folder_.path());
  EXPECT_EQ(settings.base_vehicle, at("mine.yaml"));
  EXPECT_EQ(settings.name, "kl2");
  EXPECT_EQ(settings.propeller->radius_m, 0.03);
  EXPECT_EQ(settings.instruments.speed_rad_s, 3.0);
  EXPECT_FALSE(settings.instruments.thrust_n);
  folder_.write("bench.yaml", "base: kaylion\n");
  EXPECT_NE(tests::refusal([&] { load_bench_settings(folder_.path()); }).find("base"), std::string::npos);
}

}  // namespace swiftlet::analysis::bench_files_test
