#include "swiftlet/ground/fleet/fleet_watch.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 40ms;
constexpr double kHeard_s = 0.2;  // of a vehicle that is told to fly on

bool is_of_flight(const Client& client, const View& view) {
  return view.mission.message.mission_id() == client.mission_id();
}

bool runs(const Client& client, const View& view) {
  return is_of_flight(client, view) && view.mission.message.state() == msg::MissionStatus_Constants::RUNNING;
}

VehicleNews news_of(const Client& client, const View& view, Clock::time_point now) {
  const auto mode = static_cast<control::Mode>(view.control.message.mode());
  VehicleNews news;
  news.reference_ned = messages::wire::vector(view.reference.message.position_ned());
  news.position_ned = messages::wire::vector(view.estimate.message.position_ned());
  news.age_s = std::max(view.estimate.age_s(now), view.reference.age_s(now));
  news.flies_plan =
      is_of_flight(client, view) && view.mission.message.state() != msg::MissionStatus_Constants::ABORTED;
  news.rotors_off = control::rotors_off(mode);
  return news;
}

}  // namespace

FleetWatch::FleetWatch(FleetMonitor monitor, std::vector<WatchedVehicle> vehicles,
                       std::function<bool()> gives_up)
    : monitor_(std::move(monitor)),
      vehicles_(std::move(vehicles)),
      gives_up_(std::move(gives_up)),
      task_(kPeriod, [this] { step(); }) {}

void FleetWatch::step() {
  if (gives_up_()) return;
  if (senders_.empty()) {
    for (const WatchedVehicle& vehicle : vehicles_)
      senders_.emplace_back(vehicle.client, *vehicle.progress, gives_up_);
  }
  const auto now = Clock::now();
  std::vector<View> views;
  for (const WatchedVehicle& vehicle : vehicles_) views.push_back(vehicle.client->view());
  if (!start_) {
    bool started = false;
    for (std::size_t i = 0; i < vehicles_.size(); ++i)
      started = started || runs(*vehicles_[i].client, views[i]);
    if (!started) return;
    start_ = now;
  }
  std::vector<VehicleNews> news;
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    news.push_back(news_of(*vehicles_[i].client, views[i], now));
  const std::vector<Order> orders = monitor_.step(std::chrono::duration<double>(now - *start_).count(), news);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!news[i].flies_plan || news[i].rotors_off) continue;
    // Nobody is told to fly on who is not heard: what it does is not known.
    if (orders[i].kind == Order::Kind::kFly && news[i].age_s > kHeard_s) continue;
    senders_[i].give(orders[i], vehicles_[orders[i].because_of].client->vehicle());
  }
}

}  // namespace swiftlet::ground
