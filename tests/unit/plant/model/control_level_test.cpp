#include "swiftlet/plant/model/control_level.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle_command.hpp"

namespace swiftlet::tests::control_level_test {

using plant::ControlLevel;
using plant::ControlLevels;

TEST(ControlLevels, AVehicleThatReportsNoneAcceptsActuators) {
  EXPECT_EQ(ControlLevels::from_bits(0), ControlLevels(ControlLevel::kActuators));
  EXPECT_EQ(ControlLevels::from_bits(0xf0), ControlLevels(ControlLevel::kActuators)) << "bits of no level";
}

TEST(ControlLevels, TheLowestIsTheOneClosestToTheRotors) {
  EXPECT_EQ(ControlLevels::from_bits(0b1111).lowest(), ControlLevel::kActuators);
  EXPECT_EQ(ControlLevels::from_bits(0b1110).lowest(), ControlLevel::kRates);
  EXPECT_EQ(ControlLevels::from_bits(0b1100).lowest(), ControlLevel::kAttitude);
  EXPECT_EQ(ControlLevels::from_bits(0b1000).lowest(), ControlLevel::kTrajectory);
}

TEST(ControlLevels, NamesAreListedFromTheRotorsOutwards) {
  EXPECT_STREQ(ControlLevels::from_bits(0b1111).names().data(), "actuators, rates, attitude, trajectory");
  EXPECT_STREQ(ControlLevels(ControlLevel::kAttitude).names().data(), "attitude");
  EXPECT_STREQ(ControlLevels().names().data(), "");
}

TEST(ControlLevels, AListIsReadWhole) {
  EXPECT_EQ(plant::control_levels_from("trajectory,rates"), ControlLevels::from_bits(0b1010));
  for (const char* list : {"", "rates,", ",rates", "rate", "rates, attitude", "Rates"})
    EXPECT_FALSE(plant::control_levels_from(list)) << list;
}

TEST(VehicleCommand, RotorsOffKeepsHeaderAndLevel) {
  plant::CommandHeader header;
  header.stamp_ns = 5;
  header.term = 6;
  header.rotor_state = plant::RotorState::kRunning;
  for (const ControlLevel level : plant::kControlLevels) {
    const plant::VehicleCommand off = plant::rotors_off(level, header, 4);
    EXPECT_EQ(plant::level_of(off), level);
    EXPECT_EQ(plant::header_of(off).stamp_ns, 5);
    EXPECT_EQ(plant::header_of(off).term, 6U);
    EXPECT_EQ(plant::header_of(off).rotor_state, plant::RotorState::kOff);
  }
}

}  // namespace swiftlet::tests::control_level_test
