#include "swiftlet/io/settings/vehicle_writer.hpp"

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::vehicle_writer_test {

using tests::refusal;

const std::string kKaylion = tests::in_source("config/vehicles/kaylion.yaml");

std::string written(const plant::VehicleUncertainty& uncertainty = {}) {
  return vehicle_text(load_vehicle(kKaylion), load_vehicle_sources(kKaylion), uncertainty,
                      "first line\nsecond");
}

const plant::VehicleUncertainty kUncertainty = {{{"motor.k2", 1.2e-5, 9.9e-4, 1.05e-3},
                                                 {"motor.k3", 4e-9, 2.7e-7, 2.9e-7},
                                                 {"inertia.zz", 1e-6, 8.6e-5, 9e-5}},
                                                {{"motor.k2", "motor.k3", -0.97}}};

TEST(VehicleWriter, WrittenVehicleReadsBackUnchanged) {
  const std::string once = written();
  const plant::Vehicle back = parse_vehicle(once, "once.yaml");
  EXPECT_EQ(vehicle_text(back, parse_vehicle_sources(once, "once.yaml"), {}, "first line\nsecond"), once);
  const plant::Vehicle kaylion = load_vehicle(kKaylion);
  EXPECT_EQ(back.rotors[3].position_frd, kaylion.rotors[3].position_frd);
  EXPECT_EQ(back.rotors[3].spin, kaylion.rotors[3].spin);
  EXPECT_EQ(back.inertia, kaylion.inertia);
  EXPECT_EQ(back.rotor.torque, kaylion.rotor.torque);
  EXPECT_EQ(back.battery.open_circuit_voltage_v, kaylion.battery.open_circuit_voltage_v);
  EXPECT_EQ(once.substr(0, 23), "# first line\n# second\nn");
}

TEST(VehicleWriter, KeepsSources) {
  const VehicleSources sources = parse_vehicle_sources(written(), "f.yaml");
  EXPECT_EQ(sources, load_vehicle_sources(kKaylion));
  EXPECT_EQ(sources.at("motor.k2"), "Eq. (22)");
  EXPECT_EQ(sources.at("mass"), "estimate: published as under 40 g");
}

TEST(VehicleWriter, EscapesQuotesInSources) {
  VehicleSources sources = load_vehicle_sources(kKaylion);
  sources["mass"] = "the \"good\" balance, \\ or not: #1";
  const std::string text = vehicle_text(load_vehicle(kKaylion), sources, {}, "");
  EXPECT_EQ(parse_vehicle_sources(text, "f.yaml").at("mass"), sources["mass"]);
}

TEST(VehicleUncertaintySection, ReadsBack) {
  const std::string text = written(kUncertainty);
  EXPECT_NO_THROW(parse_vehicle(text, "f.yaml"));
  const plant::VehicleUncertainty back = parse_vehicle_uncertainty(text, "f.yaml");
  ASSERT_EQ(back.parameters.size(), 3U);
  EXPECT_EQ(back.parameters[1].parameter, "motor.k3");
  EXPECT_EQ(back.parameters[1].standard_error, 4e-9);
  EXPECT_EQ(back.parameters[1].low, 2.7e-7);
  EXPECT_EQ(back.parameters[1].high, 2.9e-7);
  ASSERT_EQ(back.correlations.size(), 1U);
  EXPECT_EQ(back.correlations[0].second, "motor.k3");
  EXPECT_EQ(back.correlations[0].value, -0.97);
  EXPECT_TRUE(load_vehicle_uncertainty(kKaylion).parameters.empty());
}

TEST(VehicleUncertaintySection, RefusesInvalidEntries) {
  const auto refused = [](plant::VehicleUncertainty uncertainty) {
    return refusal([&] { parse_vehicle(written(uncertainty), "f.yaml"); });
  };
  plant::VehicleUncertainty bad = kUncertainty;
  bad.parameters[0].parameter = "motor.k7";
  EXPECT_NE(refused(bad).find("is motor.k7, must be one of mass, "), std::string::npos);
  bad = kUncertainty;
  bad.parameters[1].parameter = "motor.k2";
  EXPECT_NE(refused(bad).find("is motor.k2, which is listed already"), std::string::npos);
  bad = kUncertainty;
  bad.parameters[0].low = 1.0;
  EXPECT_NE(refused(bad).find("interval_95: must rise"), std::string::npos);
  bad = kUncertainty;
  bad.parameters[0].standard_error = -1.0;
  EXPECT_NE(refused(bad).find("standard_error: is -1, must be"), std::string::npos);
  bad = kUncertainty;
  bad.correlations[0].value = 1.5;
  EXPECT_NE(refused(bad).find("value: is 1.5, must be"), std::string::npos);
}

}  // namespace swiftlet::io::vehicle_writer_test
