#include "swiftlet/ground/view/found_vehicles.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::found_vehicles_test {

using Names = std::vector<std::string>;

// GIVEN a vehicle of which either part cannot be added twice THEN the other one is added at once and only once, and it is tried
// again until it can.
TEST(FoundVehicles, TriesEachPartUntilItSucceeds) {
  for (const std::size_t failing : {0U, 1U}) {
    int failures = 2;
    std::vector<Names> added(2);
    Names said;
    const auto part = [&](std::size_t number) {
      return [&, number](const std::string& vehicle) {
        if (number == failing && failures-- > 0) throw std::runtime_error("no memory");
        added[number].push_back(vehicle);
      };
    };
    FoundVehicles found({part(0), part(1)}, [&](const std::string& sentence) { said.push_back(sentence); });
    EXPECT_TRUE(found.add("kl1"));
    EXPECT_EQ(added[1 - failing], Names{"kl1"});
    EXPECT_EQ(added[failing], Names{});
    EXPECT_TRUE(found.add("kl1"));
    EXPECT_TRUE(found.add("kl1"));
    EXPECT_FALSE(found.add("kl1")) << "it has both";
    EXPECT_TRUE(found.add("kl2"));
    EXPECT_EQ(added[0], (Names{"kl1", "kl2"}));
    EXPECT_EQ(added[1], (Names{"kl1", "kl2"}));
    EXPECT_EQ(said, Names{"vehicle kl1: no memory"}) << "once";
  }
}

}  // namespace swiftlet::ground::found_vehicles_test
