// Trajectories under supervision: joined from hold and from another trajectory, and flown as a mission item.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/spline.hpp"
#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::trajectory_flight_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

Trajectory through(std::uint64_t id, const std::vector<Vector3d>& points, double leg_s, double yaw = 0.0) {
  std::vector<PositionYaw> places;
  places.reserve(points.size());
  for (const Vector3d& p : points) places.emplace_back(p.x(), p.y(), p.z(), yaw);
  return {id, spline(Smoothness::kMinimumSnap, places, std::vector<double>(points.size() - 1, leg_s))};
}

double duration_s(const Trajectory& trajectory) {
  double sum = 0.0;
  for (const PolynomialSegment& segment : trajectory.segments) sum += segment.duration_s;
  return sum;
}

class TrajectoryFlight : public testing::Test, protected SupervisedFlight {
 protected:
  static constexpr double kStep_s = 1e-9 * static_cast<double>(kStep_ns);

  void SetUp() override { ASSERT_TRUE(take_off()); }

  // Steps and checks that the reference is continuous: each derivative up to the jerk changes by no more than
  // the next one allows.
  void step_smoothly() {
    const Reference before = control_setpoint_.reference;
    step();
    const Reference& after = control_setpoint_.reference;
    const double highest_jerk = 60.0;
    const double highest_snap = 600.0;
    ASSERT_LE((after.position_ned - before.position_ned).norm(), (kFastest + 0.1) * kStep_s);
    ASSERT_LE((after.velocity_ned - before.velocity_ned).norm(), 10.0 * kStep_s);
    ASSERT_LE((after.acceleration_ned - before.acceleration_ned).norm(), highest_jerk * kStep_s);
    ASSERT_LE((after.jerk_ned - before.jerk_ned).norm(), highest_snap * kStep_s);
    ASSERT_LE(std::abs(after.yaw_rate - before.yaw_rate), 20.0 * kStep_s);
    EXPECT_LE(after.velocity_ned.norm(), Limits().max_speed + 1e-9);
    EXPECT_LE(after.acceleration_ned.norm(), Limits().max_acceleration + 1e-9);
  }
  void fly_smoothly(double seconds) {
    const std::int64_t end_ns = inputs_.stamp_ns + std::llround(seconds * 1e9);
    while (inputs_.stamp_ns < end_ns && !HasFatalFailure()) step_smoothly();
  }
  void fly_smoothly_until(Mode mode, double limit_s) {
    const std::int64_t end_ns = inputs_.stamp_ns + std::llround(limit_s * 1e9);
    while (supervisor_.mode() != mode && inputs_.stamp_ns < end_ns && !HasFatalFailure()) step_smoothly();
    ASSERT_EQ(supervisor_.mode(), mode);
  }

  const double kFastest = Limits().max_speed;
  const Trajectory tour_ = through(1, {{0, 0, -1}, {1.2, 0.4, -1.4}, {1.5, -0.8, -1.1}, {0, -0.5, -1}}, 1.6);
  const Trajectory other_ = through(2, {{-0.5, 1.0, -1.5}, {0.5, 1.5, -1.2}, {1.0, 0.5, -1.5}}, 1.5, 1.0);
};

TEST_F(TrajectoryFlight, ReferenceIsExactlyThePolynomial) {
  ASSERT_TRUE(check(tour_, Limits()).accepted);
  ASSERT_TRUE(fly(tour_).accepted);
  const std::int64_t requested_ns = inputs_.stamp_ns;
  fly_smoothly(0.5);  // the minimum duration of a join
  const std::int64_t start_ns = requested_ns + 500'000'000;
  std::int64_t segment_start_ns = start_ns;
  for (const PolynomialSegment& segment : tour_.segments) {
    const std::int64_t end_ns = segment_start_ns + std::llround(segment.duration_s * 1e9);
    while (inputs_.stamp_ns + kStep_ns < end_ns) {
      step_smoothly();
      const Reference wanted =
          evaluate(segment, static_cast<double>(inputs_.stamp_ns - segment_start_ns) * 1e-9);
      ASSERT_LT((control_setpoint_.reference.position_ned - wanted.position_ned).norm(), 1e-15);
      ASSERT_LT((control_setpoint_.reference.velocity_ned - wanted.velocity_ned).norm(), 1e-14);
    }
    segment_start_ns = end_ns;
  }
  fly_smoothly_until(Mode::kHolding, 0.1);
  EXPECT_EQ(supervisor_.reason(), Reason::kTrajectoryCompleted);
}

// At any time in the first trajectory the second is joined without a step and flown to its end.
TEST_F(TrajectoryFlight, NewTrajectoryJoinsThePresentMotion) {
  for (const double at_s : {0.2, 0.9, 2.0, 2.9, 4.1}) {
    SCOPED_TRACE(at_s);
    ASSERT_TRUE(fly(tour_).accepted);
    while (supervisor_.state().guidance.next_segment == 0 && !HasFatalFailure())
      step_smoothly();  // the join to its start
    fly_smoothly(at_s);
    EXPECT_GT(control_setpoint_.reference.velocity_ned.norm(), 0.01);
    ASSERT_TRUE(fly(other_).accepted);
    EXPECT_EQ(supervisor_.mode(), Mode::kTrajectory);
    EXPECT_EQ(supervisor_.state().guidance.trajectory_id, 2U);
    fly_smoothly_until(Mode::kHolding, 60.0);
    EXPECT_EQ(supervisor_.reason(), Reason::kTrajectoryCompleted);
    EXPECT_LT((control_setpoint_.reference.position_ned - Vector3d(1.0, 0.5, -1.5)).norm(), 1e-9);
    ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}, 1.0).accepted);
    ASSERT_TRUE(
        step_until([&] { return supervisor_.state().guidance.path.finished(inputs_.stamp_ns); }, 20.0));
  }
}

TEST_F(TrajectoryFlight, JoinsFromASetpointStream) {
  Setpoint setpoint;
  for (int i = 0; i < 200; ++i) {
    setpoint.position_ned = {0.5 * kStep_s * i, 0, -1};
    setpoint.velocity_ned = {0.5, 0, 0};
    ASSERT_TRUE(supervisor_.setpoint(setpoint, inputs_).accepted);
    step();
  }
  ASSERT_TRUE(fly(other_).accepted);
  fly_smoothly_until(Mode::kHolding, 60.0);
  EXPECT_EQ(supervisor_.reason(), Reason::kTrajectoryCompleted);
}

// Straight at the fence and back: the join to the second stays inside with little room.
TEST_F(TrajectoryFlight, JoinStaysInsideTheFence) {
  const Trajectory to_the_fence = through(3, {{0, 0, -1}, {1.5, 0, -1}, {2.95, 0, -1}}, 1.9);
  ASSERT_TRUE(check(to_the_fence, Limits()).accepted) << check(to_the_fence, Limits()).reason;
  for (const double at_s : {2.0, 2.4, 2.8, 3.2}) {
    SCOPED_TRACE(at_s);
    ASSERT_TRUE(fly(to_the_fence).accepted);
    fly_smoothly(0.5 + at_s);
    ASSERT_TRUE(fly(other_).accepted);
    while (supervisor_.mode() == Mode::kTrajectory) {
      step();
      ASSERT_LE(control_setpoint_.reference.position_ned.x(), Limits().fence_max_ned.x());
      ASSERT_LE(control_setpoint_.reference.velocity_ned.norm(), Limits().max_speed + 0.1);
    }
    ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}, 1.0).accepted);
    ASSERT_TRUE(
        step_until([&] { return supervisor_.state().guidance.path.finished(inputs_.stamp_ns); }, 20.0));
  }
}

TEST_F(TrajectoryFlight, RefusedTrajectoryDoesNotChangeThePresentOne) {
  ASSERT_TRUE(fly(tour_).accepted);
  fly_smoothly(1.5);
  Trajectory outside = other_;
  outside.segments.front().x[0] = 9.0;
  EXPECT_FALSE(fly(outside).accepted);
  EXPECT_EQ(supervisor_.state().guidance.trajectory_id, 1U);
  fly_smoothly_until(Mode::kHolding, 20.0);
  EXPECT_LT((control_setpoint_.reference.position_ned - Vector3d(0, -0.5, -1)).norm(), 1e-9);
}

TEST_F(TrajectoryFlight, KeepsUpWithSegmentsShorterThanAStep) {
  Trajectory chopped{9, {}};
  const PolynomialSegment whole = minimum_jerk({0, 0, -1}, 0.0, {0.4, 0, -1}, 0.0, 1.5);
  constexpr int kPieces = 1024;  // of 1.5 ms; a step is 2 ms
  const double piece_s = whole.duration_s / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    chopped.segments.push_back(
        join(evaluate(whole, piece_s * i), evaluate(whole, piece_s * (i + 1)), piece_s));
  }
  ASSERT_TRUE(check(chopped, Limits()).accepted) << check(chopped, Limits()).reason;
  ASSERT_TRUE(fly(chopped).accepted);
  const std::int64_t start_ns = inputs_.stamp_ns;
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_NEAR(static_cast<double>(inputs_.stamp_ns - start_ns) * 1e-9, 2.0, 0.01);
}

Mission with_trajectory(const Trajectory& first, const Trajectory& second) {
  Mission mission;
  mission.id = 11;
  mission.segments = first.segments;
  mission.segments.insert(mission.segments.end(), second.segments.begin(), second.segments.end());
  const auto trajectory = [](std::size_t from, std::size_t count, double hold_s) {
    return MissionItem{MissionItemKind::kTrajectory,
                       Vector3d::Zero(),
                       0,
                       true,
                       0.5,
                       hold_s,
                       static_cast<std::uint32_t>(from),
                       static_cast<std::uint32_t>(count)};
  };
  mission.items = {{MissionItemKind::kWaypoint, {0.5, 0, -1}, 0, true, 0.5, 0.0},
                   trajectory(0, first.segments.size(), 0.4),
                   trajectory(first.segments.size(), second.segments.size(), 0.0),
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}};
  return mission;
}

TEST_F(TrajectoryFlight, MissionFliesItsTrajectoriesInOrder) {
  const Mission mission = with_trajectory(tour_, other_);
  ASSERT_TRUE(check(mission, Limits()).accepted) << check(mission, Limits()).reason;
  ASSERT_TRUE(fly(mission).accepted);
  const auto at_item = [&](int item) {
    return step_until([&] { return supervisor_.mission().item_index == item; }, 30.0);
  };
  ASSERT_TRUE(at_item(1));
  const std::int64_t begun_ns = inputs_.stamp_ns;
  ASSERT_TRUE(at_item(2));
  EXPECT_LT((estimate_.position_ned - Vector3d(0, -0.5, -1)).norm(), 1e-4);
  const double join_s =
      septic_duration(0.5, 0.5, Limits().max_reference_acceleration, Limits().max_reference_jerk);
  EXPECT_NEAR(static_cast<double>(inputs_.stamp_ns - begun_ns) * 1e-9, join_s + duration_s(tour_) + 0.4,
              0.01);
  ASSERT_TRUE(at_item(3));
  EXPECT_LT((estimate_.position_ned - Vector3d(1.0, 0.5, -1.5)).norm(), 1e-4);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 20.0));
  EXPECT_EQ(supervisor_.mission().state, MissionState::kCompleted);
}

TEST_F(TrajectoryFlight, MissionEndingWithATrajectoryHoldsThere) {
  Mission mission = with_trajectory(tour_, other_);
  mission.items.pop_back();
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until(Mode::kHolding, 60.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kMissionCompleted);
  EXPECT_LT((estimate_.position_ned - Vector3d(1.0, 0.5, -1.5)).norm(), 1e-4);
}

// In the middle of a mission's trajectory another supervisor continues with the same reference.
TEST_F(TrajectoryFlight, FollowerContinuesAMissionTrajectory) {
  const Mission mission = with_trajectory(tour_, other_);
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().guidance.next_segment == 2; }, 30.0));
  Supervisor another{SupervisionSettings()};
  another.adopt(supervisor_.state(), &mission, nullptr);
  for (int i = 0; i < 5000; ++i) {
    SupervisorInputs same = inputs_;
    same.stamp_ns += kStep_ns;
    const ControlSetpoint theirs = another.step(same);
    step();
    ASSERT_EQ(theirs.reference.position_ned, control_setpoint_.reference.position_ned) << "step " << i;
    ASSERT_EQ(another.mode(), supervisor_.mode());
  }
}

TEST(TrajectoryChecks, FindViolationsBetweenSamples) {
  // Beyond the fence by 0.01 mm at the turning point only.
  Trajectory trajectory = through(1, {{0, 0, -1}, {2.0, 0, -1}, {0, 0, -1}}, 2.0);
  Limits limits;
  limits.fence_max_ned.x() = 2.0 - 1e-5;
  EXPECT_FALSE(check(trajectory, limits).accepted);
  limits.fence_max_ned.x() = 2.0 + 1e-5;
  EXPECT_TRUE(check(trajectory, limits).accepted) << check(trajectory, limits).reason;
}

TEST(TrajectoryChecks, RefuseMissionTrajectoriesBeyondTheSegments) {
  const Limits limits;
  const Trajectory one = through(1, {{0, 0, -1}, {1, 0, -1}}, 3.0);
  const auto reason = [&](std::uint32_t first, std::uint32_t count) {
    Mission mission;
    mission.segments = one.segments;
    mission.items = {{MissionItemKind::kTrajectory, Vector3d::Zero(), 0, true, 0.5, 0.0, first, count}};
    return std::string(check(mission, limits).reason);
  };
  EXPECT_EQ(reason(0, 1), "");
  EXPECT_EQ(reason(0, 0), "item 1: the trajectory has no segments");
  EXPECT_EQ(reason(0, 2), "item 1: the trajectory ends at segment 2, the mission has 1");
  EXPECT_EQ(reason(std::numeric_limits<std::uint32_t>::max(), 2),
            "item 1: the trajectory ends at segment 4294967297, the mission has 1");
  Mission fast;
  fast.segments = through(1, {{0, 0, -1}, {2, 0, -1}}, 1.5).segments;
  fast.items = {{MissionItemKind::kTrajectory, Vector3d::Zero(), 0, true, 0.5, 0.0, 0, 1}};
  EXPECT_EQ(std::string(check(fast, limits).reason),
            "item 1: segment 1 reaches 2.92 m/s, the limit is 2.00 m/s");
  fast.segments.resize(kMaxTrajectorySegments + 1);
  EXPECT_NE(std::string(check(fast, limits).reason).find("1025 segments, the limit is 1024"),
            std::string::npos);
}

}  // namespace swiftlet::control::trajectory_flight_test
