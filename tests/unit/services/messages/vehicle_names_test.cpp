#include "swiftlet/services/messages/vehicle_names.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::messages::vehicle_names_test {

using Names = std::vector<std::string>;

TEST(VehicleList, KeepsTheOrderOfNamesAndRanges) {
  EXPECT_EQ(vehicles_of_list("kl1"), Names({"kl1"}));
  EXPECT_EQ(vehicles_of_list("kl1,kl2,kl5..kl7"), Names({"kl1", "kl2", "kl5", "kl6", "kl7"}));
  EXPECT_EQ(vehicles_of_list("b,a9..a11,c_2"), Names({"b", "a9", "a10", "a11", "c_2"}));
  EXPECT_EQ(vehicles_of_list("kl3..kl3"), Names({"kl3"}));
}

TEST(VehicleList, KeepsLeadingZeros) {
  EXPECT_EQ(vehicles_of_list("kl08..kl11"), Names({"kl08", "kl09", "kl10", "kl11"}));
}

TEST(VehicleList, RefusesWithAClauseThatNamesTheFault) {
  EXPECT_EQ(fault_of_vehicle_list("kl7..kl5"),
            "has the range kl7..kl5, whose second number is below its first");
  EXPECT_EQ(fault_of_vehicle_list("kl1..b5"), "has the range kl1..b5, which must be like kl5..kl7");
  EXPECT_EQ(fault_of_vehicle_list("kl1.."), "has the range kl1.., which must be like kl5..kl7");
  EXPECT_EQ(fault_of_vehicle_list("kl1..kl2..kl3"),
            "has the range kl1..kl2..kl3, which must be like kl5..kl7");
  EXPECT_EQ(fault_of_vehicle_list("kl1,kl1"), "names kl1 twice");
  EXPECT_EQ(fault_of_vehicle_list("kl1..kl4,kl3"), "names kl3 twice");
  EXPECT_EQ(fault_of_vehicle_list("kl1..kl999999999"), "names more than 200 vehicles");
  EXPECT_EQ(fault_of_vehicle_list("a1..a150,b1..b51"), "names more than 200 vehicles");
  for (const char* const list : {"", "kl1,,kl2", "kl1,", "kl 1", "1..3", "kl1-kl3"})
    EXPECT_NE(fault_of_vehicle_list(list), "") << list;
  EXPECT_THROW(vehicles_of_list("kl1,kl1"), std::invalid_argument);
}

}  // namespace swiftlet::messages::vehicle_names_test
