// A short form of `./dev soak processes`.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/soak/processes_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

using plant::ControlLevel;

void expect_as_in_the_table(FlightProcess process, ProcessFailure failure, ControlLevel level) {
  const auto& all = process_cases();
  const auto row = std::find_if(all.begin(), all.end(), [&](const ProcessCase& one) {
    return one.process == process && one.failure == failure && one.level == level;
  });
  ASSERT_NE(row, all.end());
  const tests::TemporaryFolder folder;
  const ProcessResult result = fly_with_failure(*row, folder.path());
  ASSERT_TRUE(result.fate.has_value()) << result.reason;
  EXPECT_EQ(*result.fate, row->expected) << to_string(*result.fate) << ": " << result.reason;
  EXPECT_LT(result.climb_m, kMostClimb_m);
}

TEST(Processes, WithoutControlTheVehicleFalls) {
  expect_as_in_the_table(FlightProcess::kControl, ProcessFailure::kKilled, ControlLevel::kActuators);
}

TEST(Processes, AControllerThatComesBackDoesNotStartTheRotors) {
  expect_as_in_the_table(FlightProcess::kControl, ProcessFailure::kHung, ControlLevel::kAttitude);
}

TEST(Processes, WithoutMotionCaptureTheVehicleLands) {
  expect_as_in_the_table(FlightProcess::kMocap, ProcessFailure::kKilled, ControlLevel::kTrajectory);
}

TEST(Processes, WithoutGroundTheVehicleLands) {
  expect_as_in_the_table(FlightProcess::kGround, ProcessFailure::kKilled, ControlLevel::kRates);
}

TEST(Processes, WithoutAVehicleNothingIsCommanded) {
  expect_as_in_the_table(FlightProcess::kPlant, ProcessFailure::kKilled, ControlLevel::kRates);
}

TEST(Processes, AVehicleThatStartsAgainKeepsItsRotorsOff) {
  expect_as_in_the_table(FlightProcess::kPlant, ProcessFailure::kRestarted, ControlLevel::kAttitude);
}

}  // namespace
}  // namespace swiftlet::soak
