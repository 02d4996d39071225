// The history alone: states of a body in free fall at 2 ms, whose path is known in closed form.
#include "swiftlet/control/estimation/state_history.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::state_history_test {

using Eigen::Vector3d;

constexpr std::int64_t kStep_ns = 2'000'000;

NominalState fall(std::int64_t stamp_ns, const Vector3d& position = Vector3d::Zero(),
                  const Vector3d& velocity = Vector3d::Zero()) {
  const double t = 1e-9 * static_cast<double>(stamp_ns);
  NominalState state;
  state.stamp_ns = stamp_ns;
  state.position_ned = position + t * velocity + Vector3d(0.0, 0.0, 0.5 * plant::kGravity * t * t);
  state.velocity_ned = velocity + Vector3d(0.0, 0.0, plant::kGravity * t);
  return state;
}

const auto ignore = [](const ErrorInterval&) {};

// A path with an anchor at 0 and samples until then.
StateHistory falling(int samples) {
  StateHistory history;
  history.append(fall(0));
  history.begin_at(fall(0));
  for (int i = 1; i <= samples; ++i) history.append(fall(i * kStep_ns));
  return history;
}

void expect_equal(const NominalState& state, const NominalState& expected) {
  EXPECT_EQ(state.stamp_ns, expected.stamp_ns);
  EXPECT_LT((state.position_ned - expected.position_ned).norm(), 1e-12);
  EXPECT_LT((state.velocity_ned - expected.velocity_ned).norm(), 1e-12);
  EXPECT_LT(state.q_ned_from_frd.angularDistance(expected.q_ned_from_frd), 1e-12);
}

TEST(StateHistory, CarriesACorrectionInThePastToThePresentAndToAllStatesBetween) {
  StateHistory history = falling(100);
  ErrorState step = ErrorState::Zero();
  step.head<6>() << 0.1, 0.2, 0.3, 0.01, 0.02, 0.03;
  history.apply(step);
  const Vector3d position(0.1, 0.2, 0.3);
  const Vector3d velocity(0.01, 0.02, 0.03);
  expect_equal(history.newest(), fall(100 * kStep_ns, position, velocity));
  history.move_anchor(50 * kStep_ns, ignore);
  expect_equal(history.anchor(), fall(50 * kStep_ns, position, velocity));
}

// GIVEN more corrections than are kept WHEN a state of before all of them is read THEN it has each of them once.
TEST(StateHistory, LosesNoCorrectionOfMany) {
  StateHistory history = falling(100);
  ErrorState step = ErrorState::Zero();
  step[3] = 0.001;
  for (int i = 0; i < 100; ++i) history.apply(step);
  const Vector3d velocity(0.1, 0.0, 0.0);
  history.move_anchor(30 * kStep_ns, ignore);
  expect_equal(history.anchor(), fall(30 * kStep_ns, Vector3d::Zero(), velocity));
  expect_equal(history.newest(), fall(100 * kStep_ns, Vector3d::Zero(), velocity));
}

TEST(StateHistory, InterpolatesBetweenSamplesAndEndsAtTheNewest) {
  StateHistory history = falling(10);
  history.move_anchor(5 * kStep_ns / 2, ignore);
  EXPECT_EQ(history.anchor().stamp_ns, 5 * kStep_ns / 2);
  EXPECT_NEAR(history.anchor().velocity_ned.z(), plant::kGravity * 0.005, 1e-12);
  history.move_anchor(1000 * kStep_ns, ignore);
  expect_equal(history.anchor(), fall(10 * kStep_ns));
}

TEST(StateHistory, CutsTheWayOfTheAnchorIntoShortIntervalsWithoutGaps) {
  StateHistory history = falling(101);
  double ahead_s = 0.0;
  history.for_each_interval([&](const ErrorInterval& interval) { ahead_s += interval.duration_s; });
  EXPECT_NEAR(ahead_s, 0.202, 1e-12);
  double moved_s = 0.0;
  const auto visit = [&](const ErrorInterval& interval) {
    EXPECT_LE(interval.duration_s, 0.020 + 1e-12);
    EXPECT_LT(interval.velocity_change.norm(), 1e-12) << "free fall: no specific force";
    moved_s += interval.duration_s;
  };
  history.move_anchor(33 * kStep_ns + 1, visit);
  history.move_anchor(101 * kStep_ns, visit);
  EXPECT_NEAR(moved_s, 0.202, 1e-12);
}

TEST(StateHistory, MakesRoomBeforeItOverwritesStatesAfterTheAnchor) {
  StateHistory history = falling(0);
  double moved_s = 0.0;
  for (int i = 1; i <= 3 * StateHistory::kCapacity; ++i) {
    history.make_room([&](const ErrorInterval& interval) { moved_s += interval.duration_s; });
    history.append(fall(i * kStep_ns));
    ASSERT_LT(history.newest().stamp_ns - history.anchor().stamp_ns, StateHistory::kCapacity * kStep_ns);
  }
  EXPECT_NEAR(moved_s, 1e-9 * static_cast<double>(history.anchor().stamp_ns), 1e-9);
  expect_equal(history.anchor(), fall(history.anchor().stamp_ns));
}

TEST(StateHistory, TurnsAndMovesThePathToWhereItBegins) {
  StateHistory history;
  for (int i = 0; i <= 20; ++i) history.append(fall(i * kStep_ns));
  NominalState start;
  start.stamp_ns = 10 * kStep_ns;
  start.position_ned = {1.0, 2.0, -3.0};
  start.q_ned_from_frd = Eigen::AngleAxisd(0.5, Vector3d::UnitZ());
  history.begin_at(start);
  expect_equal(history.anchor(), start);
  NominalState expected = fall(10 * kStep_ns, start.position_ned);
  expected.stamp_ns = 20 * kStep_ns;
  expected.q_ned_from_frd = start.q_ned_from_frd;
  expect_equal(history.newest(), expected);
}

}  // namespace swiftlet::control::state_history_test
