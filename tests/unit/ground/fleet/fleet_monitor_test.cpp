// The orders of the monitor in single situations; swarm_property_test.cpp has random flights.
#include "swiftlet/ground/fleet/fleet_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::fleet_monitor_test {

using Eigen::Vector3d;
using Kind = Order::Kind;

constexpr double kStep_s = 0.04;
const Ellipsoid kAround{0.2, 0.4};

control::PolynomialSegment straight(const Vector3d& from, const Vector3d& to, double duration_s) {
  const Vector3d velocity = (to - from) / duration_s;
  control::PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = {from.x(), velocity.x()};
  segment.y = {from.y(), velocity.y()};
  segment.z = {from.z(), velocity.z()};
  return segment;
}

// From place to place in 10 s each.
MonitoredVehicle vehicle(const std::vector<Vector3d>& places, int priority = 1) {
  std::vector<FlightPath::Piece> pieces;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    pieces.push_back({10.0 * static_cast<double>(i), straight(places[i], places[i + 1], 10.0)});
  const FlightPath path(std::move(pieces));
  return {{path, kAround, path.duration_s()}, 0.5, priority};
}

VehicleNews at(const Vector3d& place, bool flies_plan = true) {
  VehicleNews news;
  news.reference_ned = news.position_ned = place;
  news.flies_plan = flies_plan;
  return news;
}

// A vehicle on a path along north at 1 m height passes the origin at 5 s; another one stands elsewhere.
class Column : public testing::Test {
 protected:
  static MonitoredVehicle crossing() { return vehicle({{-1, 0, -1}, {1, 0, -1}}); }
  std::vector<Order> step(const std::vector<VehicleNews>& news) {
    now_s_ += kStep_s;
    return monitor_->step(now_s_, news);
  }
  // Flies the first one along its path until the monitor orders something else; the others stand. Returns its path time.
  double fly_until_stopped(const std::vector<VehicleNews>& others) {
    const FlightPath path = crossing().path;
    double s = 0.0;
    while (s < path.duration_s()) {
      std::vector<VehicleNews> news = {at(path.at(s))};
      news.insert(news.end(), others.begin(), others.end());
      orders_ = step(news);
      if (orders_[0].kind != Kind::kFly) break;
      s += kStep_s;
    }
    return s;
  }

  double now_s_ = 0.0;
  std::optional<FleetMonitor> monitor_;
  std::vector<Order> orders_;
};

TEST_F(Column, IsNotEnteredBelowOneThatIsOffItsPathAndIsPassedWhenItHasGone) {
  monitor_.emplace(std::vector<MonitoredVehicle>{crossing(), vehicle({{3, 3, -2}, {3, 3, -2}})});
  const VehicleNews above = at({0, 0, -2}, false);
  const double stopped_s = fly_until_stopped({above});
  EXPECT_EQ(orders_[0].kind, Kind::kPause);
  EXPECT_EQ(orders_[0].because_of, 1U);
  EXPECT_NEAR(stopped_s, 5.0 - 0.44 / 0.2 - 0.55, 0.1)
      << "1.1 times both radii, and the time in which it stops";
  const Vector3d rests = crossing().path.at(stopped_s + 0.25);
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(step({at(rests), above})[0].kind, Kind::kPause) << "it still stands there";
  EXPECT_EQ(step({at(rests), at({3, 3, -2})})[0].kind, Kind::kFly);
}

TEST_F(Column, EndsAboveTheVehicle) {
  monitor_.emplace(std::vector<MonitoredVehicle>{crossing(), vehicle({{3, 3, -2}, {3, 3, -2}})});
  EXPECT_GT(fly_until_stopped({at({0, 0, -0.1}, false)}), 9.9) << "it may fly over one that is 0.9 m lower";
}

// GIVEN a vehicle in the column of one that is off its path THEN it steps aside, and stays there until the way back
// is free of it.
TEST_F(Column, IsLeftAndNotEnteredAgain) {
  monitor_.emplace(std::vector<MonitoredVehicle>{crossing(), vehicle({{0.3, 0, -2}, {0.3, 0, -2}})});
  const FlightPath path = crossing().path;
  double s = 0.0;
  for (; s < 5.0; s += kStep_s) ASSERT_EQ(step({at(path.at(s)), at({0.3, 0, -2})})[0].kind, Kind::kFly) << s;
  const VehicleNews above = at({0.02, 0.05, -2}, false);  // suddenly above it
  Vector3d place = path.at(s);
  orders_ = step({at(place), above});
  ASSERT_EQ(orders_[0].kind, Kind::kStepAside);
  EXPECT_EQ(orders_[1].kind, Kind::kFly);
  const Vector3d aside = orders_[0].place_ned;
  EXPECT_GE((aside - above.position_ned).head<2>().norm(), 1.5 * 0.4 - 1e-9);
  EXPECT_DOUBLE_EQ(aside.z(), place.z());
  int still_ordered = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector3d way = aside - place;
    place += way.normalized() * std::min(way.norm(), 0.6 * kStep_s);
    orders_ = step({at(place), above});
    ASSERT_NE(orders_[0].kind, Kind::kFly) << "the other one is still above the way back";
    if (orders_[0].kind != Kind::kStepAside) continue;
    EXPECT_LT((orders_[0].place_ned - aside).norm(), 1e-9) << "the same place";
    ++still_ordered;
  }
  EXPECT_GT(still_ordered, 3);
  EXPECT_LT((place - aside).norm(), 0.3);
  const VehicleNews gone = at({0.02, 3, -2}, false);
  EXPECT_EQ(step({at(place), gone})[0].kind, Kind::kFly);
  // It flies back and is on its path again.
  const Vector3d left = path.at(s);
  while ((left - place).norm() > 1e-9) {
    const Vector3d way = left - place;
    place += way.normalized() * std::min(way.norm(), 0.5 * kStep_s);
    ASSERT_EQ(step({at(place), gone})[0].kind, Kind::kFly);
  }
  for (; s < 9.0; s += kStep_s) ASSERT_EQ(step({at(path.at(s)), gone})[0].kind, Kind::kFly) << s;
  EXPECT_NEAR(monitor_->progress_s()[0], s, 0.1);
}

// The one above comes again while the other one flies back: it stops on its way.
TEST_F(Column, IsNotFlownThroughOnTheWayBack) {
  monitor_.emplace(std::vector<MonitoredVehicle>{crossing(), vehicle({{0, 0, -2}, {0, 0, -2}})});
  const FlightPath path = crossing().path;
  for (double s = 0.0; s < 5.0; s += kStep_s) step({at(path.at(s)), at({0, 3, -2}, false)});
  const VehicleNews above = at({0, 0.05, -2}, false);
  ASSERT_EQ(step({at({0, 0, -1}), above})[0].kind, Kind::kStepAside);
  const Vector3d aside(0, -0.8, -1);
  ASSERT_EQ(step({at(aside), above})[0].kind, Kind::kPause);
  ASSERT_EQ(step({at(aside), at({0, 3, -2}, false)})[0].kind, Kind::kFly);
  EXPECT_EQ(step({at({0, -0.6, -1}), above})[0].kind, Kind::kPause);
}

// GIVEN one that is to fly back over the path of a third one THEN either that waits, or it waits itself, and both go
// on in the end.
TEST_F(Column, OthersStayOutOfTheWayBack) {
  const FlightPath below = vehicle({{-1, 0.4, -0.3}, {1, 0.4, -0.3}}).path;
  for (const double starts_s : {0.0, 1.5, 2.5}) {
    monitor_.emplace(std::vector<MonitoredVehicle>{crossing(), vehicle({{3, 3, -2}, {3, 3, -2}}),
                                                   vehicle({{-1, 0.4, -0.3}, {1, 0.4, -0.3}})});
    now_s_ = 0.0;
    const FlightPath path = crossing().path;
    const VehicleNews far = at({0, 3, -2}, false);
    for (double s = 0.0; s < 5.0; s += kStep_s)
      step({at(path.at(s)), far, at(below.at(std::min(s, starts_s)))});
    ASSERT_EQ(step({at({0, 0, -1}), at({0, -0.05, -2}, false), at(below.at(starts_s))})[0].kind,
              Kind::kStepAside);
    Vector3d first(0, 0.6, -1);
    double third_s = starts_s;
    bool back = false;
    for (int k = 0; k < 1000 && third_s < 10.0; ++k) {
      orders_ = step({at(first), far, at(below.at(third_s))});
      if (orders_[0].kind == Kind::kFly && !back) first.y() = std::max(first.y() - 0.4 * kStep_s, 0.0);
      back = back || first.y() == 0.0;
      if (back && first.x() < 1.0) first.x() += 0.2 * kStep_s;
      if (orders_[2].kind == Kind::kFly) third_s += kStep_s;
      const Vector3d apart = below.at(third_s) - first;
      ASSERT_TRUE(back || apart.head<2>().norm() > 0.4) << "below it at " << third_s << " s";
    }
    EXPECT_TRUE(back) << "started at " << starts_s;
    EXPECT_GE(third_s, 10.0) << "started at " << starts_s;
  }
}

// GIVEN one that was sent aside, and one that comes after it and waits for it beside its way back WHEN the way is free THEN
// both go on: that the other one stands near does not hold it up, and one in the way is flown around.
TEST_F(Column, TwoThatWouldWaitForEachOtherGoOn) {
  for (const double east : {-0.3, -0.15, 0.0, 0.15, 0.3, 0.45}) {
    const MonitoredVehicle first = crossing();
    const MonitoredVehicle second = vehicle(
        {{east, -2.2, -1}, {east, -2.2, -1}, {east, 1.0, -1}});  // passes the first one's path after it
    monitor_.emplace(std::vector<MonitoredVehicle>{first, vehicle({{3, 3, -2}, {3, 3, -2}}), second});
    now_s_ = 0.0;
    double first_s = 0.0, second_s = 0.0;
    bool was_aside = false, waited = false;
    Vector3d place = first.path.at(0.0);
    const auto to = [&](const Vector3d& there, double speed) {
      const Vector3d way = there - place;
      place += way.normalized() * std::min(way.norm(), speed * kStep_s);
      return (there - place).norm() < 1e-9;
    };
    bool on_path = true;
    while (now_s_ < 60.0 && (first_s < 10.0 || second_s < 20.0)) {
      const bool taken = now_s_ > 5.0 && now_s_ < 25.0;
      orders_ = step({at(place), at(taken ? Vector3d(0.02, 0.05, -2) : Vector3d(3, 3, -2), !taken),
                      at(second.path.at(second_s))});
      if (orders_[0].kind == Kind::kStepAside) {
        on_path = false;
        was_aside = true;
        to(orders_[0].place_ned, 0.6);
      } else if (orders_[0].kind == Kind::kFly) {
        on_path = on_path || to(first.path.at(first_s), 0.5);
        if (on_path) place = first.path.at(first_s += kStep_s);
      }
      if (orders_[2].kind == Kind::kFly) second_s += kStep_s;
      waited = waited || (now_s_ > 25.0 && orders_[2].kind == Kind::kPause);
      ASSERT_GE(clearance(kAround, kAround, second.path.at(second_s) - place), 0.99)
          << east << " at " << now_s_ << " s";
    }
    EXPECT_TRUE(was_aside) << east;
    EXPECT_TRUE(waited) << east;
    EXPECT_GE(first_s, 10.0) << east;
    EXPECT_GE(second_s, 20.0) << east;
  }
}

// GIVEN several that wait aside, each behind one that stands in its way back THEN in a step only one of them searches
// for a way around, and in the end each has one.
TEST_F(Column, OneInAStepSearchesForAWayAround) {
  constexpr std::size_t kGroups = 4;
  constexpr double kApart_m = 20.0;
  const auto there = [](std::size_t group, const Vector3d& place) {
    return Vector3d(place + Vector3d(kApart_m * static_cast<double>(group), 0, 0));
  };
  std::vector<MonitoredVehicle> vehicles;
  for (std::size_t g = 0; g < kGroups; ++g) {
    vehicles.push_back(vehicle({there(g, {-1, 0, -0.6}), there(g, {1, 0, -0.6})}));
    vehicles.push_back(vehicle({there(g, {3, 3, -2}), there(g, {3, 3, -2})}));
    vehicles.push_back(vehicle({there(g, {3, -3, 0}), there(g, {3, -3, 0})}));
  }
  monitor_.emplace(vehicles);
  const auto fly = [&](const Vector3d& first, const Vector3d& above, const Vector3d& standing) {
    std::vector<VehicleNews> news;
    for (std::size_t g = 0; g < kGroups; ++g) {
      news.push_back(at(there(g, first)));
      news.push_back(at(there(g, above), above.y() > 1.0));
      news.push_back(at(there(g, standing)));
      news.back().rotors_off = true;
    }
    return step(news);
  };
  const Vector3d away(3, 3, -2), above(0, 0.001, -1.5), far(3, -3, 0), between(0, -0.3, 0);
  for (double s = 0.0; s < 5.0; s += kStep_s) fly({-1.0 + 0.2 * s, 0, -0.6}, away, far);
  orders_ = fly({0, 0, -0.6}, above, far);
  for (std::size_t g = 0; g < kGroups; ++g) ASSERT_EQ(orders_[3 * g].kind, Kind::kStepAside) << g;
  const Vector3d aside = orders_[0].place_ned;
  std::vector<bool> is_sent(kGroups);
  for (int k = 0; k < 50; ++k) {
    orders_ = fly(aside, k < 5 ? above : away, k < 5 ? far : between);
    int sent_now = 0;
    for (std::size_t g = 0; g < kGroups; ++g) {
      ASSERT_NE(orders_[3 * g].kind, Kind::kFly) << "the way back is not free";
      const bool is_new = k >= 5 && orders_[3 * g].kind == Kind::kStepAside && !is_sent[g];
      if (!is_new) continue;
      is_sent[g] = true;
      ++sent_now;
    }
    ASSERT_LE(sent_now, 1) << "in step " << k;
  }
  EXPECT_EQ(is_sent, std::vector<bool>(kGroups, true));
}

TEST_F(Column, TheWayAsideIsFreeOfOthersAndInTheRoom) {
  const Vector3d third(-0.6, 0, -1);
  MonitoredVehicle narrow = crossing();
  narrow.room = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -2), Eigen::Vector2d(2, 0.3));
  monitor_.emplace(
      std::vector<MonitoredVehicle>{narrow, vehicle({{0, 0, -2}, {0, 0, -2}}), vehicle({third, third})});
  const FlightPath path = crossing().path;
  for (double s = 0.0; s < 5.0; s += kStep_s) step({at(path.at(s)), at({0, 3, -2}, false), at({-3, 0, -1})});
  // The shortest way out is to the south, where the third one stands; to the east is the wall.
  orders_ = step({at({0, 0, -1}), at({0.1, 0.01, -2}, false), at(third)});
  ASSERT_EQ(orders_[0].kind, Kind::kStepAside);
  const Vector3d aside = orders_[0].place_ned;
  EXPECT_TRUE(narrow.room.contains(aside.head<2>())) << aside.transpose();
  EXPECT_GE(clearance(kAround, kAround, aside - third), 1.1 - 1e-9);
  EXPECT_GE((aside - Vector3d(0.1, 0.01, -2)).head<2>().norm(), 0.6 - 1e-9);
}

TEST_F(Column, OfTwoOffTheirPathsTheLowerPriorityStepsAside) {
  monitor_.emplace(std::vector<MonitoredVehicle>{vehicle({{-1, 0, -1}, {1, 0, -1}}, 2),
                                                 vehicle({{3, 3, -2}, {3, 3, -2}})});
  EXPECT_EQ(step({at({2, 0, -1}, false), at({2, 0.1, -1.3}, false)})[0].kind, Kind::kFly);
  EXPECT_EQ(step({at({2, 0, -1}, false), at({2, 0.1, -1.3}, false)})[1].kind, Kind::kStepAside);
}

// Two whose paths cross, the second later: it waits while the first one is late, and only for that.
TEST(Late, IsWaitedForUntilItHasPassed) {
  const MonitoredVehicle first = vehicle({{-1, 0, -1}, {1, 0, -1}});
  const MonitoredVehicle second = vehicle({{0, -3, -1}, {0, -1.5, -1}, {0, 1, -1}});
  FleetMonitor monitor({first, second});
  double now_s = 0.0, s = 0.0;
  std::vector<Order> orders;
  for (; s < 15.0; s += kStep_s) {
    orders = monitor.step(now_s += kStep_s, {at(first.path.at(std::min(s, 2.0))), at(second.path.at(s))});
    ASSERT_EQ(orders[0].kind, Kind::kFly);
    if (orders[1].kind == Kind::kPause) break;
  }
  ASSERT_LT(s, 15.0);
  EXPECT_EQ(orders[1].because_of, 0U);
  EXPECT_GT(clearance(kAround, kAround, second.path.at(s + 0.5) - first.path.at(5.0)), 1.0)
      << "it can stop before";
  double first_s = 2.0;
  for (; first_s < 10.0; first_s += kStep_s) {
    orders = monitor.step(now_s += kStep_s, {at(first.path.at(first_s)), at(second.path.at(s + 0.25))});
    if (orders[1].kind == Kind::kFly) break;
  }
  EXPECT_GT(first_s, 5.0) << "it has passed the crossing";
  EXPECT_LT(first_s, 9.0) << "and is not waited for to its end";
}

}  // namespace swiftlet::ground::fleet_monitor_test
