// Which controller is active, for sequences of samples, commands and heartbeats of several controllers and a
// vehicle.
#include "swiftlet/services/control/failover.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/control/takeover.hpp"
#include "tests/unit/services/control/failover_vehicle.hpp"

namespace swiftlet::services::failover_test {

TEST(Failover, SingleControllerBecomesAndStaysActive) {
  Vehicle vehicle;
  const auto& only = vehicle.add(7, 0);
  vehicle.run(200);
  EXPECT_EQ(only.failover.role(), Role::kActive);
  EXPECT_FALSE(only.failover.continues());
  vehicle.run(5000);
  EXPECT_EQ(only.failover.role(), Role::kActive);
  EXPECT_EQ(vehicle.longest_gap_ns(), kPeriodNs);
}

TEST(Failover, LaterControllerIsStandbyAtAnyPriority) {
  Vehicle vehicle;
  vehicle.add(7, 1);
  vehicle.run(300);
  const auto& later = vehicle.add(9, 1000);
  vehicle.run(5000);
  EXPECT_EQ(later.failover.role(), Role::kStandby);
  EXPECT_EQ(vehicle.commander(), 7U);
  EXPECT_EQ(vehicle.changes(), 1);
}

TEST(Failover, StandbyTakesOverWithinItsPatience) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({5});
  controllers[0]->runs = false;
  vehicle.run(100);
  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_TRUE(controllers[1]->failover.continues());
  EXPECT_LE(vehicle.longest_gap_ns(), Failover::kPatienceNs + 2 * kPeriodNs);
  EXPECT_GT(controllers[1]->failover.term(), controllers[0]->failover.term());
}

TEST(Failover, TellsHowItTookOver) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2, 3});
  Failover& standby = controllers[1]->failover;
  Takeover takeover;
  EXPECT_FALSE(controllers[0]->failover.take_takeover(takeover)) << "from no other controller";
  controllers[0]->runs = controllers[2]->runs = false;
  vehicle.run(100);

  ASSERT_TRUE(standby.take_takeover(takeover));
  EXPECT_EQ(takeover.delay_p95_ns, kPeriodNs);
  EXPECT_EQ(takeover.rank, 1);
  EXPECT_EQ(takeover.patience_ns, Failover::kPatienceNs + Failover::kPerRankNs);
  EXPECT_GT(takeover.silence_ns, takeover.patience_ns);
  EXPECT_LE(takeover.silence_ns, takeover.patience_ns + kPeriodNs);
  EXPECT_TRUE(takeover.obeyed);
  EXPECT_EQ(takeover.longest_silence_ns, vehicle.longest_gap_ns());
  EXPECT_EQ(takeover.longest_pause_ns, kPeriodNs);
  EXPECT_TRUE(takeover.continues);
  EXPECT_FALSE(standby.take_takeover(takeover)) << "once";
  EXPECT_EQ(to_string({ms(42), ms(40), ms(2), 1, true, ms(42), ms(3), true}),
            "takes over: 42 ms without a new command, waited for 40 ms (95 % of the commands need up to 2 "
            "ms, 1 standby before "
            "it); the vehicle obeyed after 42 ms; the longest pause between two samples was 3 ms");
}

// The samples of 80 ms come at once, and the vehicle obeys only what answers the last of them.
TEST(Failover, TellsThatSamplesPaused) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2});
  controllers[0]->runs = controllers[1]->runs = false;
  vehicle.run(80);
  controllers[1]->runs = true;
  vehicle.run(20);
  Takeover takeover;
  ASSERT_TRUE(controllers[1]->failover.take_takeover(takeover));
  EXPECT_LE(takeover.silence_ns, takeover.patience_ns + kPeriodNs);
  EXPECT_EQ(takeover.longest_silence_ns, vehicle.longest_gap_ns());
  EXPECT_EQ(takeover.longest_pause_ns, ms(80) + kPeriodNs);
}

TEST(Failover, TellsThatTheVehicleDoesNotObey) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2});
  Failover& standby = controllers[1]->failover;
  controllers[0]->runs = false;
  vehicle.obey(false);
  vehicle.run(100);
  Takeover takeover;
  EXPECT_FALSE(standby.take_takeover(takeover)) << "it still may";
  vehicle.run(500);
  ASSERT_TRUE(standby.take_takeover(takeover));
  EXPECT_FALSE(takeover.obeyed);
  EXPECT_GT(takeover.longest_silence_ns, Failover::kTrialNs);
}

// The commands of the active controller arrive late, those of the standby on the vehicle's host do not.
TEST(Failover, StandbyBesideTheVehicleWaitsForAControllerBehindASlowNetwork) {
  Vehicle vehicle;
  auto& far = vehicle.add(7, 5);
  far.delay_ns = ms(100);
  vehicle.run(2000);
  const auto& near = vehicle.add(8, 5);
  vehicle.run(5000);
  EXPECT_EQ(vehicle.commander(), 7U);
  EXPECT_EQ(near.failover.role(), Role::kStandby);
  far.runs = false;
  far.outbox.clear();
  vehicle.run(1000);
  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_LE(vehicle.longest_gap_ns(), ms(100) + Failover::kPatienceNs + 3 * kPeriodNs);
}

TEST(Failover, StandbyOfHigherPriorityTakesOver) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2, 3});
  controllers[0]->runs = false;
  vehicle.run(1000);
  EXPECT_EQ(vehicle.commander(), 9U);
  EXPECT_EQ(controllers[2]->failover.role(), Role::kActive);
  EXPECT_EQ(controllers[1]->failover.role(), Role::kStandby);
  EXPECT_EQ(vehicle.changes(), 2);
}

TEST(Failover, SecondStandbyTakesOverWhenTheFirstDiesToo) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2, 3});
  controllers[0]->runs = controllers[2]->runs = false;
  vehicle.run(200);
  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_LE(vehicle.longest_gap_ns(), Failover::kPatienceNs + Failover::kPerRankNs + 2 * kPeriodNs);
}

TEST(Failover, ResumedControllerBecomesStandby) {
  Vehicle vehicle;
  auto& first = vehicle.add(7, 1000);
  vehicle.run(300);
  vehicle.add(8, 1);
  vehicle.run(1000);
  first.runs = false;
  vehicle.run(200);
  ASSERT_EQ(vehicle.commander(), 8U);

  first.runs = true;  // with the samples of that time queued
  vehicle.run(1000);

  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_EQ(vehicle.changes(), 2);
  EXPECT_EQ(vehicle.active(), 1);
  EXPECT_EQ(first.failover.role(), Role::kStandby);
}

TEST(Failover, ResumedStandbyDoesNotTakeOver) {
  for (const bool reported : {true, false}) {
    Vehicle vehicle;
    if (!reported) vehicle.stop_reporting();
    vehicle.add(7, 1);
    vehicle.run(1500);
    auto& standby = vehicle.add(8, 9);
    vehicle.run(2000);
    ASSERT_EQ(standby.failover.role(), Role::kStandby);
    standby.runs = false;
    vehicle.run(200);
    standby.runs = true;
    vehicle.run(500);
    EXPECT_EQ(vehicle.changes(), 1) << (reported ? "reported" : "not reported");
    EXPECT_EQ(standby.failover.role(), Role::kStandby);
  }
}

// GIVEN a standby that the vehicle does not hear, because of the network, WHEN the one that flies
// stalls for longer than the standby waits THEN it flies on afterwards, and the standby is ready for the next time.
TEST(Failover, StandbyThatIsNotHeardDoesNotEndTheFlightOfAnother) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2});
  controllers[1]->is_heard = false;
  controllers[0]->runs = false;
  vehicle.run(30);
  ASSERT_EQ(controllers[1]->failover.role(), Role::kActive);
  controllers[0]->runs = true;
  vehicle.run(20);
  EXPECT_EQ(controllers[0]->failover.role(), Role::kActive);
  vehicle.run(80);
  EXPECT_EQ(controllers[1]->failover.role(), Role::kStandby);
  vehicle.run(2000);
  EXPECT_EQ(vehicle.changes(), 1);
  EXPECT_LE(vehicle.longest_gap_ns(), ms(30) + 2 * kPeriodNs);

  controllers[1]->is_heard = true;
  controllers[0]->runs = false;
  vehicle.run(100);
  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_TRUE(controllers[1]->failover.continues());
  EXPECT_LE(vehicle.longest_gap_ns(), ms(30) + 2 * kPeriodNs);
}

// The vehicle begins to hear the standby while both send commands: the higher term flies, and the other one learns it.
TEST(Failover, StandbyThatIsHeardLateEndsTheFlightOfAnother) {
  Vehicle vehicle;
  const auto controllers = vehicle.fly_with_standbys({2});
  controllers[1]->is_heard = false;
  controllers[0]->runs = false;
  vehicle.run(30);
  controllers[0]->runs = true;
  vehicle.run(10);
  controllers[1]->is_heard = true;
  vehicle.run(1000);
  EXPECT_EQ(controllers[0]->failover.role(), Role::kStandby);
  EXPECT_EQ(controllers[1]->failover.role(), Role::kActive);
  EXPECT_EQ(vehicle.changes(), 2);
  EXPECT_LE(vehicle.longest_gap_ns(), ms(30) + 2 * kPeriodNs);
}

TEST(Failover, OneOfSeveralStartedTogetherBecomesActive) {
  for (const int other_priority : {0, 1, 2}) {
    Vehicle vehicle;
    vehicle.add(70, 1);
    vehicle.add(80, other_priority);
    vehicle.add(90, 1);
    vehicle.run(1000);
    EXPECT_EQ(vehicle.active(), 1) << other_priority;
    if (other_priority == 2) {
      EXPECT_EQ(vehicle.commander(), 80U);
    }
  }
}

TEST(Failover, PartitionedControllersAgreeThroughTheVehicle) {
  Vehicle vehicle;
  auto& one = vehicle.add(70, 1);
  auto& two = vehicle.add(80, 1);
  one.receives_heartbeats = two.receives_heartbeats = false;
  vehicle.run(1000);
  EXPECT_EQ(vehicle.active(), 1);
  EXPECT_LE(vehicle.changes(), 2);
  auto& active = one.failover.role() == Role::kActive ? one : two;
  auto& standby = &active == &one ? two : one;
  active.runs = false;
  vehicle.run(300);
  EXPECT_EQ(vehicle.commander(), standby.id);
  EXPECT_FALSE(standby.failover.continues()) << "received no flight state";
}

// Terms contain six bits of the controller's number: 7 and 71 get equal ones.
TEST(Failover, HigherNumberStaysActiveOfTwoWithEqualTerms) {
  Vehicle vehicle;
  auto& low = vehicle.add(7, 1);
  auto& high = vehicle.add(71, 1);
  low.receives_heartbeats = high.receives_heartbeats = false;
  vehicle.run(1000);
  ASSERT_EQ(vehicle.active(), 2);
  ASSERT_EQ(low.failover.term(), high.failover.term());
  low.receives_heartbeats = high.receives_heartbeats = true;
  vehicle.run(20);
  EXPECT_EQ(low.failover.role(), Role::kStandby);
  EXPECT_EQ(high.failover.role(), Role::kActive);
  EXPECT_EQ(vehicle.commander(), 71U);
}

TEST(Failover, StartsActiveWhenNoControllerIsActive) {
  Vehicle vehicle;
  auto& first = vehicle.add(7, 1);
  vehicle.run(1000);
  first.runs = false;
  vehicle.run(300);
  const auto& restarted = vehicle.add(8, 1);
  vehicle.sample();
  EXPECT_EQ(restarted.failover.role(), Role::kActive);
  EXPECT_FALSE(restarted.failover.continues());
  EXPECT_GT(restarted.failover.term(), first.failover.term());
}

TEST(Failover, ControllerWithFlightStateTakesOverFirst) {
  Vehicle vehicle;
  auto& first = vehicle.add(7, 1);
  vehicle.run(300);
  vehicle.add(8, 1);
  vehicle.run(1000);
  first.runs = false;
  auto& stranger = vehicle.add(9, 1000);
  stranger.receives_heartbeats = false;
  vehicle.run(300);
  EXPECT_EQ(vehicle.commander(), 8U);
}

TEST(Failover, RestartedVehicleKeepsItsController) {
  Vehicle vehicle;
  vehicle.add(7, 1);
  vehicle.run(300);
  vehicle.add(8, 1000);
  vehicle.run(1000);
  vehicle.restart();
  vehicle.run(1000);
  EXPECT_EQ(vehicle.commander(), 7U);
  EXPECT_EQ(vehicle.active(), 1);
}

TEST(Failover, HeartbeatsSufficeWithoutReportsOfTheVehicle) {
  Vehicle vehicle;
  vehicle.stop_reporting();
  auto& first = vehicle.add(7, 1);
  vehicle.run(900);
  EXPECT_EQ(vehicle.active(), 0) << "waits for other controllers first";
  vehicle.run(200);
  EXPECT_EQ(vehicle.active(), 1);
  const auto& standby = vehicle.add(8, 1000);
  vehicle.run(3000);
  ASSERT_EQ(standby.failover.role(), Role::kStandby);
  first.runs = false;
  vehicle.run(100);
  EXPECT_EQ(vehicle.commander(), 8U);
  EXPECT_TRUE(standby.failover.continues());
  EXPECT_LE(vehicle.longest_gap_ns(), Failover::kPatienceNs + 2 * kPeriodNs);
  first.runs = true;
  vehicle.run(500);
  EXPECT_EQ(vehicle.active(), 1);
  EXPECT_EQ(vehicle.commander(), 8U);
}

TEST(Failover, TakeoversAreLimitedWhenTheVehicleObeysNobody) {
  Vehicle vehicle;
  auto& one = vehicle.add(7, 1);
  auto& two = vehicle.add(8, 1);
  vehicle.run(1000);
  const std::uint32_t before = std::max(one.failover.term(), two.failover.term());
  vehicle.obey(false);
  vehicle.run(2000);
  const std::uint32_t after = std::max(one.failover.term(), two.failover.term());
  EXPECT_LE((after >> 16) - (before >> 16), 5U) << "takeovers in 2 s";
  vehicle.obey(true);
  vehicle.run(1000);
  EXPECT_EQ(vehicle.active(), 1);
}

TEST(Failover, TermsRiseWithEachTakeover) {
  Vehicle vehicle;
  std::vector<Vehicle::Controller*> controllers;
  for (std::uint64_t id = 1; id <= 3; ++id) controllers.push_back(&vehicle.add(id, static_cast<int>(id)));
  vehicle.run(1000);
  std::uint32_t term = 0;
  for (int kill = 0; kill < 20; ++kill) {
    const auto active = std::find_if(controllers.begin(), controllers.end(), [](const auto* c) {
      return c->failover.role() == Role::kActive && c->runs;
    });
    ASSERT_NE(active, controllers.end());
    EXPECT_GT((*active)->failover.term(), term);
    term = (*active)->failover.term();
    (*active)->runs = false;
    vehicle.run(150);
    ASSERT_EQ(vehicle.active(), 1);
    (*active)->runs = true;
    vehicle.run(150);
    ASSERT_EQ(vehicle.active(), 1);
  }
  EXPECT_LE(vehicle.longest_gap_ns(), Failover::kPatienceNs + 3 * kPeriodNs);
}

// A controller that is started when the one before it has ended, beside a vehicle on the ground.
TEST(Takeover, OfAVehicleThatStandsLongIsCalledNone) {
  Takeover takeover;
  takeover.silence_ns = 7'802'000'000;
  takeover.obeyed = true;
  takeover.longest_silence_ns = 7'802'000'000;
  EXPECT_EQ(to_string(takeover),
            "commands the vehicle, which has had no command for 7.8 s; the vehicle obeyed after 7802 ms");
  takeover.silence_ns = 120'000'000;
  EXPECT_EQ(
      to_string(takeover).find("takes over without the state of the flight: 120 ms without a new command"),
      0U);
}

}  // namespace swiftlet::services::failover_test
