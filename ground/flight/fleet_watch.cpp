#include "swiftlet/ground/flight/fleet_watch.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 40ms;
constexpr auto kRequestTimeout = 200ms;
constexpr double kAsideSpeed = 0.8;  // m/s

Eigen::Vector3d vector(const std::array<double, 3>& in) { return {in[0], in[1], in[2]}; }

bool is_of_flight(const Client& client, const View& view) {
  return view.mission.message.mission_id() == client.mission_id();
}

bool runs(const Client& client, const View& view) {
  return is_of_flight(client, view) && view.mission.message.state() == msg::MissionStatus_Constants::RUNNING;
}

bool is_paused(const Client& client, const View& view) {
  return is_of_flight(client, view) && view.mission.message.state() == msg::MissionStatus_Constants::PAUSED;
}

}  // namespace

FleetWatch::FleetWatch(FleetMonitor monitor, std::vector<Watched> vehicles)
    : monitor_(std::move(monitor)),
      vehicles_(std::move(vehicles)),
      carried_out_(vehicles_.size()),
      task_(kPeriod, [this] { step(); }) {}

VehicleNews FleetWatch::news_of(std::size_t i, const View& view, Clock::time_point now) const {
  const Client& client = *vehicles_[i].client;
  const auto mode = static_cast<control::Mode>(view.control.message.mode());
  VehicleNews news;
  news.reference_ned = vector(view.reference.message.position_ned());
  news.position_ned = vector(view.estimate.message.position_ned());
  news.age_s = std::max(view.estimate.age_s(now), view.reference.age_s(now));
  news.flies_plan =
      is_of_flight(client, view) && view.mission.message.state() != msg::MissionStatus_Constants::ABORTED;
  news.rotors_off = control::rotors_off(mode);
  return news;
}

void FleetWatch::carry_out(std::size_t i, const Order& order, const View& view) {
  Order& last = carried_out_[i];
  if (order.kind == last.kind) return;
  Client& client = *vehicles_[i].client;
  const auto mission = [&](std::uint8_t kind) {
    return client.mission_command(kind, client.mission_id(), kRequestTimeout).accepted();
  };
  const auto say = [&](const std::string& what) {
    vehicles_[i].progress->say(what + " " + vehicles_[order.because_of].client->vehicle());
  };
  if (order.kind == Order::Kind::kFly) {
    if (is_paused(client, view) && !mission(msg::Command_Constants::MISSION_RESUME)) return;
    vehicles_[i].progress->say("goes on");
    last = order;
    return;
  }
  if (runs(client, view) && !mission(msg::Command_Constants::MISSION_PAUSE)) return;
  if (order.kind == Order::Kind::kStepAside) {
    msg::Command aside;
    aside.kind(msg::Command_Constants::GOTO);
    aside.position_ned({order.place_ned.x(), order.place_ned.y(), order.place_ned.z()});
    aside.yaw_free(true);
    aside.speed(kAsideSpeed);
    if (!client.command(aside, kRequestTimeout).accepted()) return;
  }
  say(order.kind == Order::Kind::kPause ? "waits for" : "steps aside for");
  last = order;
}

void FleetWatch::step() {
  const auto now = Clock::now();
  std::vector<View> views;
  for (const Watched& vehicle : vehicles_) views.push_back(vehicle.client->view());
  if (!start_) {
    bool started = false;
    for (std::size_t i = 0; i < vehicles_.size(); ++i)
      started = started || runs(*vehicles_[i].client, views[i]);
    if (!started) return;
    start_ = now;
  }
  std::vector<VehicleNews> news;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) news.push_back(news_of(i, views[i], now));
  const std::vector<Order> orders = monitor_.step(std::chrono::duration<double>(now - *start_).count(), news);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const bool answers = news[i].age_s < 0.2 && news[i].flies_plan && !news[i].rotors_off;
    if (answers) carry_out(i, orders[i], views[i]);
  }
}

}  // namespace swiftlet::ground
