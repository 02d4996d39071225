#include "swiftlet/services/control/vehicle_restarts.hpp"

#include <gtest/gtest.h>

namespace swiftlet::services::vehicle_restarts_test {

// A vehicle in flight, which reports the commands that it obeys, and a number of its start.
class Restarts : public testing::Test {
 protected:
  Restarts() {
    sample_.obeyed = {true, true, 65'536, 1'000, 7};
    for (int i = 0; i < 500; ++i) EXPECT_FALSE(next());
  }
  bool next() {
    imu_.stamp_ns += 2'000'000;
    ++imu_.sequence;
    imu_.stamp_ns += jump_ns_;
    jump_ns_ = 0;
    sample_.motion = imu_;
    return restarts_.sample(sample_);
  }
  // A restart is told once, when it happens.
  void expect_told_once(const char* what) {
    EXPECT_TRUE(next()) << what;
    sample_.of_another_process = false;
    EXPECT_FALSE(next()) << what;
  }

  VehicleRestarts restarts_;
  plant::ImuSample imu_;
  VehicleSample sample_;
  std::int64_t jump_ns_ = 0;
};

TEST_F(Restarts, AreToldByAnotherBoot) {
  sample_.obeyed.boot = 8;
  expect_told_once("in the samples");
}

TEST_F(Restarts, AreToldByAnotherBootInVehicleInfoIfTheSamplesHaveNone) {
  restarts_.note_boot(9);
  EXPECT_FALSE(next()) << "the samples have one";
  sample_.obeyed.boot = 0;
  EXPECT_TRUE(next()) << "9 is not 7";
  restarts_.note_boot(10);
  expect_told_once("in vehicle_info");
}

TEST_F(Restarts, AreToldBySequenceNumbersThatBeginAgain) {
  sample_.obeyed.boot = 0;
  imu_.sequence = 0;
  expect_told_once("while the clock goes on");
}

TEST_F(Restarts, AreNotACounterThatWraps) {
  sample_.obeyed.boot = 0;
  for (const std::uint64_t count : {1ULL << 16U, 1ULL << 32U}) {
    imu_.sequence = count - 4;
    EXPECT_FALSE(next());
    imu_.sequence = 5;  // some were lost
    EXPECT_FALSE(next());
    imu_.sequence = count - 4;
    EXPECT_FALSE(next());
    imu_.sequence = 100;
    EXPECT_TRUE(next()) << "too far on";
    imu_.sequence = count / 2;
    EXPECT_FALSE(next());
    imu_.sequence = 0;
    EXPECT_TRUE(next()) << "too early";
  }
}

TEST_F(Restarts, AreToldByCommandsThatWereForgotten) {
  sample_.obeyed.any = false;
  expect_told_once("none was obeyed since the start");
}

// A relay of a vehicle that states its boot may be another process.
TEST_F(Restarts, AreToldByAnotherProcess) {
  sample_.of_another_process = true;
  EXPECT_FALSE(next());
  sample_.obeyed.boot = 0;
  sample_.of_another_process = true;
  expect_told_once("of the same stamps");
}

// GIVEN what a network and a vehicle that is not restarted do
TEST_F(Restarts, AreNotWhatANetworkDoes) {
  imu_.sequence += 100;
  EXPECT_FALSE(next()) << "lost samples";
  const plant::ImuSample newest = imu_;
  imu_.sequence -= 3;
  imu_.stamp_ns -= 6'000'000;
  EXPECT_FALSE(next()) << "a late sample";
  imu_ = newest;
  EXPECT_FALSE(next());
  sample_.obeyed = {false, false, 0, 0, 0};
  EXPECT_FALSE(next()) << "without a report";
}

TEST_F(Restarts, AreNotTheFirstCommand) {
  sample_.obeyed.any = false;
  EXPECT_TRUE(next());
  sample_.obeyed.any = true;
  EXPECT_FALSE(next());
}

}  // namespace swiftlet::services::vehicle_restarts_test
