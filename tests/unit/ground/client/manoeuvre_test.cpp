// Which telemetry ends a manoeuvre, and how.
#include <gtest/gtest.h>

#include "swiftlet/ground/client/manoeuvre_course.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using control::Reason;
using Eigen::Vector3d;

// What is told of a flight, one status or 100 references after another.
class Told {
 public:
  explicit Told(Mode before) { mode(before, Reason::kRequested); }

  Outset outset() const {
    return {static_cast<Mode>(view.control.message.mode()), view.control.count, view.reference.count,
            view.mission.count};
  }
  Told& mode(Mode now, Reason reason) {
    view.control.message.mode(static_cast<std::uint8_t>(now));
    view.control.message.reason() = control::to_string(reason);
    ++view.control.count;
    return *this;
  }
  Told& at(const Vector3d& place, double reference_speed = 0.0) {
    view.reference.message.position_ned({place.x(), place.y(), place.z()});
    view.reference.message.velocity_ned({reference_speed, 0.0, 0.0});
    view.reference.count += 100;
    view.estimate.message.position_ned({place.x() + 0.01, place.y(), place.z()});
    return *this;
  }
  Told& mission(std::uint64_t id, std::uint8_t state) {
    ++view.mission.count;
    view.mission.message.mission_id(id);
    view.mission.message.state(state);
    view.mission.message.reason() = "battery is low";
    return *this;
  }

  View view;
};

std::string end_of(const std::optional<Ending>& ending) {
  if (!ending) return "under way";
  return ending->done() ? "done" : ending->reason;
}

TEST(Manoeuvres, AModeIsReachedByItsWayAndNoOther) {
  const Judge judge = until_mode(Mode::kHolding, Mode::kTakingOff);
  Told told(Mode::kArmed);
  const Outset outset = told.outset();
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way");
  told.mode(Mode::kArmed, Reason::kRequested);
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way") << "told before the answer, and late";
  told.mode(Mode::kTakingOff, Reason::kRequested).mode(Mode::kTakingOff, Reason::kRequested);
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way");
  Told landed = told;
  EXPECT_EQ(end_of(judge(landed.mode(Mode::kLanding, Reason::kBatteryLow).view, outset)),
            "it is landing: battery is low");
  EXPECT_EQ(end_of(judge(told.mode(Mode::kHolding, Reason::kTakeOffCompleted).view, outset)), "done");
  Told still(Mode::kArmed);
  for (int i = 0; i < 5; ++i) still.mode(Mode::kArmed, Reason::kRequested);
  EXPECT_EQ(end_of(judge(still.view, outset)), "it is armed: requested") << "that is no longer late";
}

TEST(Manoeuvres, APlaceIsReachedWhenTheReferenceRestsThereAndTheVehicleIsWithIt) {
  const Judge judge = until_at_rest(Vector3d(1, 0, -1));
  Told told(Mode::kHolding);
  const Outset outset = told.outset();
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way");
  EXPECT_EQ(end_of(judge(told.at({0.5, 0, -1}, 0.3).view, outset)), "under way");
  Told elsewhere = told;
  EXPECT_EQ(end_of(judge(elsewhere.at({0.6, 0, -1}).view, outset)),
            "it came to rest at (0.600, 0.000, -1.000) m: something else was asked of it");
  told.at({1, 0, -1});
  Told behind = told;
  behind.view.estimate.message.position_ned({0.8, 0, -1});
  EXPECT_EQ(end_of(judge(behind.view, outset)), "under way");
  EXPECT_EQ(end_of(judge(told.view, outset)), "done");
  EXPECT_EQ(end_of(until_at_rest(std::nullopt)(elsewhere.view, outset)), "done");
}

TEST(Manoeuvres, ALandingIsDoneOnTheGround) {
  const Judge judge = until_landed();
  Told told(Mode::kHolding);
  const Outset outset = told.outset();
  EXPECT_EQ(end_of(judge(told.mode(Mode::kLanding, Reason::kRequested).view, outset)), "under way");
  EXPECT_EQ(end_of(judge(told.mode(Mode::kDescent, Reason::kNoPose).view, outset)), "under way");
  Told stopped = told;
  EXPECT_EQ(end_of(judge(stopped.mode(Mode::kStopped, Reason::kTippedOver).view, outset)),
            "it is stopped: tipped over");
  EXPECT_EQ(end_of(judge(told.mode(Mode::kDisarmed, Reason::kLanded).view, outset)), "done");
}

TEST(Manoeuvres, ATrajectoryIsDoneWhenItSaysSo) {
  const Judge judge = until_trajectory_flown();
  Told told(Mode::kHolding);
  told.mode(Mode::kHolding, Reason::kTrajectoryCompleted);  // the one before
  const Outset outset = told.outset();
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way");
  told.mode(Mode::kTrajectory, Reason::kRequested);
  EXPECT_EQ(end_of(judge(told.view, outset)), "under way");
  for (int i = 0; i < 3; ++i) told.mode(Mode::kHolding, Reason::kRequested);
  EXPECT_EQ(end_of(judge(told.view, outset)), "it is holding: requested");
  EXPECT_EQ(end_of(judge(told.mode(Mode::kHolding, Reason::kTrajectoryCompleted).view, outset)), "done");
}

TEST(Manoeuvres, AMissionIsDoneByItsOwnNumber) {
  const Judge judge = until_mission_flown(7);
  Told told(Mode::kMission);
  const Outset outset = told.outset();
  EXPECT_EQ(end_of(judge(told.mission(6, msg::MissionStatus_Constants::COMPLETED).view, outset)),
            "under way");
  EXPECT_EQ(end_of(judge(told.mission(7, msg::MissionStatus_Constants::RUNNING).view, outset)), "under way");
  EXPECT_EQ(end_of(judge(told.mission(7, msg::MissionStatus_Constants::ABORTED).view, outset)),
            "aborted: battery is low");
  EXPECT_EQ(end_of(judge(told.mission(7, msg::MissionStatus_Constants::COMPLETED).view, outset)), "done");
}

}  // namespace
}  // namespace swiftlet::ground
