#include "swiftlet/ground/fleet/fleet_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace swiftlet::ground {
namespace {

constexpr double kSearchStep_s = 0.01;    // with which a path is searched for the reference
constexpr double kOffPath_m = 0.1;        // the reference of a vehicle on its path is nearer to it
constexpr double kAtPlace_m = 0.03;       // the reference of a vehicle at a place of its path is nearer to it
constexpr double kNear_s = 1.0;           // it is back on its path, if it is within kOffPath_m for so long
constexpr double kLanding_m = 0.002;      // below the place above its landing place: it lands
constexpr double kOffReference_m = 0.25;  // the vehicle does not follow its reference
constexpr double kLost_s = 0.5;           // without news
constexpr double kFailsafe_s = 3.0;  // until a lost vehicle has left its path for good, by its own failsafe
constexpr double kSpare_s = 4.0 * RightOfWay::kCell_s;  // one that stands goes on only if it can fly so long
constexpr double kAside = 1.5;       // a vehicle steps aside to this clearance of the column
constexpr double kMargin = 1.1;      // clearance to which others keep away from a column
constexpr double kBackMargin = 1.3;  // clearance of a way back that is begun; kMargin of one that is gone on
// The same clearances for vehicles that stand. Between the places on their paths it is above 1 (right_of_way.hpp).
constexpr double kStandingBackMargin = 1.02, kStandingMargin = 1.0;
constexpr double kBackSpeed = 0.3;   // m/s, the least on the way back to the path, at its end stop_s more
constexpr double kWayStep_m = 0.05;  // between the places of a way
constexpr int kDirections = 8;       // in which a vehicle may step aside
constexpr double kRest_m = 0.001;    // in a step: the reference rests
constexpr double kThere_m = 0.05;    // from the place to which it was sent: it is there
constexpr double kOther_m = 0.2;     // from where it is: nearer places are no others

// The places that a vehicle passes from one place to another, the first left out.
void add_way(const Eigen::Vector3d& from_ned, const Eigen::Vector3d& to_ned,
             std::vector<Eigen::Vector3d>& places) {
  const Eigen::Vector3d way = to_ned - from_ned;
  const int steps = 1 + static_cast<int>(way.norm() / kWayStep_m);
  for (int k = 1; k <= steps; ++k) places.emplace_back(from_ned + k * way / steps);
}

bool is_on_ground(const VehicleNews& news) { return news.rotors_off && news.position_ned.z() > -kOffPath_m; }

}  // namespace

FleetMonitor::FleetMonitor(std::vector<MonitoredVehicle> vehicles)
    : vehicles_(std::move(vehicles)),
      right_of_way_(std::vector<RightOfWay::Vehicle>(vehicles_.begin(), vehicles_.end())),
      progress_s_(vehicles_.size(), 0.0),
      certain_s_(vehicles_.size(), 0.0),
      near_s_(vehicles_.size(), 0.0),
      reference_ned_(vehicles_.size(), Eigen::Vector3d::Zero()),
      paused_s_(vehicles_.size(), -1.0),
      way_(vehicles_.size(), Way::kPath),
      left_s_(vehicles_.size(), 0.0),
      leaving_s_(vehicles_.size(), 0.0),
      aside_ned_(vehicles_.size(), Eigen::Vector3d::Zero()) {}

double FleetMonitor::needed_slack_s(std::size_t vehicle) const {
  return vehicles_[vehicle].stop_s + kSpare_s + RightOfWay::kCell_s;
}

RightOfWay::Slack FleetMonitor::least_slack() const {
  std::vector<double> needed_s;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) needed_s.push_back(needed_slack_s(i));
  return right_of_way_.least_slack(needed_s);
}

// Searches the path ahead for the reference, no further than time has passed. Where the path stands still, its time goes on
// with that of the vehicle: the place is the same.
void FleetMonitor::follow(std::size_t i, double elapsed_s, const VehicleNews& news) {
  const FlightPath& path = vehicles_[i].path;
  const double from_s = progress_s_[i];
  const double to_s =
      std::max(std::min({from_s + elapsed_s, now_s_ + kSearchStep_s, path.duration_s()}), from_s);
  double best_s = from_s;
  double best_m = (path.at(from_s) - news.reference_ned).norm();
  for (double t = from_s; t <= to_s + 0.5 * kSearchStep_s; t += kSearchStep_s) {
    const double s = std::min(t, to_s);
    const double off_m = (path.at(s) - news.reference_ned).norm();
    if (off_m > best_m + 1e-6) continue;
    best_m = off_m;
    best_s = s;
  }
  if (best_m < kOffPath_m) {
    progress_s_[i] = std::min(best_s, std::max(from_s, landing_limit_s(i, news)));
    if (best_m < kAtPlace_m) certain_s_[i] = progress_s_[i];
  } else if (progress_s_[i] - certain_s_[i] < vehicles_[i].stop_s) {
    progress_s_[i] = certain_s_[i];  // it has left its path there, beside which it flew then
  }
}

// A vehicle that hovers where it is to land may be paused there, however long: it has not begun to land, from when on it could
// not be stopped.
double FleetMonitor::landing_limit_s(std::size_t i, const VehicleNews& news) const {
  const MonitoredVehicle& vehicle = vehicles_[i];
  const bool has_begun = (vehicle.path.at(vehicle.lands_s) - news.reference_ned).norm() > kLanding_m;
  if (has_begun) return vehicle.path.duration_s();
  return std::floor(vehicle.lands_s / RightOfWay::kCell_s) * RightOfWay::kCell_s - 1e-6;
}

// Whether a vehicle that was sent aside is at the place where it was told to leave its path, or where it has stopped after
// that: exactly, or near it for a while, if its path is not quite the planned one. Or it has not left its path at all.
bool FleetMonitor::rejoin(std::size_t i, double elapsed_s, const VehicleNews& news) {
  if (way_[i] != Way::kBack && paused_s_[i] < vehicles_[i].stop_s) return false;
  const FlightPath& path = vehicles_[i].path;
  double best_s = left_s_[i], best_m = kOffPath_m;
  for (double t = 0.0; t <= leaving_s_[i] + near_s_[i] + 0.5 * kSearchStep_s; t += kSearchStep_s) {
    const double off_m = (path.at(left_s_[i] + t) - news.reference_ned).norm();
    if (off_m >= best_m) continue;
    best_m = off_m;
    best_s = left_s_[i] + t;
  }
  near_s_[i] = way_[i] == Way::kBack && best_m < kOffPath_m ? near_s_[i] + elapsed_s : 0.0;
  if (best_m >= kAtPlace_m && near_s_[i] < kNear_s) return false;
  progress_s_[i] = certain_s_[i] = best_s;
  return true;
}

FleetMonitor::Status FleetMonitor::status_of(std::size_t i, const VehicleNews& news) const {
  const FlightPath& path = vehicles_[i].path;
  if (news.age_s > kLost_s) return Status::kLost;
  const bool has_ended = progress_s_[i] >= path.duration_s() - RightOfWay::kCell_s;
  if (is_on_ground(news) && has_ended) return Status::kDown;
  const bool is_near = (path.at(progress_s_[i]) - news.reference_ned).norm() < kOffPath_m &&
                       (news.position_ned - news.reference_ned).norm() < kOffReference_m;
  return news.flies_plan && is_near && !news.rotors_off ? Status::kOnPath : Status::kOffPath;
}

// The places at which vehicle i, which was sent aside, may have left its path.
FleetMonitor::Places FleetMonitor::left_places(std::size_t i) const {
  const FlightPath& path = vehicles_[i].path;
  Places places = {path.at(left_s_[i])};
  if (leaving_s_[i] > 0.0) {
    places.push_back(path.at(left_s_[i] + 0.5 * leaving_s_[i]));
    places.push_back(path.at(left_s_[i] + leaving_s_[i]));
  }
  return places;
}

// The places on the straight way back of vehicle i from a place to its path.
FleetMonitor::Places FleetMonitor::way_back(std::size_t i, const Eigen::Vector3d& from_ned) const {
  Places way;
  for (const Eigen::Vector3d& left_ned : left_places(i)) add_way(from_ned, left_ned, way);
  return way;
}

// Where a vehicle may be: a lost one may have flown on along its path until its failsafe brought it down, one that is sent back
// is anywhere on its way.
FleetMonitor::Places FleetMonitor::places_of(std::size_t i, const VehicleNews& news, Status status) const {
  Places places = {news.position_ned};
  const auto add = [&](const Places& way) { places.insert(places.end(), way.begin(), way.end()); };
  if (status == Status::kOffPath && way_[i] == Way::kBack) add(way_back(i, news.position_ned));
  if (status == Status::kOffPath && (way_[i] == Way::kAround || way_[i] == Way::kOn))
    add_way(news.position_ned, aside_ned_[i], places);
  if (status == Status::kOffPath && way_[i] == Way::kAround) add(way_back(i, aside_ned_[i]));
  if (status != Status::kLost || !news.flies_plan) return places;
  const double ahead_s = std::min(news.age_s, kFailsafe_s) + vehicles_[i].stop_s;
  for (double t = 0.0; t <= ahead_s; t += RightOfWay::kCell_s)
    places.push_back(vehicles_[i].path.at(progress_s_[i] + t));
  return places;
}

// A vehicle that is lost, or off its path of its own accord.
bool FleetMonitor::may_sink(std::size_t i, const Scene& scene) const {
  if (scene.status[i] == Status::kLost) return true;
  return scene.status[i] == Status::kOffPath && way_[i] == Way::kPath && !is_on_ground(scene.news[i]);
}

// Whether a vehicle stays where it is until it is told to go on.
bool FleetMonitor::stands(std::size_t i, const Scene& scene) const {
  if (scene.status[i] == Status::kLost) return false;
  const bool waits = way_[i] == Way::kPath || way_[i] == Way::kAside;
  return is_on_ground(scene.news[i]) || (waits && paused_s_[i] >= vehicles_[i].stop_s);
}

// Whether the ellipsoids of a vehicle at this place and of another one, enlarged by `share`, touch.
bool FleetMonitor::is_near(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                           const Eigen::Vector3d& at_ned, double share) const {
  return clearance(vehicles_[i].around, vehicles_[of].around, at_ned - place_ned) < share;
}

// The same for a vehicle `of` that is at top_ned or sinks from there.
bool FleetMonitor::in_column(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                             const Eigen::Vector3d& top_ned, double share) const {
  const Eigen::Vector3d nearest(top_ned.x(), top_ned.y(), std::max(place_ned.z(), top_ned.z()));
  return is_near(i, place_ned, of, nearest, share);
}

// The same for a vehicle `of` at at_ned that sinks from there, if it may sink in this scene.
bool FleetMonitor::touches(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                           const Eigen::Vector3d& at_ned, double share, const Scene& scene) const {
  return may_sink(of, scene) ? in_column(i, place_ned, of, at_ned, share)
                             : is_near(i, place_ned, of, at_ned, share);
}

// Whether a vehicle may stay at this place: in its room, neither near another one nor below one that may come down, nor where
// another one is to come back to its path.
bool FleetMonitor::is_free(std::size_t i, const Eigen::Vector3d& place_ned, const Scene& scene) const {
  if (!vehicles_[i].room.contains(place_ned.head<2>())) return false;
  for (std::size_t j = 0; j < vehicles_.size(); ++j) {
    if (j == i) continue;
    for (const Eigen::Vector3d& at_ned : scene.places[j])
      if (touches(i, place_ned, j, at_ned, kMargin, scene)) return false;
    if (way_[j] == Way::kPath) continue;
    for (const Eigen::Vector3d& left_ned : left_places(j))
      if (is_near(i, place_ned, j, left_ned, kMargin)) return false;
  }
  return true;
}

// Beside the other one, in the direction nearest to the shortest way out of its column that is free. Without one, the shortest.
Eigen::Vector3d FleetMonitor::place_aside(std::size_t i, const Eigen::Vector3d& at_ned, std::size_t of,
                                          const Scene& scene) const {
  const Eigen::Vector3d& here = scene.news[i].position_ned;
  Eigen::Vector2d away = (here - at_ned).head<2>();
  away = away.norm() < 1e-3 ? Eigen::Vector2d(Eigen::Vector2d::UnitX()) : Eigen::Vector2d(away.normalized());
  const double reach_m = vehicles_[i].around.radius_xy_m + vehicles_[of].around.radius_xy_m;
  const auto beside = [&](int direction, double times) {
    const double turn =
        2.0 * M_PI / kDirections * (direction % 2 == 0 ? direction / 2 : -(direction + 1) / 2);
    Eigen::Vector3d place = here;
    place.head<2>() = at_ned.head<2>() + times * kAside * reach_m * (Eigen::Rotation2Dd(turn) * away);
    return place;
  };
  for (const double times : {1.0, 1.5, 2.0}) {
    for (int direction = 0; direction < kDirections; ++direction) {
      const Eigen::Vector3d place = beside(direction, times);
      if (is_free(i, place, scene)) return place;
    }
  }
  return beside(0, 1.0);
}

// True if vehicle i yields to vehicle `of`. If both are off their paths, one that the monitor has sent there yields to one
// that is there of its own accord.
bool FleetMonitor::yields(std::size_t i, std::size_t of, const Scene& scene) const {
  if (scene.status[i] == Status::kOnPath || scene.status[of] == Status::kLost) return true;
  const bool is_sent = way_[i] != Way::kPath;
  if (is_sent != (way_[of] != Way::kPath)) return is_sent;
  if (vehicles_[i].priority != vehicles_[of].priority) return vehicles_[i].priority < vehicles_[of].priority;
  return i > of;
}

// The others keep away from vehicle `of`, which is off its path.
void FleetMonitor::keep_away(std::size_t of, const Scene& scene, std::vector<Order>& orders) const {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const Status status = scene.status[i];
    if (i == of || status == Status::kDown || status == Status::kLost || scene.news[i].rotors_off) continue;
    if (!yields(i, of, scene)) continue;
    for (const Eigen::Vector3d& at_ned : scene.places[of]) {
      if (touches(i, scene.news[i].position_ned, of, at_ned, 1.0, scene)) {
        const bool stays = way_[i] == Way::kAside && is_free(i, aside_ned_[i], scene);
        orders[i] = {Order::Kind::kStepAside, stays ? aside_ned_[i] : place_aside(i, at_ned, of, scene), of};
        break;
      }
      if (status != Status::kOnPath || orders[i].kind == Order::Kind::kStepAside) continue;
      for (double t = 0.0; t <= vehicles_[i].stop_s + RightOfWay::kCell_s; t += RightOfWay::kCell_s) {
        if (!in_column(i, vehicles_[i].path.at(progress_s_[i] + t), of, at_ned, kMargin)) continue;
        orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), of};
        break;
      }
    }
  }
}

void FleetMonitor::wait_for_late(const Scene& scene, std::vector<Order>& orders) const {
  // Nobody waits for one that will not come: it is in the way where it is.
  std::vector<double> awaited_s = progress_s_;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (scene.status[i] == Status::kOffPath && scene.news[i].rotors_off)
      awaited_s[i] = vehicles_[i].path.duration_s();
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (scene.status[i] != Status::kOnPath) continue;
    std::size_t blocker = 0;
    const double limit_s = right_of_way_.limit_s(i, awaited_s, blocker);
    const double spare_s = paused_s_[i] >= 0.0 ? kSpare_s : 0.0;
    if (progress_s_[i] + vehicles_[i].stop_s + spare_s >= limit_s)
      orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), blocker};
  }
}

// The vehicle that is on a way of vehicle i, above it, or comes there meanwhile; nullopt if vehicle i may go. Where it is
// already nearer to another one, it may go away from that.
std::optional<std::size_t> FleetMonitor::blocker(std::size_t i, const Places& way, bool has_begun,
                                                 const Scene& scene, const std::vector<Order>& orders) const {
  const Eigen::Vector3d& here = scene.news[i].position_ned;
  double length_m = 0.0;
  for (const Eigen::Vector3d& place : way) length_m = std::max(length_m, (place - here).norm());
  const double time_s = length_m / kBackSpeed + vehicles_[i].stop_s;
  for (std::size_t j = 0; j < vehicles_.size(); ++j) {
    if (j == i) continue;
    const bool stands_there = stands(j, scene);
    const double share = stands_there ? (has_begun ? kStandingMargin : kStandingBackMargin)
                                      : (has_begun ? kMargin : kBackMargin);
    Places others = scene.places[j];
    // One that waits, perhaps for this one, comes no further.
    const double ahead_s = orders[j].kind == Order::Kind::kFly ? time_s : vehicles_[j].stop_s;
    for (double t = 0.0; scene.status[j] == Status::kOnPath && !stands_there && t <= ahead_s;
         t += RightOfWay::kCell_s)
      others.push_back(vehicles_[j].path.at(progress_s_[j] + t));
    const double now = clearance(vehicles_[i].around, vehicles_[j].around, scene.news[j].position_ned - here);
    for (const Eigen::Vector3d& place : way) {
      for (const Eigen::Vector3d& other : others) {
        const double least = stands_there ? std::min(share, now) : share;
        if (touches(i, place, j, other, least, scene)) return j;
      }
    }
  }
  return std::nullopt;
}

// A place from which the way back is free, and to which the way is: beside one that stands, in the direction that makes the way
// shortest, at the height of either end.
std::optional<Eigen::Vector3d> FleetMonitor::place_beside(std::size_t i, std::size_t of, const Scene& scene,
                                                          const std::vector<Order>& orders) const {
  const Eigen::Vector3d& here = scene.news[i].position_ned;
  const Eigen::Vector3d left_ned = left_places(i).front();
  const double reach_m = vehicles_[i].around.radius_xy_m + vehicles_[of].around.radius_xy_m;
  std::optional<Eigen::Vector3d> best;
  double best_m = 0.0;
  for (const double z_ned : {here.z(), left_ned.z()}) {
    for (const double times : {1.0, 1.5, 2.0}) {
      for (int direction = 0; direction < kDirections; ++direction) {
        Eigen::Vector3d place = scene.news[of].position_ned;
        place.head<2>() += times * kAside * reach_m *
                           Eigen::Rotation2Dd(2.0 * M_PI / kDirections * direction).toRotationMatrix().col(0);
        place.z() = z_ned;
        const double length_m = (place - here).norm() + (left_ned - place).norm();
        if ((best && length_m >= best_m) || (place - here).norm() < kOther_m) continue;
        if (!is_free(i, place, scene)) continue;
        Places way;
        add_way(here, place, way);
        const Places back = way_back(i, place);
        way.insert(way.end(), back.begin(), back.end());
        if (blocker(i, way, false, scene, orders)) continue;
        best = place;
        best_m = length_m;
      }
    }
  }
  return best;
}

// The turn passes to the next vehicle that is aside. Each searches in its turn, which bounds the work of a step.
void FleetMonitor::pass_turn() {
  for (std::size_t k = 0; k < vehicles_.size(); ++k) {
    turn_ = (turn_ + 1) % vehicles_.size();
    if (way_[turn_] == Way::kAside) return;
  }
}

// Vehicle i, which the monitor has sent aside, returns to its path when nobody is in its way.
void FleetMonitor::send_back(std::size_t i, const Scene& scene, std::vector<Order>& orders) {
  const Eigen::Vector3d& here = scene.news[i].position_ned;
  const std::optional<std::size_t> in_the_way =
      blocker(i, way_back(i, here), way_[i] == Way::kBack, scene, orders);
  if (!in_the_way) {
    way_[i] = Way::kBack;
    return;
  }
  if ((way_[i] == Way::kAround || way_[i] == Way::kOn) && (aside_ned_[i] - here).norm() > kThere_m &&
      !blocker(i, scene.places[i], true, scene, orders)) {
    orders[i] = {Order::Kind::kStepAside, aside_ned_[i], *in_the_way};
    return;
  }
  way_[i] = Way::kAside;
  orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), *in_the_way};
  if (i != turn_ || paused_s_[i] < vehicles_[i].stop_s || !stands(*in_the_way, scene)) return;
  if (const auto place = place_beside(i, *in_the_way, scene, orders)) {
    way_[i] = Way::kAround;
    aside_ned_[i] = *place;
    orders[i] = {Order::Kind::kStepAside, *place, *in_the_way};
  }
}

// Vehicle i waits aside. Another one that was sent aside to its way back, and waits too, goes elsewhere.
void FleetMonitor::make_way_back(std::size_t i, const Scene& scene, std::vector<Order>& orders) {
  const std::size_t j = orders[i].because_of;
  const bool both_wait = orders[j].kind == Order::Kind::kPause && stands(i, scene) && stands(j, scene);
  if (way_[j] != Way::kAside || !both_wait) return;
  const Eigen::Vector3d place = place_aside(j, left_places(i).front(), i, scene);
  if ((place - scene.news[j].position_ned).norm() < kOther_m || !is_free(j, place, scene)) return;
  orders[j] = {Order::Kind::kStepAside, place, i};
  way_[j] = Way::kOn;
  aside_ned_[j] = place;
}

std::vector<Order> FleetMonitor::step(double now_s, const std::vector<VehicleNews>& news) {
  const double elapsed_s = std::max(now_s - now_s_, 0.0);
  now_s_ = now_s;
  Scene scene{news, {}, {}};
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (news[i].age_s <= kLost_s && news[i].flies_plan) {
      if (way_[i] == Way::kPath) follow(i, elapsed_s + 2.0 * kSearchStep_s, news[i]);
      if (way_[i] != Way::kPath && rejoin(i, elapsed_s, news[i])) way_[i] = Way::kPath;
    }
    if (!news[i].flies_plan || news[i].rotors_off) way_[i] = Way::kPath;
    scene.status.push_back(status_of(i, news[i]));
    if (way_[i] != Way::kPath && scene.status[i] == Status::kOnPath) scene.status[i] = Status::kOffPath;
    scene.places.push_back(places_of(i, news[i], scene.status[i]));
  }
  std::vector<Order> orders(vehicles_.size());
  wait_for_late(scene, orders);
  for (std::size_t of = 0; of < vehicles_.size(); ++of) {
    if (scene.status[of] == Status::kOffPath || scene.status[of] == Status::kLost)
      keep_away(of, scene, orders);
  }
  pass_turn();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (orders[i].kind == Order::Kind::kStepAside) {
      if (way_[i] == Way::kPath) {
        left_s_[i] = progress_s_[i];
        leaving_s_[i] = stands(i, scene) ? 0.0 : vehicles_[i].stop_s;
      }
      way_[i] = Way::kAside;
      aside_ned_[i] = orders[i].place_ned;
    } else if (way_[i] != Way::kPath && scene.status[i] == Status::kOffPath) {
      send_back(i, scene, orders);
      scene.places[i] = places_of(i, news[i], scene.status[i]);  // those after it wait for it
    }
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (way_[i] == Way::kAside && orders[i].kind == Order::Kind::kPause) make_way_back(i, scene, orders);
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const bool rests = (news[i].reference_ned - reference_ned_[i]).norm() < kRest_m;
    if (orders[i].kind != Order::Kind::kPause)
      paused_s_[i] = -1.0;
    else
      paused_s_[i] = rests && paused_s_[i] >= 0.0 ? paused_s_[i] + elapsed_s : 0.0;
    reference_ned_[i] = news[i].reference_ned;
  }
  return orders;
}

}  // namespace swiftlet::ground
