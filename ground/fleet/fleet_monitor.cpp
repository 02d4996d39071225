#include "swiftlet/ground/fleet/fleet_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace swiftlet::ground {
namespace {

constexpr double kStep_s = 0.01;          // with which a path is searched for the reference
constexpr double kOffPath_m = 0.1;        // the reference of a vehicle on its path is nearer to it
constexpr double kOffReference_m = 0.25;  // the vehicle does not follow its reference
constexpr double kLost_s = 0.5;           // without news
constexpr double kFailsafe_s = 3.0;  // until a lost vehicle has left its path for good, by its own failsafe
constexpr double kSpare_s = 4.0 * RightOfWay::kCell_s;  // one that stands goes on only if it can fly so long
constexpr double kAside = 1.5;  // a vehicle steps aside to this clearance of the column

}  // namespace

FleetMonitor::FleetMonitor(std::vector<MonitoredVehicle> vehicles)
    : vehicles_(std::move(vehicles)),
      right_of_way_(std::vector<RightOfWay::Vehicle>(vehicles_.begin(), vehicles_.end())),
      progress_s_(vehicles_.size(), 0.0),
      paused_(vehicles_.size(), false) {}

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
  const double to_s = std::max(std::min({from_s + elapsed_s, now_s_ + kStep_s, path.duration_s()}), from_s);
  double best_s = from_s;
  double best_m = (path.at(from_s) - news.reference_ned).norm();
  for (double t = from_s; t <= to_s + 0.5 * kStep_s; t += kStep_s) {
    const double s = std::min(t, to_s);
    const double off_m = (path.at(s) - news.reference_ned).norm();
    if (off_m > best_m + 1e-6) continue;
    best_m = off_m;
    best_s = s;
  }
  if (best_m < kOffPath_m) progress_s_[i] = best_s;
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

// Where a vehicle may be: a lost one may have flown on along its path until its failsafe brought it down.
std::vector<Eigen::Vector3d> FleetMonitor::places_of(std::size_t i, const VehicleNews& news) const {
  std::vector<Eigen::Vector3d> places = {news.position_ned};
  if (news.age_s <= kLost_s || !news.flies_plan) return places;
  const double ahead_s = std::min(news.age_s, kFailsafe_s) + vehicles_[i].stop_s;
  for (double t = 0.0; t <= ahead_s; t += RightOfWay::kCell_s)
    places.push_back(vehicles_[i].path.at(progress_s_[i] + t));
  return places;
}

// Whether a vehicle at this place touches the ellipsoid of another one, enlarged by `share`, that is at top_ned or sinks
// from there.
bool FleetMonitor::in_column(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                             const Eigen::Vector3d& top_ned, double share) const {
  const Eigen::Vector3d nearest(top_ned.x(), top_ned.y(), std::max(place_ned.z(), top_ned.z()));
  return clearance(vehicles_[i].around, vehicles_[of].around, nearest - place_ned) < share;
}

void FleetMonitor::keep_out_of_column(std::size_t of, const std::vector<VehicleNews>& news,
                                      const std::vector<Status>& status, std::vector<Order>& orders) const {
  const std::vector<Eigen::Vector3d> tops = places_of(of, news[of]);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (i == of || status[i] == Status::kDown || status[i] == Status::kLost || news[i].rotors_off) continue;
    const bool yields = status[i] == Status::kOnPath || status[of] == Status::kLost ||
                        vehicles_[i].priority < vehicles_[of].priority ||
                        (vehicles_[i].priority == vehicles_[of].priority && i > of);
    if (!yields) continue;
    for (const Eigen::Vector3d& top : tops) {
      if (in_column(i, news[i].position_ned, of, top, 1.0)) {
        Eigen::Vector2d away = (news[i].position_ned - top).head<2>();
        if (away.norm() < 1e-3) away = Eigen::Vector2d::UnitX();
        const double reach_m = vehicles_[i].around.radius_xy_m + vehicles_[of].around.radius_xy_m;
        orders[i] = {Order::Kind::kStepAside, news[i].position_ned, of};
        orders[i].place_ned.head<2>() = top.head<2>() + kAside * reach_m * away.normalized();
        break;
      }
      if (status[i] != Status::kOnPath || orders[i].kind == Order::Kind::kStepAside) continue;
      for (double t = 0.0; t <= vehicles_[i].stop_s + RightOfWay::kCell_s; t += RightOfWay::kCell_s) {
        if (!in_column(i, vehicles_[i].path.at(progress_s_[i] + t), of, top, 1.1)) continue;
        orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), of};
        break;
      }
    }
  }
}

std::vector<Order> FleetMonitor::step(double now_s, const std::vector<VehicleNews>& news) {
  const double elapsed_s = std::max(now_s - now_s_, 0.0);
  now_s_ = now_s;
  std::vector<Status> status;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (news[i].age_s <= kLost_s && news[i].flies_plan) follow(i, elapsed_s + 2.0 * kStep_s, news[i]);
    status.push_back(status_of(i, news[i]));
  }
  // Nobody waits for one that will not come: it is in the way where it is.
  std::vector<double> awaited_s = progress_s_;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (status[i] == Status::kOffPath && news[i].rotors_off) awaited_s[i] = vehicles_[i].path.duration_s();
  }
  std::vector<Order> orders(vehicles_.size());
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (status[i] != Status::kOnPath) continue;
    std::size_t blocker = 0;
    const double limit_s = right_of_way_.limit_s(i, awaited_s, blocker);
    const double spare_s = paused_[i] ? kSpare_s : 0.0;
    if (progress_s_[i] + vehicles_[i].stop_s + spare_s >= limit_s)
      orders[i] = {Order::Kind::kPause, Eigen::Vector3d::Zero(), blocker};
  }
  for (std::size_t of = 0; of < vehicles_.size(); ++of) {
    if (status[of] == Status::kOffPath || status[of] == Status::kLost)
      keep_out_of_column(of, news, status, orders);
  }
  for (std::size_t i = 0; i < vehicles_.size(); ++i) paused_[i] = orders[i].kind == Order::Kind::kPause;
  return orders;
}

}  // namespace swiftlet::ground
