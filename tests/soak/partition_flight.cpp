#include "tests/soak/partition_flight.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/network/network_relay.hpp"
#include "tests/support/refusals.hpp"
#include "tests/support/stall_witness.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using tests::eventually;
using ControlMode = control::Mode;
namespace msg = messages::msg;

constexpr double kSpeed = 1.0;  // m/s, of the mission
constexpr int kLaps = 20;
constexpr std::int64_t kFailsafes_ns = 1'500'000'000;  // after the cut: longer than each of them waits
constexpr auto kComesDown = 20s;
constexpr auto kHeals = 20s;
constexpr double kStandbyWaits_ms = 25.0;
constexpr double kObeys_ms = 200.0;  // the vehicle, its last command
// A standby waits for 25 ms, and the vehicle obeys it with the next sample. The rest is room for the threads that send and
// receive in turn on a computer that is busy.
constexpr double kTakeover_ms = 60.0;
constexpr int kVehiclePriority = 60;  // of the thread of swiftlet-plant that takes the commands
constexpr std::int64_t kSample_ns = 2'000'000;
constexpr double kFall_m_s = 1.0;  // faster than any descent

using Host = NetworkFlight::Host;
constexpr std::array<const char*, 4> kHostNames{"vehicle", "control", "ground", "mocap"};

std::vector<Partition> all_partitions() {
  constexpr Outcome kOn = Outcome::kFliesOn;
  constexpr Outcome kHolds = Outcome::kHolds;
  constexpr Outcome kLands = Outcome::kLands;
  constexpr Outcome kFalls = Outcome::kFalls;
  constexpr Host kVehicle = NetworkFlight::kVehicle;
  constexpr Host kControl = NetworkFlight::kControl;
  constexpr Host kGround = NetworkFlight::kGround;
  constexpr Host kMocap = NetworkFlight::kMocap;
  constexpr double kOffPath_m = 0.05;
  constexpr double kPath_m = 1.5;  // stops, lands or falls from 1 m/s
  const std::vector<Cut> ground_cuts{{50, kOn, "", kOffPath_m},
                                     {300, kOn, "", kOffPath_m},
                                     {1000, kLands, "ground link lost, landed", kPath_m},
                                     {5000, kLands, "ground link lost, landed", kPath_m}};
  const std::vector<Cut> mocap_cuts{{50, kOn, "", kOffPath_m},
                                    {300, kOn, "", kOffPath_m},
                                    {1000, kHolds, "no mocap pose, pose regained", kPath_m},
                                    {5000, kLands, "no mocap pose, landed without position", kPath_m}};
  const std::vector<Cut> no_effect{{50, kOn, "", kOffPath_m},
                                   {300, kOn, "", kOffPath_m},
                                   {1000, kOn, "", kOffPath_m},
                                   {5000, kOn, "", kOffPath_m}};
  return {
      {kVehicle,
       kControl,
       false,
       false,
       kObeys_ms,
       {{50, kOn, "", kOffPath_m},
        {300, kFalls, "IMU samples were missing", kPath_m},
        {1000, kFalls, "IMU samples were missing", kPath_m},
        {5000, kFalls, "IMU samples were missing", kPath_m}}},
      {kVehicle, kControl, true, true, kTakeover_ms, no_effect},
      {kControl, kGround, false, false, kObeys_ms, ground_cuts},
      {kControl, kGround, true, false, kObeys_ms, ground_cuts},
      {kVehicle, kMocap, false, false, kObeys_ms, mocap_cuts},
      {kVehicle, kMocap, true, false, kObeys_ms, mocap_cuts},
      {kMocap, kControl, false, false, kObeys_ms, mocap_cuts},
      {kMocap, kControl, true, false, kObeys_ms, mocap_cuts},
      {kVehicle, kGround, false, false, kObeys_ms, no_effect},
  };
}

std::unique_ptr<ground::Client> client_on(const tests::HostNetwork& network, Host host, const char* name) {
  const tests::HostNetwork::Inside inside(network, host);
  dds::NodeSettings settings;
  settings.name = name;
  settings.open_network = true;
  return std::make_unique<ground::Client>(settings);
}

class PartitionFlight {
 public:
  PartitionFlight(const std::vector<Partition>& rows, const std::filesystem::path& folder)
      : hosts_(folder), cores_(kSample_ns, kVehiclePriority) {
    for (const Partition& row : rows) {
      for (const Host host : {row.from, row.to}) {
        auto& cable = cables_.at(host);
        if (!cable)
          cable = std::make_unique<tests::NetworkRelay>(hosts_.network(), host, tests::CableConditions{});
      }
    }
    hosts_.start(1, {}, NetworkFlight::kMocap);
    observer_ = client_on(hosts_.network(), NetworkFlight::kVehicle, "observer");
    observer_->hear_controllers();
    samples_ = std::make_unique<tests::FlightSamples>(observer_->node());
    wait("control is ready", [this] { return ready_controllers() == 1 && status().controller() != 0; });
    controller_ = status().controller();
    pilot_ = client_on(hosts_.network(), NetworkFlight::kGround, "pilot");
    wait("control has poses", [this] { return pilot_->view().control.message.has_pose(); });
    pilot_->enable_link_loss_failsafe();
  }

  CutResult make(const Partition& row, const Cut& cut) {
    if (row.standby && standby_ == nullptr) start_standby();
    cores_.take_longest_ns();  // also before the cut: the standby waits for as long as commands needed lately
    const auto flies = [this] { return mode() == ControlMode::kMission && !standby_flies(); };
    const auto flies_side = [this] { return samples_->z_ned() < -0.98 && samples_->speed() > 0.5; };
    do {
      if (standby_flies()) give_back();
      if (mode() != ControlMode::kMission) begin_mission();
      wait("it flies a side", [&] { return !flies() || flies_side(); });
    } while (!flies() || !flies_side());
    CutResult result;
    result.had_priority = status().realtime_scheduling();
    const std::int64_t from_ns = samples_->stamp_ns();
    result.outcome = outcome_of(row, cut, result.reasons);
    result.core_stood_still_ms = 1e-6 * static_cast<double>(cores_.take_longest_ns());
    result.metrics = samples_->metrics(from_ns, samples_->stamp_ns());
    result.standby_took_over = standby_flies();
    result.healed = eventually([this] { return healed(); }, kHeals, 20ms);
    result.priority_kept = status().realtime_scheduling() == result.had_priority;
    result.log = hosts_.log();
    return result;
  }

 private:
  void wait(const char* what, const std::function<bool()>& predicate) const {
    if (!eventually(predicate, tests::kStuck, 5ms))
      throw std::runtime_error(std::string("timed out: ") + what);
  }
  msg::ControlStatus status() const { return observer_->view().control.message; }
  std::size_t controllers() const { return standby_ != nullptr ? 2 : 1; }
  bool standby_flies() const { return status().controller() != controller_; }
  ControlMode mode() const { return static_cast<ControlMode>(status().mode()); }

  // Ready ones that report within 0.5 s.
  std::size_t ready_controllers() const {
    const ground::View view = observer_->view();
    const auto now = ground::Clock::now();
    return static_cast<std::size_t>(
        std::count_if(view.controllers.begin(), view.controllers.end(), [&](const auto& controller) {
          return controller.first != dead_ && controller.second.message.ready() &&
                 controller.second.age_s(now) < 0.5;
        }));
  }

  void start_standby() {
    standby_ = &hosts_.start_standby();
    wait("the standby is ready", [this] { return ready_controllers() == controllers(); });
  }

  // Restarts the standby that has taken over, so that the first controller flies again.
  void give_back() {
    dead_ = status().controller();
    standby_->signal(SIGKILL);
    wait("the first controller takes over", [this] { return !standby_flies(); });
    start_standby();
  }

  // Each request may be refused while the standby takes over on a busy machine.
  void begin_mission() {
    ground::Result answer;
    const auto accepted = [&](ground::Result result) {
      answer = std::move(result);
      return answer.accepted();
    };
    const auto does = [&](control::RequestKind kind) {
      control::Request request;
      request.kind = kind;
      return accepted(pilot_->request(request, 5s));
    };
    const auto begins = [&] {
      if (mode() == ControlMode::kStopped) does(control::RequestKind::kDisarm);
      return (status().airborne() || does(control::RequestKind::kArm)) &&
             accepted(pilot_->upload(tests::square_laps(kSpeed, kLaps), 10s)) &&
             does(control::RequestKind::kMissionStart);
    };
    if (!eventually(begins, 20s, 100ms))
      throw std::runtime_error("it does not begin the mission: " + answer.reason);
    wait("it flies the mission", [this] { return mode() == ControlMode::kMission; });
  }

  // Cuts the network, and watches until it is clear what comes of it. reasons: of the modes that are entered.
  // What shall be flown through lasts as long by the wall clock, of which a cable keeps time, and what shall not be at least
  // as long by that of the vehicle, which a busy machine delays.
  std::optional<Outcome> outcome_of(const Partition& row, const Cut& cut, std::string& reasons) {
    tests::NetworkRelay& from = *cables_.at(row.from);
    tests::NetworkRelay& to = *cables_.at(row.to);
    const std::chrono::milliseconds least(cut.ms);
    const auto duration = cut.outcome == Outcome::kFliesOn ? least : least + kComesDown;
    const std::int64_t from_ns = samples_->stamp_ns();
    const std::uint32_t item = observer_->view().mission.message.item_index();
    std::string last = status().reason().c_str();
    from.block(hosts_.network().address(row.to), duration);
    to.block(hosts_.network().address(row.from), duration);
    std::optional<std::int64_t> healed_ns;
    std::optional<Outcome> outcome;
    eventually(
        [&] {
          const ground::View view = observer_->view();
          const msg::ControlStatus& now = view.control.message;
          const auto mode = static_cast<ControlMode>(now.mode());
          if (now.reason().c_str() != std::exchange(last, now.reason().c_str()))
            reasons += (reasons.empty() ? "" : ", ") + last;
          if (duration > least &&
              samples_->stamp_ns() - from_ns > std::chrono::nanoseconds(least + 10ms).count()) {
            from.unblock();
            to.unblock();
          }
          if (from.blocked() || to.blocked()) return false;
          if (!healed_ns) healed_ns = samples_->stamp_ns();
          if (view.truth.message.on_ground()) {
            const double fall_m_s = samples_->metrics(from_ns, samples_->stamp_ns()).fastest_fall_m_s;
            if (fall_m_s > kFall_m_s && mode == ControlMode::kStopped) outcome = Outcome::kFalls;
            if (fall_m_s <= kFall_m_s && mode == ControlMode::kDisarmed) outcome = Outcome::kLands;
          } else if (samples_->stamp_ns() - *healed_ns > kFailsafes_ns) {
            if (mode == ControlMode::kMission && view.mission.message.item_index() > item)
              outcome = Outcome::kFliesOn;
            if (mode == ControlMode::kHolding) outcome = Outcome::kHolds;
          }
          return outcome.has_value();
        },
        duration + kComesDown, 5ms);
    return outcome;
  }

  // Vehicle and ground hear control, and the controllers hear poses.
  bool healed() const {
    const auto now = ground::Clock::now();
    const auto is_fresh = [&](const ground::View& view) {
      return view.control.seen() && view.control.age_s(now) < 0.5 && view.truth.age_s(now) < 0.5;
    };
    return is_fresh(observer_->view()) && is_fresh(pilot_->view()) &&
           ground::controllers_of(observer_->view(), now).count() >= static_cast<int>(controllers()) &&
           status().mocap_age_s() >= 0.0 && status().mocap_age_s() < 0.5;
  }

  NetworkFlight hosts_;
  std::array<std::unique_ptr<tests::NetworkRelay>, NetworkFlight::kHosts>
      cables_;  // of the hosts that are cut off
  tests::StallWitness cores_;
  std::unique_ptr<ground::Client> observer_;
  std::unique_ptr<tests::FlightSamples> samples_;  // of the observer
  std::unique_ptr<ground::Client> pilot_;
  tests::Program* standby_ = nullptr;  // the last one that was started
  std::uint64_t controller_ = 0;       // on a host of its own
  std::uint64_t dead_ = 0;             // the standby that was ended last
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
  return fmt::format("{} - {}, {} standby", kHostNames.at(from), kHostNames.at(to), standby ? "with" : "no");
}

const std::vector<Partition>& partitions() {
  static const std::vector<Partition> all = all_partitions();
  return all;
}

std::string fault_of(const Partition& partition, const Cut& cut, const CutResult& result) {
  if (result.outcome != cut.outcome) return std::string("expected: ") + to_string(cut.outcome);
  if (result.reasons.find(cut.reasons) == std::string::npos)
    return std::string("expected as reasons: ") + cut.reasons;
  if (partition.takes_over && !result.standby_took_over) return "the standby did not take over";
  if (!partition.takes_over && result.standby_took_over && result.metrics.longest_gap_ms < kStandbyWaits_ms)
    return "the standby took over although no command was missing";
  if (result.metrics.changes_of_controller != (result.standby_took_over ? 1 : 0))
    return fmt::format("{} changes of the controller", result.metrics.changes_of_controller);
  const double longest_gap_ms =
      partition.longest_gap_ms + (partition.takes_over ? result.core_stood_still_ms : 0.0);
  if (cut.outcome != Outcome::kFalls && result.metrics.longest_gap_ms > longest_gap_ms)
    return fmt::format("expected: at most {:.0f} ms without a new command", longest_gap_ms);
  if ((cut.outcome == Outcome::kFliesOn ? result.metrics.largest_deviation_m
                                        : result.metrics.final_distance_m) > cut.within_m)
    return fmt::format("expected: within {} m", cut.within_m);
  if (!result.healed) return "some do not hear each other again";
  if (const auto refused = tests::refused_datagrams(result.log); refused > 0)
    return fmt::format("{} datagrams of own processes refused", refused);
  if (!result.had_priority) return "the real-time priority was not granted";
  if (!result.priority_kept) return "the real-time priority was lost";
  return "";
}

void fly_through(const std::vector<Partition>& rows, const std::filesystem::path& folder,
                 const std::function<void(const Partition&, const Cut&, const CutResult&)>& report) {
  PartitionFlight flight(rows, folder);
  for (const Partition& row : rows) {
    for (const Cut& cut : row.cuts) report(row, cut, flight.make(row, cut));
  }
}

}  // namespace swiftlet::soak
