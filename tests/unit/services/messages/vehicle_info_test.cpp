#include "swiftlet/services/messages/vehicle_info.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::messages::fixtures::vehicle_info_test {

constexpr double kTolerance = 0.1;

class VehicleInfo : public testing::Test {
 protected:
  VehicleInfo() { describe(kaylion_, info_); }
  std::string difference() const { return messages::difference(info_, kaylion_, kTolerance); }

  const plant::Vehicle kaylion_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  msg::VehicleInfo info_;
};

TEST_F(VehicleInfo, IsThatOfItsFile) {
  EXPECT_EQ(info_.name(), "kaylion");
  EXPECT_EQ(info_.mass_kg(), kaylion_.mass_kg);
  EXPECT_EQ(difference(), "");
  EXPECT_EQ(messages::difference(msg::VehicleInfo(), kaylion_, kTolerance), "") << "nothing is reported";
}

TEST_F(VehicleInfo, MayDifferByTheTolerance) {
  info_.mass_kg(kaylion_.mass_kg * 1.099);
  EXPECT_EQ(difference(), "");
  info_.mass_kg(kaylion_.mass_kg * 0.901);
  EXPECT_EQ(difference(), "");
  info_.mass_kg(kaylion_.mass_kg * 1.101);
  EXPECT_EQ(difference(), "the vehicle is not control's: mass 0.044 kg, not 0.040 kg");
  info_.mass_kg(kaylion_.mass_kg * 0.899);
  EXPECT_NE(difference(), "");
}

TEST_F(VehicleInfo, IsRefusedWithBothFigures) {
  info_.name() = "lab25";
  info_.mass_kg(0.25);
  info_.rotor_count(6);
  EXPECT_EQ(difference(),
            "the vehicle is not control's: lab25, not kaylion; 6 rotors, not 4; mass 0.250 kg, not 0.040 kg");
  describe(kaylion_, info_);
  info_.full_battery_v(8.38);
  info_.empty_battery_v(5.3);
  EXPECT_EQ(
      difference(),
      "the vehicle is not control's: full battery 8.38 V, not 4.19 V; empty battery 5.30 V, not 2.65 V");
}

TEST_F(VehicleInfo, IsRefusedWithFiguresThatAreNone) {
  info_.mass_kg(std::nan(""));
  EXPECT_EQ(difference(), "the vehicle is not control's: mass nan kg, not 0.040 kg");
}

// The text of a refusal is that long; what does not fit is left out whole.
TEST_F(VehicleInfo, IsRefusedInAtMost127Characters) {
  info_.name() = std::string(64, 'x');
  info_.rotor_count(8);
  info_.mass_kg(0.25);
  info_.full_battery_v(8.38);
  info_.empty_battery_v(5.3);
  EXPECT_EQ(difference(), "the vehicle is not control's: " + std::string(24, 'x') +
                              ", not kaylion; 8 rotors, not 4; mass 0.250 kg, not 0.040 kg");
}

}  // namespace swiftlet::messages::fixtures::vehicle_info_test
