#include "tests/soak/partition_flight.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/network_relay.hpp"
#include "tests/support/redundant_flight.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using tests::eventually;
using Clock = std::chrono::steady_clock;
using ControlMode = control::Mode;
namespace msg = comms::msg;

constexpr double kSpeed = 1.0;  // m/s, of the mission
constexpr int kLaps = 5;
constexpr auto kFliesOn = 4s;  // after the cut: long enough for every failsafe
constexpr auto kComesDown = 20s;
constexpr auto kHeals = 20s;
constexpr double kFall_m_s = 1.0;  // faster than any descent

using Host = NetworkFlight::Host;
constexpr std::array<const char*, 4> kHostNames{"vehicle", "control", "ground", "mocap"};

constexpr std::array<int, 4> kCuts_ms{50, 300, 1000, 5000};

std::vector<Partition> all_partitions() {
  using Outcomes = std::array<Outcome, kCuts_ms.size()>;
  constexpr Outcome kOn = Outcome::kFliesOn;
  constexpr Outcome kHolds = Outcome::kHolds;
  constexpr Outcome kLands = Outcome::kLands;
  constexpr Outcome kFalls = Outcome::kFalls;
  struct Row {
    Host from, to;
    bool standby;
    Outcomes outcomes;
  };
  const std::vector<Row> rows{
      {NetworkFlight::kVehicle, NetworkFlight::kControl, false, {kOn, kFalls, kFalls, kFalls}},
      {NetworkFlight::kVehicle, NetworkFlight::kControl, true, {kOn, kOn, kOn, kOn}},
      {NetworkFlight::kControl, NetworkFlight::kGround, false, {kOn, kOn, kLands, kLands}},
      {NetworkFlight::kControl, NetworkFlight::kGround, true, {kOn, kOn, kLands, kLands}},
      {NetworkFlight::kVehicle, NetworkFlight::kMocap, false, {kOn, kOn, kHolds, kLands}},
      {NetworkFlight::kVehicle, NetworkFlight::kMocap, true, {kOn, kOn, kHolds, kLands}},
  };
  std::vector<Partition> all;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kCuts_ms.size(); ++i)
      all.push_back({row.from, row.to, kCuts_ms[i], row.standby, row.outcomes[i]});
  }
  return all;
}

std::unique_ptr<ground::Client> client_on(const tests::HostNetwork& network, Host host, const char* name) {
  const tests::HostNetwork::Inside inside(network, host);
  comms::NodeSettings settings;
  settings.name = name;
  return std::make_unique<ground::Client>(settings);
}

class PartitionFlight {
 public:
  PartitionFlight(const Partition& partition, const std::filesystem::path& folder)
      : partition_(partition),
        hosts_(folder),
        from_(hosts_.network(), partition.from, {}),
        to_(hosts_.network(), partition.to, {}) {
    hosts_.start(1, {}, NetworkFlight::kMocap);
    observer_ = client_on(hosts_.network(), NetworkFlight::kVehicle, "observer");
    observer_->hear_controllers();
    require(eventually([this] { return ready_controllers() == 1 && control().controller() != 0; },
                       tests::kStuck, 20ms),
            "control is ready");
    controller_ = control().controller();
    if (partition.standby) hosts_.start_standby();
    pilot_ = client_on(hosts_.network(), NetworkFlight::kGround, "pilot");
  }

  PartitionResult fly() {
    take_off();
    PartitionResult result;
    result.had_priority = control().realtime_scheduling();
    cut(result);
    result.outcome = outcome(result);
    result.reason = control().reason().c_str();
    result.standby_took_over = result.standby_took_over || standby_flies();
    result.healed = eventually([this] { return healed(); }, kHeals, 20ms);
    result.priority_kept = control().realtime_scheduling() == result.had_priority;
    return result;
  }

 private:
  void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string(what) + ": no");
  }
  msg::ControlStatus control() const { return observer_->view().control.message; }
  bool standby_flies() const { return control().controller() != controller_; }
  ControlMode mode() const { return static_cast<ControlMode>(control().mode()); }

  void take_off() {
    const std::size_t controllers = partition_.standby ? 2 : 1;
    require(
        eventually(
            [&] { return ready_controllers() == controllers && pilot_->view().control.message.has_pose(); },
            tests::kStuck, 20ms),
        "all controllers are ready");
    pilot_->enable_link_loss_failsafe();
    require(eventually([this] { return begins_mission(); }, tests::kStuck, 200ms), "it begins the mission");
    require(eventually(
                [this] {
                  const auto& truth = observer_->view().truth.message;
                  const auto& v = truth.velocity_ned();
                  return truth.position_ned()[2] < -0.98 && std::hypot(v[0], v[1]) > 0.5;
                },
                tests::kStuck, 5ms),
            "it flies the mission");
  }

  // Each request may be refused while the standby takes over on a busy machine.
  bool begins_mission() {
    msg::Command arm;
    arm.kind(msg::Command_Constants::ARM);
    return pilot_->command(arm, 5s).accepted() &&
           pilot_->upload(tests::square_laps(kSpeed, kLaps), 10s).accepted() &&
           pilot_->mission_command(msg::Command_Constants::MISSION_START, pilot_->mission_id(), 10s)
               .accepted();
  }

  // Ready ones that report within 0.5 s.
  std::size_t ready_controllers() const {
    const ground::View view = observer_->view();
    const auto now = ground::Clock::now();
    return static_cast<std::size_t>(
        std::count_if(view.controllers.begin(), view.controllers.end(), [&](const auto& controller) {
          return controller.second.message.ready() && controller.second.age_s(now) < 0.5;
        }));
  }

  void note(PartitionResult& result) {
    const ground::View view = observer_->view();
    const auto& truth = view.truth.message;
    fastest_fall_m_s_ = std::max(fastest_fall_m_s_, truth.velocity_ned()[2]);
    if (mode() != ControlMode::kMission) return;
    const auto& reference = view.reference.message;
    const double off_m = std::hypot(truth.position_ned()[0] - reference.position_ned()[0],
                                    truth.position_ned()[1] - reference.position_ned()[1],
                                    truth.position_ned()[2] - reference.position_ned()[2]);
    result.deviation_m = std::max(result.deviation_m, off_m);
  }

  void cut(PartitionResult& result) {
    const auto end = Clock::now() + std::chrono::milliseconds(partition_.cut_ms);
    from_.block(hosts_.network().address(partition_.to));
    to_.block(hosts_.network().address(partition_.from));
    eventually(
        [&] {
          note(result);
          return Clock::now() >= end;
        },
        10s, 2ms);
    result.standby_took_over = standby_flies();  // on a busy machine the controller may take over again
    from_.unblock();
    to_.unblock();
  }

  std::optional<Outcome> outcome(PartitionResult& result) {
    const auto healed = Clock::now();
    std::optional<Outcome> outcome;
    eventually(
        [&] {
          note(result);
          const auto& truth = observer_->view().truth.message;
          if (truth.on_ground()) {
            outcome = fastest_fall_m_s_ > kFall_m_s ? Outcome::kFalls : Outcome::kLands;
          } else if (Clock::now() - healed > kFliesOn) {
            if (mode() == ControlMode::kMission) outcome = Outcome::kFliesOn;
            if (mode() == ControlMode::kHolding) outcome = Outcome::kHolds;
          }
          return outcome.has_value();
        },
        kComesDown, 5ms);
    return outcome;
  }

  // Vehicle and ground hear control, and the controllers hear poses.
  bool healed() const {
    const auto now = ground::Clock::now();
    const auto is_fresh = [&](const ground::View& view) {
      return view.control.seen() && view.control.age_s(now) < 0.5 && view.truth.age_s(now) < 0.5;
    };
    const std::size_t controllers = partition_.standby ? 2 : 1;
    return is_fresh(observer_->view()) && is_fresh(pilot_->view()) &&
           ground::controllers_of(observer_->view(), now).count() >= static_cast<int>(controllers) &&
           control().mocap_age_s() >= 0.0 && control().mocap_age_s() < 0.5;
  }

  const Partition partition_;
  NetworkFlight hosts_;
  tests::NetworkRelay from_, to_;
  std::unique_ptr<ground::Client> observer_, pilot_;
  std::uint64_t controller_ = 0;  // not the standby
  double fastest_fall_m_s_ = 0.0;
};

}  // namespace

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFliesOn:
      return "flies on";
    case Outcome::kHolds:
      return "holds";
    case Outcome::kLands:
      return "lands";
    case Outcome::kFalls:
      return "falls";
  }
  return "";
}

std::string Partition::name() const {
  return fmt::format("{} - {}, {} ms, {} standby", kHostNames.at(from), kHostNames.at(to), cut_ms,
                     standby ? "with" : "no");
}

const std::vector<Partition>& partitions() {
  static const std::vector<Partition> all = all_partitions();
  return all;
}

PartitionResult fly_through(const Partition& partition, const std::filesystem::path& folder) {
  return PartitionFlight(partition, folder).fly();
}

}  // namespace swiftlet::soak
