// What a controller reports of itself: whether it can take over.
#include "swiftlet/services/control/inner_loop.hpp"

#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::services::inner_loop_test {

constexpr std::int64_t kPeriod = 2'000'000;  // ns
constexpr std::uint64_t kSamplesPerPose = 5;
constexpr std::uint32_t kTerm = 65'536;

// A standby of a vehicle that stands, and follows an active controller.
class StandbyLoop : public testing::Test {
 protected:
  StandbyLoop() {
    imu_.specific_force_frd = {0.0, 0.0, -plant::kGravity};
    pose_.tracked = true;
  }
  void follow() {
    FailoverState state;
    state.number = 1;
    state.term = kTerm;
    loop_.failover_state.put(state);
  }
  void put_pose() {
    pose_.stamp_ns = imu_.stamp_ns;
    ++pose_.sequence;
    pose_.position_ned.x() = pose_.sequence % 2 == 0 ? 1e-5 : -1e-5;  // noise: equal poses count as stuck
    loop_.pose.put(pose_);
  }
  // Returns whether it is ready afterwards.
  bool run(std::int64_t duration_ns, bool with_poses) {
    for (const std::int64_t end_ns = imu_.stamp_ns + duration_ns; imu_.stamp_ns < end_ns;) {
      imu_.stamp_ns += kPeriod;
      ++imu_.sequence;
      if (with_poses && imu_.sequence % kSamplesPerPose == 0) put_pose();
      loop_.step(imu_, imu_.stamp_ns, Role::kStandby, kTerm);
      loop_.finish(imu_.stamp_ns);
    }
    messages::ControllerReport report;
    loop_.report(report);
    return report.ready;
  }

  plant::ImuSample imu_;
  plant::PoseSample pose_;
  InnerLoop loop_{io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
                  io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"))};
};

TEST_F(StandbyLoop, IsReadyWhenItsEstimateHasSettled) {
  follow();
  EXPECT_FALSE(run(1'000'000'000, false));
  EXPECT_FALSE(run(InnerLoop::kReadyAfterNs - 20 * kPeriod, true));
  EXPECT_TRUE(run(100 * kPeriod, true));
  EXPECT_FALSE(run(1'000'000'000, false)) << "the poses ceased";
  EXPECT_FALSE(run(InnerLoop::kReadyAfterNs / 2, true)) << "they came again";
  EXPECT_TRUE(run(InnerLoop::kReadyAfterNs, true));
}

TEST_F(StandbyLoop, IsNotReadyAsLongAsItFollowsNobody) {
  EXPECT_FALSE(run(2'000'000'000, true));
  follow();
  EXPECT_TRUE(run(kPeriod, true));
}

// GIVEN a vehicle that obeys another controller, and is armed, WHEN this one takes over and is obeyed within 1 s THEN it stays armed; one
// that is not obeyed disarms.
TEST_F(StandbyLoop, TakesOverAnArmedVehicleThatObeysItSoon) {
  for (const bool obeys : {true, false}) {
    run(2'000'000'000, true);
    FailoverState armed;
    armed.number = 3;
    armed.term = kTerm;
    armed.flight.supervisor.mode = control::Mode::kArmed;
    armed.flight.supervisor.mode_since_ns = 1;
    loop_.failover_state.put(armed);
    run(kPeriod, true);
    constexpr std::uint32_t kOwnTerm = 2 * kTerm;
    bool runs = true;
    for (int i = 0; i < 1000; ++i) {
      imu_.stamp_ns += kPeriod;
      ++imu_.sequence;
      loop_.set_obeyed({true, true, obeys && i > 400 ? kOwnTerm : kTerm, imu_.stamp_ns}, Role::kActive,
                       kOwnTerm);
      if (imu_.sequence % kSamplesPerPose == 0) put_pose();
      runs = plant::header_of(loop_.step(imu_, imu_.stamp_ns)).rotor_state == plant::RotorState::kRunning;
      if (i < 400) {
        ASSERT_TRUE(runs) << i;
      }
    }
    EXPECT_EQ(runs, obeys);
  }
}

// GIVEN a standby of a flight WHEN the vehicle is restarted THEN a report of the flight that was still on its way is not adopted,
// and one from after the vehicle has obeyed again is.
TEST_F(StandbyLoop, AdoptsNoFlightFromBeforeTheVehicleWasRestarted) {
  const auto rotors_run_after_a_report = [this] {
    FailoverState flying;
    flying.number = 2;
    flying.term = kTerm;
    flying.flight.supervisor.mode = control::Mode::kHolding;
    loop_.failover_state.put(flying);
    run(kPeriod, true);
    messages::ControllerReport report;
    ++imu_.sequence;
    imu_.stamp_ns += kPeriod;
    const plant::VehicleCommand command = loop_.step(imu_, imu_.stamp_ns);
    return plant::header_of(command).rotor_state == plant::RotorState::kRunning;
  };
  run(1'000'000'000, true);
  ASSERT_TRUE(rotors_run_after_a_report());
  loop_.restart_vehicle(imu_.stamp_ns);
  EXPECT_FALSE(rotors_run_after_a_report());
  loop_.set_obeyed({true, true, kTerm, imu_.stamp_ns}, Role::kActive, kTerm);
  EXPECT_TRUE(rotors_run_after_a_report());
}

}  // namespace swiftlet::services::inner_loop_test
