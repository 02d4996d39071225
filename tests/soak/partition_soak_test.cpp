// A short form of `./dev soak partition`.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/soak/partition_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

void expect_as_in_the_table(NetworkFlight::Host from, NetworkFlight::Host to, int cut_ms, bool standby) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const auto row = std::find_if(partitions().begin(), partitions().end(), [&](const Partition& partition) {
    return partition.from == from && partition.to == to && partition.cut_ms == cut_ms &&
           partition.standby == standby;
  });
  ASSERT_NE(row, partitions().end());
  const tests::TemporaryFolder folder;
  const PartitionResult result = fly_through(*row, folder.path());
  ASSERT_TRUE(result.outcome.has_value()) << result.reason;
  EXPECT_EQ(*result.outcome, row->expected) << to_string(*result.outcome) << ": " << result.reason;
  EXPECT_TRUE(result.healed);
  EXPECT_TRUE(result.priority_kept);
  EXPECT_EQ(result.standby_took_over, standby);
}

TEST(Partition, StandbyOnTheVehiclesHostFliesOnWithoutTheController) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kControl, 1000, true);
}

TEST(Partition, ShortCutBetweenVehicleAndControlDoesNotEndTheFlight) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kControl, 50, false);
}

}  // namespace
}  // namespace swiftlet::soak
