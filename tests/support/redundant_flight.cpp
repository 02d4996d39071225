#include "tests/support/redundant_flight.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
namespace msg = comms::msg;
namespace topics = comms::topics;

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

std::array<double, 3> difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

constexpr double kSide_m = 2.0;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

RedundantFlight::RedundantFlight(const std::filesystem::path& folder, std::vector<std::string> plant_options,
                                 const comms::NodeSettings& network_settings)
    : folder_(folder),
      transport_(network_settings.transport),
      network_key_file_(network_settings.network_key_file),
      security_(network_settings.security),
      plant_(
          "swiftlet-plant",
          [&] {
            for (const std::string& word : network()) plant_options.push_back(word);
            return plant_options;
          }(),
          folder),
      mocap_("swiftlet-mocap", network(), folder),
      client_(node_settings("ground")),
      node_(node_settings("observer")) {
  const auto keep = [this](auto& samples, std::int64_t stamp_ns, const auto& sample) {
    const std::lock_guard<std::mutex> lock(mutex_);
    samples[stamp_ns] = sample;
  };
  subscriptions_.push_back(node_.subscribe<msg::Imu>(
      topics::kImu, [this, keep](const msg::Imu& message) { keep(imu_, message.stamp_ns(), message); }));
  subscriptions_.push_back(
      node_.subscribe<msg::GroundTruth>(topics::kGroundTruth, [this, keep](const msg::GroundTruth& message) {
        keep(truth_, message.stamp_ns(), Truth{message.position_ned(), norm(message.velocity_ned())});
      }));
  subscriptions_.push_back(node_.subscribe<msg::Reference>(
      topics::kReference,
      [this, keep](const msg::Reference& message) { keep(reference_, message.stamp_ns(), message); }));
  subscriptions_.push_back(node_.subscribe<msg::ControllerState>(
      topics::kControllerState, [this](const msg::ControllerState& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        states_[message.controller()] = {message, ground::Clock::now()};
      }));
}

std::vector<std::string> RedundantFlight::network() const {
  const char* const transport = transport_ == comms::Transport::kSharedMemory ? "shm" : "udp";
  std::vector<std::string> words = {"--domain", std::to_string(lock_.domain()), "--localhost-only",
                                    "--transport", transport};
  if (!network_key_file_.empty()) words.insert(words.end(), {"--network-key", network_key_file_});
  if (!security_.empty()) words.insert(words.end(), {"--security", security_});
  return words;
}

comms::NodeSettings RedundantFlight::node_settings(const char* name) const {
  comms::NodeSettings settings;
  settings.name = name;
  settings.domain = lock_.domain();
  settings.transport = transport_;
  settings.network_key_file = network_key_file_;
  settings.security = security_;
  settings.localhost_only = true;
  return settings;
}

std::unique_ptr<Program> RedundantFlight::launch_controller(int failover_priority) const {
  std::vector<std::string> words = network();
  words.insert(words.end(), {"--failover-priority", std::to_string(failover_priority)});
  return std::make_unique<Program>("swiftlet-control", words, folder_);
}

Controller& RedundantFlight::start_controller(int failover_priority) {
  const auto before = recent_states();
  controllers_.push_back(std::make_unique<Controller>());
  Controller& started = *controllers_.back();
  started.failover_priority = failover_priority;
  started.process = launch_controller(failover_priority);
  wait("the new controller sends its state", [&] {
    for (const auto& [id, state] : recent_states()) {
      if (before.count(id) > 0) continue;
      started.id = id;
      return true;
    }
    return false;
  });
  return started;
}

Controller& RedundantFlight::active() {
  std::uint64_t id = 0;
  wait("one controller is active", [&] {
    if (active_count() != 1) return false;
    for (const auto& [controller, state] : recent_states()) {
      if (state.role() == msg::ControllerState_Constants::ACTIVE) id = controller;
    }
    return true;
  });
  for (const auto& controller : controllers_) {
    if (controller->id == id) return *controller;
  }
  throw std::runtime_error("the active controller was not started here");
}

void RedundantFlight::kill(Controller& controller) {
  controller.process->signal(SIGKILL);
  controller.process->wait(5s);
  const auto gone = std::find_if(controllers_.begin(), controllers_.end(),
                                 [&](const auto& c) { return c.get() == &controller; });
  controllers_.erase(gone);
}

void RedundantFlight::stop_time() { plant_.signal(SIGSTOP); }
void RedundantFlight::resume_time() { plant_.signal(SIGCONT); }

std::map<std::uint64_t, msg::ControllerState> RedundantFlight::recent_states() const {
  const auto now = ground::Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  std::map<std::uint64_t, msg::ControllerState> recent;
  for (const auto& [id, state] : states_) {
    if (now - state.at < 500ms) recent[id] = state.message;
  }
  return recent;
}

int RedundantFlight::count(std::uint8_t role) const {
  const auto all = recent_states();
  return static_cast<int>(std::count_if(all.begin(), all.end(),
                                        [role](const auto& entry) { return entry.second.role() == role; }));
}
int RedundantFlight::active_count() const { return count(msg::ControllerState_Constants::ACTIVE); }
int RedundantFlight::standby_count() const { return count(msg::ControllerState_Constants::STANDBY); }

void RedundantFlight::wait(const char* what, const std::function<bool()>& predicate) const {
  if (!eventually(predicate)) throw std::runtime_error(std::string("timed out: ") + what);
}

void RedundantFlight::wait_for_roles(int active, int standby) const {
  wait("controllers have their roles", [&] {
    const auto all = recent_states();
    const bool ready = std::all_of(all.begin(), all.end(), [](const auto& c) { return c.second.ready(); });
    return ready && active_count() == active && standby_count() == standby;
  });
}

void RedundantFlight::ask(std::uint8_t kind, double z_ned) {
  msg::Command command;
  command.kind(kind);
  command.position_ned({0.0, 0.0, z_ned});
  command.yaw_free(true);
  command.speed(1.2);
  const auto give_up = ground::Clock::now() + 20s;
  ground::Result answer;
  do {
    answer = client_.command(command, 5s);
    // At start, requests are refused until a pose and a battery sample arrive: repeat them.
  } while (!answer.accepted() && ground::Clock::now() < give_up);
  if (!answer.accepted()) throw std::runtime_error(answer.reason);
}

void RedundantFlight::fly(const control::Mission& mission) {
  ask(msg::Command_Constants::ARM);
  const ground::Result answer = client_.upload(mission, 10s);
  if (!answer.accepted()) throw std::runtime_error(answer.reason);
  ask(msg::Command_Constants::MISSION_START);
}

std::int64_t RedundantFlight::stamp_ns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return imu_.empty() ? 0 : imu_.rbegin()->first;
}

double RedundantFlight::speed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return truth_.empty() ? 0.0 : truth_.rbegin()->second.speed;
}

double RedundantFlight::z_ned() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return truth_.empty() ? 0.0 : truth_.rbegin()->second.position_ned[2];
}

std::optional<double> RedundantFlight::deviation_m(std::int64_t stamp_ns) const {
  const auto truth = truth_.find(stamp_ns);
  const auto reference = reference_.find(stamp_ns);
  if (truth == truth_.end() || reference == reference_.end()) return std::nullopt;
  return norm(difference(truth->second.position_ned, reference->second.position_ned()));
}

FlightMetrics RedundantFlight::metrics(std::int64_t from_ns, std::int64_t to_ns,
                                       std::int64_t period_ns) const {
  constexpr std::int64_t kMargin_ns = 50'000'000;  // for telemetry that arrives late
  wait("the vehicle's time passes", [&] { return stamp_ns() > to_ns + kMargin_ns; });
  const std::lock_guard<std::mutex> lock(mutex_);
  FlightMetrics metrics;
  std::uint32_t term = 0;
  for (auto imu = imu_.lower_bound(from_ns); imu != imu_.upper_bound(to_ns); ++imu) {
    ++metrics.samples;
    const auto gap_ns = imu->first - imu->second.command_stamp_ns();
    metrics.longest_gap_ms = std::max(metrics.longest_gap_ms, seconds(gap_ns) * 1e3);
    if (term != 0 && imu->second.command_term() != term) ++metrics.changes_of_controller;
    term = imu->second.command_term();
  }
  const msg::Reference* last = nullptr;
  for (auto reference = reference_.lower_bound(from_ns); reference != reference_.upper_bound(to_ns);
       ++reference) {
    const msg::Reference& now = reference->second;
    const std::optional<double> deviation = deviation_m(reference->first);
    const std::optional<double> usual = deviation_m(reference->first - period_ns);
    if (deviation) metrics.largest_deviation_m = std::max(metrics.largest_deviation_m, *deviation);
    if (deviation && usual)
      metrics.extra_deviation_m = std::max(metrics.extra_deviation_m, *deviation - *usual);
    if (last != nullptr) {
      const double passed_s = seconds(now.stamp_ns() - last->stamp_ns());
      std::array<double, 3> step = difference(now.position_ned(), last->position_ned());
      for (std::size_t i = 0; i < 3; ++i) step[i] -= last->velocity_ned()[i] * passed_s;
      metrics.largest_step_m = std::max(metrics.largest_step_m, norm(step));
    }
    last = &now;
  }
  metrics.lowest_z_ned = -1e9;
  for (auto truth = truth_.lower_bound(from_ns); truth != truth_.upper_bound(to_ns); ++truth)
    metrics.lowest_z_ned = std::max(metrics.lowest_z_ned, truth->second.position_ned[2]);
  return metrics;
}

control::Mission square_laps(double speed, int laps) {
  using control::MissionItemKind;
  const double z = -1.0;
  control::Mission mission;
  mission.items.push_back({MissionItemKind::kTakeoff, {0.0, 0.0, z}, 0.0, true, 0.5, 0.0});
  for (int lap = 0; lap < laps; ++lap) {
    for (const auto& [x, y] : {std::pair{kSide_m, 0.0}, {kSide_m, kSide_m}, {0.0, kSide_m}, {0.0, 0.0}})
      mission.items.push_back({MissionItemKind::kWaypoint, {x, y, z}, 0.0, true, speed, 0.0});
  }
  mission.items.push_back({MissionItemKind::kLand, {0.0, 0.0, 0.0}, 0.0, true, 0.5, 0.0});
  return mission;
}

std::int64_t side_ns(double speed) {
  return std::llround(1e9 * control::minimum_jerk_duration(kSide_m, speed,
                                                           control::Limits().max_reference_acceleration,
                                                           control::Limits().max_reference_jerk));
}

}  // namespace swiftlet::tests
