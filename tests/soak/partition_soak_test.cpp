// `./dev soak partition`: each row of the table is a test case, with a check for each cut.
#include <algorithm>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/soak/partition_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

void expect_as_in_the_table(NetworkFlight::Host from, NetworkFlight::Host to, bool standby) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const auto row = std::find_if(partitions().begin(), partitions().end(), [&](const Partition& partition) {
    return partition.from == from && partition.to == to && partition.standby == standby;
  });
  ASSERT_NE(row, partitions().end());
  const tests::TemporaryFolder folder;
  int cuts = 0;
  fly_through(*row, folder.path(), [&](const Cut& cut, const CutResult& result) {
    ++cuts;
    if (const std::string repeats = repeats_of(result); !repeats.empty())
      std::printf("%s: %d ms cut, %s\n", row->name().c_str(), cut.ms, repeats.c_str());
    EXPECT_EQ(fault_of(*row, cut, result), "")
        << row->name() << ", " << cut.ms
        << " ms: " << (result.outcome ? to_string(*result.outcome) : "neither") << " (" << result.reasons
        << "), " << result.metrics.longest_gap_ms << " ms without a new command (a core stood still for "
        << result.core_stood_still_ms << " ms), " << result.metrics.largest_deviation_m
        << " m off the reference, " << result.metrics.final_distance_m << " m from the place of the cut\n"
        << result.log;
  });
  EXPECT_EQ(cuts, 4);
}

TEST(Partition, WithoutControlTheVehicleFalls) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kControl, false);
}

TEST(Partition, WithoutControlAStandbyFliesOn) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kControl, true);
}

TEST(Partition, WithoutGroundTheVehicleLands) {
  expect_as_in_the_table(NetworkFlight::kControl, NetworkFlight::kGround, false);
}

TEST(Partition, WithoutGroundTheVehicleLandsAlsoWithAStandby) {
  expect_as_in_the_table(NetworkFlight::kControl, NetworkFlight::kGround, true);
}

TEST(Partition, WithoutMotionCaptureTheVehicleHoldsOrLands) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kMocap, false);
}

TEST(Partition, WithoutMotionCaptureTheVehicleHoldsOrLandsAlsoWithAStandby) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kMocap, true);
}

TEST(Partition, WithoutPosesTheVehicleHoldsOrLands) {
  expect_as_in_the_table(NetworkFlight::kMocap, NetworkFlight::kControl, false);
}

TEST(Partition, WithoutPosesTheVehicleHoldsOrLandsAlsoWithAStandby) {
  expect_as_in_the_table(NetworkFlight::kMocap, NetworkFlight::kControl, true);
}

TEST(Partition, BetweenVehicleAndGroundDoesNotDisturbAFlight) {
  expect_as_in_the_table(NetworkFlight::kVehicle, NetworkFlight::kGround, false);
}

}  // namespace
}  // namespace swiftlet::soak
