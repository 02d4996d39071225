// A short form of `./dev soak partition`: the cuts that differ most, in one flight.
#include <algorithm>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/soak/partition_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

using Host = NetworkFlight::Host;

// A row of the table with these of its cuts.
Partition row(Host from, Host to, bool standby, const std::vector<int>& cuts_ms) {
  const auto& all = partitions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Partition& partition) {
    return partition.from == from && partition.to == to && partition.standby == standby;
  });
  if (found == all.end()) throw std::invalid_argument("the table has no such row");
  Partition part = *found;
  part.cuts.clear();
  for (const Cut& cut : found->cuts) {
    if (std::find(cuts_ms.begin(), cuts_ms.end(), cut.ms) != cuts_ms.end()) part.cuts.push_back(cut);
  }
  return part;
}

// The outcomes are those of longer cuts too, and with a standby those without: the soak makes all.
TEST(Partition, CutsComeOutAsInTheTable) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  constexpr Host kVehicle = NetworkFlight::kVehicle;
  constexpr Host kControl = NetworkFlight::kControl;
  constexpr Host kGround = NetworkFlight::kGround;
  constexpr Host kMocap = NetworkFlight::kMocap;
  const std::vector<Partition> rows{
      row(kControl, kGround, false, {5000}),     row(kMocap, kControl, false, {1000, 5000}),
      row(kVehicle, kGround, false, {5000}),     row(kVehicle, kControl, false, {50, 300}),
      row(kControl, kGround, true, {300}),       row(kMocap, kControl, true, {300}),
      row(kVehicle, kControl, true, {50, 5000}),
  };
  const tests::TemporaryFolder folder;
  int cuts = 0;
  fly_through(rows, folder.path(), [&](const Partition& partition, const Cut& cut, const CutResult& result) {
    ++cuts;
    EXPECT_EQ(fault_of(partition, cut, result), "")
        << partition.name() << ", " << cut.ms
        << " ms: " << (result.outcome ? to_string(*result.outcome) : "neither") << " (" << result.reasons
        << "), " << result.metrics.longest_gap_ms << " ms without a new command (a core stood still for "
        << result.core_stood_still_ms << " ms), " << result.metrics.largest_deviation_m
        << " m off the reference, " << result.metrics.final_distance_m << " m from the place of the cut\n"
        << result.log;
  });
  EXPECT_EQ(cuts, 10);
}

}  // namespace
}  // namespace swiftlet::soak
