#include "tests/support/redundant_flight.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
namespace msg = messages::msg;
namespace topics = messages::topics;

}  // namespace

RedundantFlight::RedundantFlight(const std::filesystem::path& folder,
                                 const std::vector<std::string>& plant_options,
                                 const dds::NodeSettings& network_settings,
                                 const std::vector<std::string>& mocap_options)
    : folder_(folder),
      network_key_file_(network_settings.network_key_file),
      security_(network_settings.security),
      plant_("swiftlet-plant", on_network(plant_options), folder),
      mocap_("swiftlet-mocap", on_network(mocap_options), folder),
      client_(node_settings("ground")),
      node_(node_settings("observer")),
      samples_(node_),
      controller_states_(node_.subscribe<msg::ControllerState>(
          topics::kControllerState, [this](const msg::ControllerState& message) {
            const std::lock_guard<std::mutex> lock(mutex_);
            states_[message.controller()] = {message, ground::Clock::now()};
          })) {}

std::vector<std::string> RedundantFlight::network() const {
  std::vector<std::string> words = {"--domain", std::to_string(lock_.domain()), "--localhost-only"};
  if (!network_key_file_.empty()) words.insert(words.end(), {"--network-key", network_key_file_});
  if (!security_.empty()) words.insert(words.end(), {"--security", security_});
  return words;
}

std::vector<std::string> RedundantFlight::on_network(std::vector<std::string> words) const {
  for (const std::string& word : network()) words.push_back(word);
  return words;
}

dds::NodeSettings RedundantFlight::node_settings(const char* name) const {
  dds::NodeSettings settings;
  settings.name = name;
  settings.domain = lock_.domain();
  settings.network_key_file = network_key_file_;
  settings.security = security_;
  settings.localhost_only = true;
  return settings;
}

std::unique_ptr<Program> RedundantFlight::launch_controller(int failover_priority) const {
  return std::make_unique<Program>(
      "swiftlet-control", on_network({"--failover-priority", std::to_string(failover_priority)}), folder_);
}

Controller& RedundantFlight::start_controller(int failover_priority) {
  const std::set<std::uint64_t> before = known_ids();
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

std::set<std::uint64_t> RedundantFlight::known_ids() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::set<std::uint64_t> ids;
  for (const auto& [id, state] : states_) ids.insert(id);
  return ids;
}

int RedundantFlight::count(std::uint8_t role) const {
  const auto all = recent_states();
  return static_cast<int>(std::count_if(all.begin(), all.end(),
                                        [role](const auto& entry) { return entry.second.role() == role; }));
}
int RedundantFlight::active_count() const { return count(msg::ControllerState_Constants::ACTIVE); }
int RedundantFlight::standby_count() const { return count(msg::ControllerState_Constants::STANDBY); }

void RedundantFlight::wait(const char* what, const std::function<bool()>& predicate) const {
  if (eventually(predicate)) return;
  const ground::View view = client_.view();
  const msg::ControlStatus& status = view.control.message;
  throw std::runtime_error(
      fmt::format("timed out: {}; the ground has mode {} ({}), {:.1f} s old, at z {:.2f} m, {:.1f} s old",
                  what, control::to_string(static_cast<control::Mode>(status.mode())),
                  status.reason().c_str(), view.control.age_s(ground::Clock::now()),
                  view.truth.message.position_ned()[2], view.truth.age_s(ground::Clock::now())));
}

void RedundantFlight::wait_for_roles(int active, int standby) const {
  wait("controllers have their roles", [&] {
    const auto all = recent_states();
    const bool ready = std::all_of(all.begin(), all.end(), [](const auto& c) { return c.second.ready(); });
    return ready && active_count() == active && standby_count() == standby;
  });
}

void RedundantFlight::ask(control::RequestKind kind, double z_ned) {
  control::Request request;
  request.kind = kind;
  request.position_ned.z() = z_ned;
  request.speed = 1.2;
  const auto give_up = ground::Clock::now() + 20s;
  ground::Result answer;
  do {
    answer = client_.request(request, 5s);
    // At start, requests are refused until a pose and a battery sample arrive: repeat them.
  } while (!answer.accepted() && ground::Clock::now() < give_up);
  if (!answer.accepted()) throw std::runtime_error(answer.reason);
}

void RedundantFlight::fly(const control::Mission& mission) {
  ask(control::RequestKind::kArm);
  const ground::Result answer = client_.upload(mission, 10s);
  if (!answer.accepted()) throw std::runtime_error(answer.reason);
  ask(control::RequestKind::kMissionStart);
}

FlightMetrics RedundantFlight::metrics(std::int64_t from_ns, std::int64_t to_ns,
                                       std::int64_t period_ns) const {
  constexpr std::int64_t kMargin_ns = 50'000'000;  // for telemetry that arrives late
  wait("the vehicle's time passes", [&] { return stamp_ns() > to_ns + kMargin_ns; });
  return samples_.metrics(from_ns, to_ns, period_ns);
}

}  // namespace swiftlet::tests
