// Random swarms of kinematic vehicles under the monitor: apart when nothing fails, and no collision when one vehicle
// stops, is lost or is late. `./dev soak swarms` flies 10,000.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/guidance/time_scaling.hpp"
#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "tests/support/campaign.hpp"

namespace swiftlet::ground::swarm_property_test {

constexpr double kStep_s = 0.02;
constexpr double kMonitor_s = 0.04;  // period of the monitor
constexpr double kReaction_s = 0.1;  // from an order until the vehicle obeys
constexpr double kSpeed = 0.7;       // m/s, peak
constexpr double kTakenSpeed = 0.3;  // m/s, of one that the pilot flies
constexpr double kTaken_s = 10.0;    // how long
const control::Limits kLimits = [] {
  control::Limits limits;
  limits.max_reference_acceleration = 2.0;
  limits.max_reference_jerk = 8.0;
  return limits;
}();
const Ellipsoid kSafety{0.15, 0.3};
const Ellipsoid kKeptApart{0.1, 0.2};
const Ellipsoid kBody{0.08, 0.05};  // what collides

using Random = std::mt19937_64;

double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

void move(std::vector<FlightPath::Piece>& pieces, Eigen::Vector3d& at, const Eigen::Vector3d& to,
          double hold_s) {
  const double now_s = pieces.empty() ? 0.8 : pieces.back().end_s();
  const double duration_s = control::minimum_jerk_duration(
      (to - at).norm(), kSpeed, kLimits.max_reference_acceleration, kLimits.max_reference_jerk, 0.5);
  if (pieces.empty()) pieces.push_back({0.0, control::minimum_jerk(at, 0.0, at, 0.0, now_s)});
  pieces.push_back({now_s, control::minimum_jerk(at, 0.0, to, 0.0, duration_s)});
  if (hold_s > 0.0)
    pieces.push_back({pieces.back().end_s(), control::minimum_jerk(to, 0.0, to, 0.0, hold_s)});
  at = to;
}

// From one place on the ground by one or two places in the air to another place on the ground.
FlightPath random_path(Random& random, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  std::vector<FlightPath::Piece> pieces;
  Eigen::Vector3d at(from.x(), from.y(), 0.0);
  const double height_m = uniform(random, 0.4, 2.2);
  move(pieces, at, {at.x(), at.y(), -height_m}, uniform(random, 0.0, 4.0));
  if (uniform(random, 0.0, 1.0) < 0.5)
    move(pieces, at, {uniform(random, -2.0, 2.0), uniform(random, -2.0, 2.0), -uniform(random, 0.4, 2.2)},
         uniform(random, 0.0, 1.0));
  move(pieces, at, {to.x(), to.y(), at.z()}, 0.3);
  move(pieces, at, {to.x(), to.y(), 0.0}, 0.0);
  return FlightPath(std::move(pieces));
}

struct Swarm {
  std::vector<MonitoredVehicle> vehicles;
  FleetMonitor monitor;  // at the start
};

// A swarm that the check accepts, or nothing.
std::optional<Swarm> draw(Random& random) {
  const auto count = static_cast<std::size_t>(std::uniform_int_distribution<int>(2, 7)(random));
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 9; ++i) places.emplace_back(1.2 * (i % 3 - 1), 1.2 * (i / 3 - 1));
  std::vector<Eigen::Vector2d> from = places, to = places;
  std::shuffle(from.begin(), from.end(), random);
  std::shuffle(to.begin(), to.end(), random);
  std::vector<MonitoredVehicle> vehicles;
  for (std::size_t i = 0; i < count; ++i) {
    const FlightPath path = random_path(random, from[i], to[i]);
    for (const MonitoredVehicle& other : vehicles) {
      if (closest_approach(path, kSafety, other.path, kSafety).clearance < 1.0) return std::nullopt;
    }
    const double stop_s =
        kReaction_s + kMonitor_s + kStep_s +
        0.5 * control::clock_change_duration(greatest_speed(path), kLimits.max_reference_acceleration,
                                             kLimits.max_reference_jerk, 0.5);
    vehicles.push_back(
        {{path, kKeptApart, path.pieces().back().start_s}, stop_s, 1 + static_cast<int>(i) % 3});
  }
  FleetMonitor monitor(vehicles);
  const RightOfWay::Slack slack = monitor.least_slack();
  if (slack.slack_s < monitor.needed_slack_s(slack.second)) return std::nullopt;
  return Swarm{std::move(vehicles), std::move(monitor)};
}

// kTaken: a pilot takes the vehicle above another one, lets it hover there, and back.
enum class Fault { kNone, kStopped, kLost, kLate, kTaken };

// A vehicle that follows its path exactly, with the time scaling of the controller.
class Kinematic {
 public:
  explicit Kinematic(const FlightPath& path) : path_(path), place_(path.at(0.0)) {
    stop_s_ = control::clock_change_duration(greatest_speed(path), kLimits.max_reference_acceleration,
                                             kLimits.max_reference_jerk, 0.5);
  }

  void obey(const Order& order, double now_s) {
    if (order.kind == asked_.kind && (order.place_ned - asked_.place_ned).norm() < 0.2) return;
    asked_ = order;
    obeys_at_s_ = now_s + kReaction_s;
  }

  void step(double now_s, Fault fault, bool failed) {
    if (failed && fault == Fault::kStopped) return;
    if (fault == Fault::kTaken && taken_to_ && (failed || taken_)) {
      taken_ = failed || !fly_to(path_.at(time_s_), kTakenSpeed);
      if (failed) fly_to(*taken_to_, kTakenSpeed);
      return;
    }
    if (failed && fault == Fault::kLost) {
      if (!lost_since_s_) lost_since_s_ = now_s;
      if (now_s - *lost_since_s_ < 1.0) return advance(now_s);
      place_.z() = std::min(place_.z() + 0.5 * kStep_s, 0.0);
      return;
    }
    if (failed && fault == Fault::kLate) return;
    if (asked_.kind == Order::Kind::kStepAside && now_s >= obeys_at_s_) {
      off_path_ = aside_ = true;
      fly_to(asked_.place_ned, 0.8);
    } else if (!off_path_) {
      advance(now_s);
    } else if (asked_.kind == Order::Kind::kFly && now_s >= obeys_at_s_) {
      // Back to where it has left its path, and on from there.
      off_path_ = !fly_to(path_.at(time_s_), 0.5);
    }
  }

  VehicleNews news(double heard_s, double now_s) const {
    VehicleNews news;
    news.reference_ned = news.position_ned = place_;
    news.age_s = now_s - heard_s;
    news.rotors_off = time_s_ >= path_.duration_s();
    return news;
  }

  void take_to(const Eigen::Vector3d& place_ned) {
    if (!taken_to_) taken_to_ = place_ned;
  }
  const Eigen::Vector3d& place() const { return place_; }
  bool has_ended() const { return time_s_ >= path_.duration_s(); }
  bool slowed() const { return slowed_; }
  bool was_aside() const { return aside_; }

 private:
  // Returns true when it is there.
  bool fly_to(const Eigen::Vector3d& to, double speed) {
    const Eigen::Vector3d way = to - place_;
    place_ += way.normalized() * std::min(way.norm(), speed * kStep_s);
    return (to - place_).norm() < 1e-6;
  }

  void advance(double now_s) {
    const bool lands = time_s_ >= path_.pieces().back().start_s;
    const bool runs = lands || asked_.kind == Order::Kind::kFly || now_s < obeys_at_s_;
    slowed_ = slowed_ || !runs;
    if (runs != clock_.runs) clock_.turn(runs, stop_s_, std::llround(vehicle_s_ * 1e9));
    vehicle_s_ += kStep_s;
    time_s_ = static_cast<double>(clock_.at(std::llround(vehicle_s_ * 1e9)).at_ns) * 1e-9;
    place_ = path_.at(time_s_);
  }

  const FlightPath& path_;
  Eigen::Vector3d place_;
  Order asked_;
  double obeys_at_s_ = 0.0;
  double stop_s_ = 0.0;
  double vehicle_s_ = 0.0, time_s_ = 0.0;
  control::TimeScaling clock_;
  std::optional<double> lost_since_s_;
  std::optional<Eigen::Vector3d> taken_to_;
  bool taken_ = false;     // by the pilot, until it is back on its path
  bool off_path_ = false;  // sent by the monitor
  bool aside_ = false;     // it was, once
  bool slowed_ = false;
};

struct Outcome {
  double safety = 1e9, body = 1e9;  // least clearances
  bool all_landed = true;           // but the failed one
  bool any_slowed = false;
  int aside = 0, back = 0;  // that stepped aside, and of these that landed at the end of their paths
};

// Above the nearest other one that flies.
std::optional<Eigen::Vector3d> place_above_another(const std::vector<Kinematic>& vehicles,
                                                   std::size_t failing) {
  std::optional<Eigen::Vector3d> nearest;
  const Eigen::Vector3d& here = vehicles[failing].place();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Eigen::Vector3d& there = vehicles[i].place();
    if (i == failing || there.z() > -0.2) continue;
    if (!nearest || (there - here).norm() < (*nearest - here).norm()) nearest = there;
  }
  if (nearest) nearest->z() -= 1.0;
  return nearest;
}

double duration_of(Fault fault) {
  if (fault == Fault::kLate) return 1.0;
  return fault == Fault::kTaken ? kTaken_s : 1e9;
}

Outcome fly(const Swarm& swarm, Fault fault, std::size_t failing, double fails_s) {
  std::vector<Kinematic> vehicles;
  double duration_s = 0.0;
  for (const MonitoredVehicle& vehicle : swarm.vehicles) {
    vehicles.emplace_back(vehicle.path);
    duration_s = std::max(duration_s, vehicle.path.duration_s());
  }
  FleetMonitor monitor = swarm.monitor;
  std::vector<VehicleNews> news(vehicles.size());
  std::vector<VehicleNews> heard(vehicles.size());
  double heard_s = 0.0;
  Outcome out;
  const int steps = static_cast<int>((duration_s + (fault == Fault::kTaken ? 60.0 : 10.0)) / kStep_s);
  for (int k = 0; k < steps; ++k) {
    const double now_s = k * kStep_s;
    const bool failed = now_s >= fails_s && now_s < fails_s + duration_of(fault);
    if (failed && fault == Fault::kTaken) {
      if (const auto place = place_above_another(vehicles, failing)) vehicles[failing].take_to(*place);
    }
    if (k % 2 == 0) {
      for (std::size_t i = 0; i < vehicles.size(); ++i) {
        const bool silent = fault == Fault::kLost && i == failing && failed;
        if (!silent) heard[i] = vehicles[i].news(now_s, now_s);
        if (!silent && i == failing) heard_s = now_s;
        news[i] = heard[i];
        if (i == failing) news[i].age_s = now_s - heard_s;
      }
      const std::vector<Order> orders = monitor.step(now_s, news);
      for (std::size_t i = 0; i < vehicles.size(); ++i) vehicles[i].obey(orders[i], now_s);
    }
    for (std::size_t i = 0; i < vehicles.size(); ++i) vehicles[i].step(now_s, fault, failed && i == failing);
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Eigen::Vector3d apart = vehicles[j].place() - vehicles[i].place();
        out.safety = std::min(out.safety, clearance(kSafety, kSafety, apart));
        // The pilot looks after the vehicle that he flies, and who stands with its rotors off cannot make way.
        const bool of_failing = i == failing || j == failing;
        if (of_failing && (fault == Fault::kTaken || vehicles[i].has_ended() || vehicles[j].has_ended()))
          continue;
        out.body = std::min(out.body, clearance(kBody, kBody, apart));
      }
    }
  }
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    out.all_landed = out.all_landed && (i == failing || vehicles[i].has_ended());
    out.any_slowed = out.any_slowed || vehicles[i].slowed();
    out.aside += vehicles[i].was_aside() ? 1 : 0;
    out.back += vehicles[i].was_aside() && vehicles[i].has_ended() ? 1 : 0;
  }
  return out;
}

TEST(RandomSwarms, StayApartAndNeverCollideWhenOneFails) {
  Random random(2026);
  const int swarms = tests::draws(40, 10'000);
  int flown = 0, drawn = 0, slowed_by_late = 0, landed_despite_late = 0, aside = 0, back = 0;
  while (flown < swarms) {
    ++drawn;
    const std::optional<Swarm> swarm = draw(random);
    if (!swarm) continue;
    ++flown;
    const Outcome nominal = fly(*swarm, Fault::kNone, 0, 1e9);
    ASSERT_GE(nominal.safety, 1.0 - 1e-3) << "swarm " << drawn;
    ASSERT_FALSE(nominal.any_slowed) << "swarm " << drawn;
    const auto failing = static_cast<std::size_t>(
        std::uniform_int_distribution<std::size_t>(0, swarm->vehicles.size() - 1)(random));
    const double fails_s = uniform(random, 0.0, swarm->vehicles[failing].path.duration_s());
    for (const Fault fault : {Fault::kStopped, Fault::kLost, Fault::kLate, Fault::kTaken}) {
      const Outcome outcome = fly(*swarm, fault, failing, fails_s);
      EXPECT_GE(outcome.body, 1.0) << "swarm " << drawn << ", fault " << static_cast<int>(fault)
                                   << " of vehicle " << failing << " at " << fails_s << " s";
      if (fault == Fault::kTaken) {
        aside += outcome.aside;
        back += outcome.back;
      }
      if (fault != Fault::kLate) continue;
      slowed_by_late += outcome.any_slowed ? 1 : 0;
      landed_despite_late += outcome.all_landed ? 1 : 0;
    }
  }
  EXPECT_EQ(landed_despite_late, flown) << "one that is late holds nobody up for good";
  EXPECT_GT(slowed_by_late, 0) << "the faults must matter";
  EXPECT_GT(aside, 0);
  EXPECT_EQ(back, aside) << "who stepped aside flies on to the end";
  RecordProperty("drawn", drawn);
  std::printf(
      "%d swarms of %d drawn: in %d others slowed down for the one that was late; %d vehicles stepped aside, "
      "of which %d "
      "flew their paths to the end\n",
      flown, drawn, slowed_by_late, aside, back);
}

}  // namespace swiftlet::ground::swarm_property_test
