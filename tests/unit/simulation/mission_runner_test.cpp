#include "swiftlet/simulation/mission_runner.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::simulation::mission_runner_test {

using control::MissionState;

// A vehicle that answers as the test says, and advances by a second at a time.
class ScriptedVehicle final : public MissionTransport {
 public:
  void wait_until_ready() override { calls_.emplace_back("ready"); }
  Reply arm() override {
    calls_.emplace_back("arm");
    if (refusals_ == 0) return {true, false, ""};
    --refusals_;
    return {false, retry_, "the vehicle is not level"};
  }
  Reply start_mission() override {
    calls_.emplace_back("start");
    return start_;
  }
  void wait(std::int64_t duration_ns, const std::string&) override { status_.stamp_ns += duration_ns; }
  void wait_for_other_vehicles() override { calls_.emplace_back("others"); }
  void advance() override {
    ++steps_;
    status_.stamp_ns += 1'000'000'000;
    status_.mission = steps_ < completed_at_ ? MissionState::kRunning : end_;
    status_.rotors_off = steps_ >= rotors_off_at_;
  }
  Status status() const override { return status_; }
  std::string abort_reason() const override { return "mocap lost"; }
  [[noreturn]] void abandon(const std::string& reason) override {
    calls_.emplace_back("abandon");
    throw FlightFailure(reason);
  }

  int refusals_ = 0;
  bool retry_ = true;
  Reply start_{true, false, ""};
  int completed_at_ = 10;
  int rotors_off_at_ = 10;
  MissionState end_ = MissionState::kCompleted;

  std::vector<std::string> calls_;
  int steps_ = 0;
  Status status_;
};

std::string failure_of(ScriptedVehicle& vehicle) {
  try {
    fly_mission(vehicle, 10.0);
  } catch (const FlightFailure& failure) {
    return failure.what();
  }
  return "completed";
}

TEST(MissionRunner, ArmsWaitsForTheOthersAndStarts) {
  ScriptedVehicle vehicle;
  EXPECT_EQ(failure_of(vehicle), "completed");
  EXPECT_EQ(vehicle.calls_, (std::vector<std::string>{"ready", "arm", "others", "start"}));
}

TEST(MissionRunner, FollowsUntilTheRotorsAreOff) {
  ScriptedVehicle vehicle;
  vehicle.rotors_off_at_ = 13;
  EXPECT_EQ(failure_of(vehicle), "completed");
  EXPECT_EQ(vehicle.steps_, 13);
}

TEST(MissionRunner, FollowsUntilTheMissionIsCompleted) {
  ScriptedVehicle vehicle;
  vehicle.rotors_off_at_ = 1;
  EXPECT_EQ(failure_of(vehicle), "completed");
  EXPECT_EQ(vehicle.steps_, 10);
}

TEST(MissionRunner, RetriesToArmForFiveSeconds) {
  ScriptedVehicle vehicle;
  vehicle.refusals_ = 25;
  EXPECT_EQ(failure_of(vehicle), "completed");
  EXPECT_EQ(vehicle.status_.stamp_ns, 5'000'000'000 + 10'000'000'000);

  ScriptedVehicle never;
  never.refusals_ = 26;
  EXPECT_EQ(failure_of(never), "arming failed: the vehicle is not level");
}

TEST(MissionRunner, DoesNotRetryAnArmingThatCannotSucceed) {
  ScriptedVehicle vehicle;
  vehicle.refusals_ = 1;
  vehicle.retry_ = false;
  EXPECT_EQ(failure_of(vehicle), "arming failed: the vehicle is not level");
  EXPECT_EQ(vehicle.status_.stamp_ns, 0);
}

TEST(MissionRunner, TellsWhyTheMissionWasRefusedAndLeavesNoVehicleArmed) {
  ScriptedVehicle vehicle;
  vehicle.start_ = {false, false, "item 2 is outside the fence"};
  EXPECT_EQ(failure_of(vehicle), "mission refused: item 2 is outside the fence");
  EXPECT_EQ(vehicle.calls_, (std::vector<std::string>{"ready", "arm", "others", "start", "abandon"}));
  EXPECT_EQ(vehicle.steps_, 0);
}

TEST(MissionRunner, TellsWhyTheMissionWasAborted) {
  ScriptedVehicle vehicle;
  vehicle.end_ = MissionState::kAborted;
  EXPECT_EQ(failure_of(vehicle), "the mission was aborted: mocap lost");
  EXPECT_EQ(vehicle.steps_, 10);
}

// Half as long again as planned, and 30 s.
TEST(MissionRunner, EndsAFlightThatTakesTooLong) {
  ScriptedVehicle vehicle;
  vehicle.completed_at_ = 1000;
  EXPECT_EQ(failure_of(vehicle), "the mission exceeds its time limit of 45 s (planned: 10 s)");
  EXPECT_EQ(vehicle.steps_, 46);
}

}  // namespace swiftlet::simulation::mission_runner_test
