// A short form of `./dev soak processes`, at twice real time: each row with other processes at another level.
#include <algorithm>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/soak/processes_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

using plant::ControlLevel;

struct Failing {
  FlightProcess process;
  ProcessFailure failure;
};

// One after the other, in one flight.
void expect_as_in_the_table(ControlLevel level, const std::vector<Failing>& failures) {
  const auto& all = process_cases();
  std::vector<ProcessCase> rows;
  for (const Failing& failing : failures) {
    const auto row = std::find_if(all.begin(), all.end(), [&](const ProcessCase& one) {
      return one.process == failing.process && one.failure == failing.failure && one.level == level;
    });
    if (row == all.end()) throw std::invalid_argument("the table has no such row");
    rows.push_back(*row);
  }
  const tests::TemporaryFolder folder;
  const std::vector<ProcessResult> results = fly_with_failures(rows, folder.path(), 2.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].name());
    ASSERT_TRUE(results[i].fate.has_value()) << results[i].reason;
    EXPECT_EQ(*results[i].fate, rows[i].expected) << to_string(*results[i].fate) << ": " << results[i].reason;
    EXPECT_LT(results[i].climb_m, kMostClimb_m);
  }
}

TEST(Processes, WithoutControlTheVehicleFalls) {
  expect_as_in_the_table(ControlLevel::kActuators, {{FlightProcess::kControl, ProcessFailure::kKilled}});
}

TEST(Processes, AVehicleThatStartsAgainKeepsItsRotorsOffAndAControllerThatComesBackDoesNotStartThem) {
  expect_as_in_the_table(ControlLevel::kAttitude, {{FlightProcess::kPlant, ProcessFailure::kRestarted},
                                                   {FlightProcess::kControl, ProcessFailure::kHung}});
}

TEST(Processes, WithoutMotionCaptureTheVehicleLands) {
  expect_as_in_the_table(ControlLevel::kTrajectory, {{FlightProcess::kMocap, ProcessFailure::kKilled}});
}

TEST(Processes, WithoutGroundTheVehicleLandsAndWithoutAVehicleNothingIsCommanded) {
  expect_as_in_the_table(ControlLevel::kRates, {{FlightProcess::kGround, ProcessFailure::kKilled},
                                                {FlightProcess::kPlant, ProcessFailure::kKilled}});
}

}  // namespace
}  // namespace swiftlet::soak
