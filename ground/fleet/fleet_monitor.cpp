#include "swiftlet/ground/fleet/fleet_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace swiftlet::ground {
namespace {

constexpr double kStep_s = 0.01;          // with which a path is searched for the reference
constexpr double kOffPath_m = 0.1;        // the reference of a vehicle on its path is nearer to it
constexpr double kLanding_m = 0.002;      // below the place above its landing place: it lands
constexpr double kOffReference_m = 0.25;  // the vehicle does not follow its reference
constexpr double kLost_s = 0.5;           // without news
constexpr double kFailsafe_s = 3.0;  // until a lost vehicle has left its path for good, by its own failsafe
constexpr double kSpare_s = 4.0 * RightOfWay::kCell_s;  // one that stands goes on only if it can fly so long
constexpr double kAside = 1.5;       // a vehicle steps aside to this clearance of the column
constexpr double kMargin = 1.1;      // clearance to which others keep away from a column
constexpr double kBackMargin = 1.3;  // clearance of a way back that is begun; kMargin of one that is gone on
constexpr double kBackSpeed = 0.3;   // m/s, the least on the way back to the path, at its end stop_s more
constexpr double kWayStep_m = 0.05;  // between the places of a way
constexpr int kDirections = 8;       // in which a vehicle may step aside

}  // namespace

FleetMonitor::FleetMonitor(std::vector<MonitoredVehicle> vehicles)
    : vehicles_(std::move(vehicles)),
      right_of_way_(std::vector<RightOfWay::Vehicle>(vehicles_.begin(), vehicles_.end())),
      progress_s_(vehicles_.size(), 0.0),
      paused_(vehicles_.size(), false),
      way_(vehicles_.size(), Way::kPath),
      left_s_(vehicles_.size(), 0.0),
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
  const double stops_s = way_[i] == Way::kPath ? path.duration_s() : left_s_[i] + vehicles_[i].stop_s;
  const double to_s =
      std::max(std::min({from_s + elapsed_s, now_s_ + kStep_s, path.duration_s(), stops_s}), from_s);
  double best_s = from_s;
  double best_m = (path.at(from_s) - news.reference_ned).norm();
  for (double t = from_s; t <= to_s + 0.5 * kStep_s; t += kStep_s) {
    const double s = std::min(t, to_s);
    const double off_m = (path.at(s) - news.reference_ned).norm();
    if (off_m > best_m + 1e-6) continue;
    best_m = off_m;
    best_s = s;
  }
  if (best_m < kOffPath_m) progress_s_[i] = std::min(best_s, std::max(from_s, landing_limit_s(i, news)));
}

// A vehicle that hovers where it is to land may be paused there, however long: it has not begun to land, from when on it could
// not be stopped.
double FleetMonitor::landing_limit_s(std::size_t i, const VehicleNews& news) const {
  const MonitoredVehicle& vehicle = vehicles_[i];
  const bool has_begun = (vehicle.path.at(vehicle.lands_s) - news.reference_ned).norm() > kLanding_m;
  if (has_begun) return vehicle.path.duration_s();
  return std::floor(vehicle.lands_s / RightOfWay::kCell_s) * RightOfWay::kCell_s - 1e-6;
}

// A vehicle comes back to where it was told to leave its path, or to where it has stopped after that.
void FleetMonitor::rejoin(std::size_t i, const VehicleNews& news) {
  const FlightPath& path = vehicles_[i].path;
  double best_m = kOffPath_m;
  for (double t = 0.0; t <= vehicles_[i].stop_s + kStep_s; t += kStep_s) {
    const double off_m = (path.at(left_s_[i] + t) - news.reference_ned).norm();
    if (off_m >= best_m) continue;
    best_m = off_m;
    progress_s_[i] = left_s_[i] + t;
  }
}

FleetMonitor::Status FleetMonitor::status_of(std::size_t i, const VehicleNews& news) const {
  const FlightPath& path = vehicles_[i].path;
  if (news.age_s > kLost_s) return Status::kLost;
  const bool has_ended = progress_s_[i] >= path.duration_s() - RightOfWay::kCell_s;
  const bool stands = news.rotors_off && news.position_ned.z() > -kOffPath_m;
  if (stands && has_ended) return Status::kDown;
  const bool is_near = (path.at(progress_s_[i]) - news.reference_ned).norm() < kOffPath_m &&
                       (news.position_ned - news.reference_ned).norm() < kOffReference_m;
  return news.flies_plan && is_near && !news.rotors_off ? Status::kOnPath : Status::kOffPath;
}

// From where it is to where it has left its path.
std::vector<Eigen::Vector3d> FleetMonitor::way_back(std::size_t i, const VehicleNews& news) const {
  const Eigen::Vector3d way = vehicles_[i].path.at(progress_s_[i]) - news.position_ned;
  const int steps = 1 + static_cast<int>(way.norm() / kWayStep_m);
  std::vector<Eigen::Vector3d> places;
  for (int k = 1; k <= steps; ++k) places.emplace_back(news.position_ned + k * way / steps);
  return places;
}

// Where a vehicle may be: a lost one may have flown on along its path until its failsafe brought it down, one that is sent back
// is anywhere on its way.
std::vector<Eigen::Vector3d> FleetMonitor::places_of(std::size_t i, const VehicleNews& news,
                                                     Status status) const {
  std::vector<Eigen::Vector3d> places = {news.position_ned};
  if (status == Status::kOffPath && way_[i] == Way::kBack) {
    const std::vector<Eigen::Vector3d> way = way_back(i, news);
    places.insert(places.end(), way.begin(), way.end());
  }
  if (status != Status::kLost || !news.flies_plan) return places;
  const double ahead_s = std::min(news.age_s, kFailsafe_s) + vehicles_[i].stop_s;
  for (double t = 0.0; t <= ahead_s; t += RightOfWay::kCell_s)
    places.push_back(vehicles_[i].path.at(progress_s_[i] + t));
  return places;
}

// Whether the ellipsoids of a vehicle at this place and of another one, enlarged by `share`, touch.
bool FleetMonitor::is_near(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                           const Eigen::Vector3d& at_ned, double share) const {
  return clearance(vehicles_[i].around, vehicles_[of].around, at_ned - place_ned) < share;
}

// The same, of one that is at top_ned or sinks from there.
bool FleetMonitor::in_column(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                             const Eigen::Vector3d& top_ned, double share) const {
  const Eigen::Vector3d nearest(top_ned.x(), top_ned.y(), std::max(place_ned.z(), top_ned.z()));
  return is_near(i, place_ned, of, nearest, share);
}

// Whether a vehicle may stay at this place: in its room, and neither near another one nor below one that may come down.
bool FleetMonitor::is_free(std::size_t i, const Eigen::Vector3d& place_ned, const Scene& scene) const {
  if (!vehicles_[i].room.contains(place_ned.head<2>())) return false;
  for (std::size_t j = 0; j < vehicles_.size(); ++j) {
    if (j == i) continue;
    const bool may_sink = scene.status[j] == Status::kOffPath || scene.status[j] == Status::kLost;
    for (const Eigen::Vector3d& at : scene.places[j]) {
      if (may_sink ? in_column(i, place_ned, j, at, kMargin) : is_near(i, place_ned, j, at, kMargin))
        return false;
    }
  }
  return true;
}

// Beside the column, in the direction nearest to the shortest way out of it that is free. Without one, the shortest.
Eigen::Vector3d FleetMonitor::place_aside(std::size_t i, const Eigen::Vector3d& top_ned, std::size_t of,
                                          const Scene& scene) const {
  const Eigen::Vector3d& here = scene.news[i].position_ned;
  Eigen::Vector2d away = (here - top_ned).head<2>();
  away = away.norm() < 1e-3 ? Eigen::Vector2d(Eigen::Vector2d::UnitX()) : Eigen::Vector2d(away.normalized());
  const double reach_m = vehicles_[i].around.radius_xy_m + vehicles_[of].around.radius_xy_m;
  const auto at = [&](int direction) {
    const double turn =
        2.0 * M_PI / kDirections * (direction % 2 == 0 ? direction / 2 : -(direction + 1) / 2);
    Eigen::Vector3d place = here;
    place.head<2>() = top_ned.head<2>() + kAside * reach_m * (Eigen::Rotation2Dd(turn) * away);
    return place;
  };
  for (int direction = 0; direction < kDirections; ++direction) {
    if (is_free(i, at(direction), scene)) return at(direction);
  }
  return at(0);
}

// Of two off their paths, one that the monitor has sent there yields to one that is there of its own accord.
bool FleetMonitor::yields(std::size_t i, std::size_t of, const Scene& scene) const {
  if (scene.status[i] == Status::kOnPath || scene.status[of] == Status::kLost) return true;
  const bool is_sent = way_[i] != Way::kPath;
  if (is_sent != (way_[of] != Way::kPath)) return is_sent;
  if (vehicles_[i].priority != vehicles_[of].priority) return vehicles_[i].priority < vehicles_[of].priority;
  return i > of;
}

void FleetMonitor::keep_out_of_column(std::size_t of, const Scene& scene, std::vector<Order>& orders) const {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const Status status = scene.status[i];
    if (i == of || status == Status::kDown || status == Status::kLost || scene.news[i].rotors_off) continue;
    if (!yields(i, of, scene)) continue;
    for (const Eigen::Vector3d& top : scene.places[of]) {
      if (in_column(i, scene.news[i].position_ned, of, top, 1.0)) {
        const bool stays = way_[i] == Way::kAside && is_free(i, aside_ned_[i], scene);
        orders[i] = {Order::Kind::kStepAside, stays ? aside_ned_[i] : place_aside(i, top, of, scene), of};
        break;
      }
      if (status != Status::kOnPath || orders[i].kind == Order::Kind::kStepAside) continue;
      for (double t = 0.0; t <= vehicles_[i].stop_s + RightOfWay::kCell_s; t += RightOfWay::kCell_s) {
        if (!in_column(i, vehicles_[i].path.at(progress_s_[i] + t), of, top, kMargin)) continue;
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
    const double spare_s = paused_[i] ? kSpare_s : 0.0;
    if (progress_s_[i] + vehicles_[i].stop_s + spare_s >= limit_s)
      orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), blocker};
  }
}

// Who is on the way back of vehicle i, above it, or comes there while it flies back: nobody, if it may go.
std::optional<std::size_t> FleetMonitor::blocker_of_way_back(std::size_t i, const Scene& scene,
                                                             const std::vector<Order>& orders,
                                                             double share) const {
  const std::vector<Eigen::Vector3d> way = way_back(i, scene.news[i]);
  const double length_m = (way.back() - scene.news[i].position_ned).norm();
  const double time_s = length_m / kBackSpeed + vehicles_[i].stop_s;
  for (std::size_t j = 0; j < vehicles_.size(); ++j) {
    if (j == i) continue;
    std::vector<Eigen::Vector3d> others = scene.places[j];
    // One that waits, perhaps for this one, comes no further.
    const double ahead_s = orders[j].kind == Order::Kind::kFly ? time_s : vehicles_[j].stop_s;
    for (double t = 0.0; scene.status[j] == Status::kOnPath && t <= ahead_s; t += RightOfWay::kCell_s)
      others.push_back(vehicles_[j].path.at(progress_s_[j] + t));
    const bool may_sink = scene.status[j] == Status::kOffPath || scene.status[j] == Status::kLost;
    for (const Eigen::Vector3d& place : way) {
      for (const Eigen::Vector3d& other : others) {
        if (may_sink ? in_column(i, place, j, other, share) : is_near(i, place, j, other, share)) return j;
      }
    }
  }
  return std::nullopt;
}

// Of a vehicle that the monitor has sent aside.
void FleetMonitor::send_back(std::size_t i, const Scene& scene, std::vector<Order>& orders) {
  const std::optional<std::size_t> blocker =
      blocker_of_way_back(i, scene, orders, way_[i] == Way::kBack ? kMargin : kBackMargin);
  way_[i] = blocker ? Way::kAside : Way::kBack;
  if (blocker) orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), *blocker};
}

std::vector<Order> FleetMonitor::step(double now_s, const std::vector<VehicleNews>& news) {
  const double elapsed_s = std::max(now_s - now_s_, 0.0);
  now_s_ = now_s;
  Scene scene{news, {}, {}};
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (news[i].age_s <= kLost_s && news[i].flies_plan) {
      if (way_[i] == Way::kBack)
        rejoin(i, news[i]);
      else
        follow(i, elapsed_s + 2.0 * kStep_s, news[i]);
    }
    scene.status.push_back(status_of(i, news[i]));
    const bool is_back = way_[i] == Way::kBack && scene.status[i] == Status::kOnPath;
    if (is_back || !news[i].flies_plan || news[i].rotors_off) way_[i] = Way::kPath;
    if (way_[i] == Way::kAside && scene.status[i] == Status::kOnPath) scene.status[i] = Status::kOffPath;
    scene.places.push_back(places_of(i, news[i], scene.status[i]));
  }
  std::vector<Order> orders(vehicles_.size());
  wait_for_late(scene, orders);
  for (std::size_t of = 0; of < vehicles_.size(); ++of) {
    if (scene.status[of] == Status::kOffPath || scene.status[of] == Status::kLost)
      keep_out_of_column(of, scene, orders);
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (orders[i].kind == Order::Kind::kStepAside) {
      if (way_[i] == Way::kPath) left_s_[i] = progress_s_[i];
      way_[i] = Way::kAside;
      aside_ned_[i] = orders[i].place_ned;
    } else if (way_[i] != Way::kPath && scene.status[i] == Status::kOffPath) {
      send_back(i, scene, orders);
    }
    paused_[i] = orders[i].kind == Order::Kind::kPause;
  }
  return orders;
}

}  // namespace swiftlet::ground
