// `swiftlet identify flight` with logs of PX4 that the test writes.
#include "swiftlet/analysis/identify/identify_ulog.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/ulog_writer.hpp"

namespace swiftlet::analysis::identify_ulog_test {

using nlohmann::json;
using tests::UlogWriter;

class IdentifyUlog : public testing::Test {
 protected:
  // A flight of 20 s from 2 s on: throttle at 50 Hz, an accelerometer with noise at 250 Hz behind the lag of the motors. The
  // throttle swings by `swing` about that of hover, 0.4; each 1 of throttle gives 1.5 times g / 0.4.
  std::string log(double swing, bool with_motors = true) const {
    UlogWriter file;
    file.format("vehicle_thrust_setpoint:uint64_t timestamp;float[3] xyz;");
    file.format("sensor_combined:uint64_t timestamp;float[3] accelerometer_m_s2;");
    file.format("vehicle_land_detected:uint64_t timestamp;bool landed;");
    file.format("battery_status:uint64_t timestamp;float voltage_v;");
    file.format("actuator_motors:uint64_t timestamp;float[4] control;");
    file.subscribe(1, "vehicle_thrust_setpoint");
    file.subscribe(2, "sensor_combined");
    file.subscribe(3, "vehicle_land_detected");
    file.subscribe(4, "battery_status");
    if (with_motors) file.subscribe(5, "actuator_motors");
    math::RandomStream random(7, 1);
    double throttle = 0.0;
    double lagged = 0.0;
    for (std::uint64_t ms = 0; ms < 24'000; ms += 4) {
      const double time_s = 1e-3 * static_cast<double>(ms);
      const bool flies = time_s > 2.0 && time_s < 22.0;
      if (ms % 20 == 0) {
        throttle = flies ? 0.4 + swing * std::sin(2.0 * time_s) : 0.0;
        file.data(1, 1000 * ms, floats({0.0, 0.0, -throttle}));
      }
      lagged += (throttle - lagged) * (1.0 - std::exp(-0.004 / base_.motor.time_constant_s));
      const double up = flies ? plant::kGravity * (1.0 + 1.5 * (lagged - 0.4) / 0.4) : plant::kGravity;
      file.data(2, 1000 * ms + 1, floats({0.0, 0.0, -up + 0.3 * random.normal()}));
      if (ms % 1000 == 0) {
        file.data(3, 1000 * ms, UlogWriter::raw(static_cast<std::uint8_t>(flies ? 0 : 1)));
        file.data(4, 1000 * ms, UlogWriter::raw(3.8F));
      }
      if (ms % 100 == 0 && with_motors) file.data(5, 1000 * ms, floats({0.4, 0.4, 0.4, 0.4}));
    }
    return folder_.write("flight.ulg", file.bytes());
  }
  static std::string floats(const std::vector<double>& values) {
    std::string out;
    for (const double value : values) out += UlogWriter::raw(static_cast<float>(value));
    return out;
  }
  json identify(const std::string& file) const {
    IdentifyFlightOptions options;
    options.logs = {file};
    options.json = true;
    testing::internal::CaptureStdout();
    EXPECT_EQ(identify_ulog(options, base_, "kaylion"), io::kDone);
    return json::parse(testing::internal::GetCapturedStdout()).at("thrust_scales").at(0);
  }

  tests::TemporaryFolder folder_;
  const plant::Vehicle base_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
};

TEST_F(IdentifyUlog, FindsHoverAndSlope) {
  const json found = identify(log(0.05));
  EXPECT_NEAR(found.at("hover_throttle").get<double>(), 0.4, 0.002);
  const double slope_n = 1.5 * base_.mass_kg * plant::kGravity / 0.4;
  EXPECT_NEAR(found.at("slope_n").get<double>(), slope_n, 0.03 * slope_n);
  EXPECT_NEAR(found.at("supply_voltage_v").get<double>(), 3.8, 1e-6);
  EXPECT_NE(found.at("not_identifiable").get<std::string>().find("actuator_motors is logged at 10 Hz"),
            std::string::npos);
}

TEST_F(IdentifyUlog, AHoverHasNoSlope) {
  const json found = identify(log(0.0, false));
  EXPECT_NEAR(found.at("hover_throttle").get<double>(), 0.4, 0.002);
  EXPECT_TRUE(found.at("slope_n").is_null());
  EXPECT_NE(found.at("not_identifiable").get<std::string>().find("actuator_motors is not logged"),
            std::string::npos);
}

// A sector that was not written, within a swing of the throttle.
TEST_F(IdentifyUlog, SaysWhatIsLostWithin) {
  const std::string file = log(0.05);
  std::string bytes = io::read_text_file(file);
  bytes.replace(bytes.size() / 2, 5000, std::string(5000, '\0'));
  const json found = identify(folder_.write("lost.ulg", bytes));
  EXPECT_NEAR(found.at("hover_throttle").get<double>(), 0.4, 0.002);
  const double slope_n = 1.5 * base_.mass_kg * plant::kGravity / 0.4;
  EXPECT_NEAR(found.at("slope_n").get<double>(), slope_n, 0.03 * slope_n);
  ASSERT_EQ(found.at("lost").size(), 1U);
  const json& loss = found.at("lost")[0];
  EXPECT_NEAR(loss.at("bytes").get<double>(), 5000.0, 60.0);
  EXPECT_NEAR(loss.at("from_s").get<double>(), 12.0, 0.1) << "the middle of the log";
  const double lost_s = 24.0 * 5000.0 / static_cast<double>(bytes.size());
  EXPECT_NEAR(loss.at("until_s").get<double>() - loss.at("from_s").get<double>(), lost_s, 0.1 * lost_s);
  EXPECT_EQ(identify(file).at("lost"), json::array());
}

std::string refusal(const IdentifyFlightOptions& options, const plant::Vehicle& base) {
  try {
    identify_ulog(options, base, "kaylion");
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

TEST_F(IdentifyUlog, RefusesWhatALogDoesNotHave) {
  IdentifyFlightOptions options;
  options.logs = {log(0.05)};
  options.out = "mine.yaml";
  EXPECT_EQ(refusal(options, base_),
            "--out: a log of PX4 gives the thrust scale alone, no parameters of a vehicle file");
  options.out.clear();
  options.fit.bounds.from_s = 10.0;
  options.fit.bounds.until_s = 11.0;
  EXPECT_NE(refusal(options, base_).find("2 s are needed"), std::string::npos);
  UlogWriter empty;
  options.logs = {folder_.write("empty.ulg", empty.bytes())};
  EXPECT_NE(refusal(options, base_).find("has no messages of topic vehicle_thrust_setpoint"),
            std::string::npos);
}

}  // namespace swiftlet::analysis::identify_ulog_test
