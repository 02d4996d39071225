// Redundant control services of one vehicle: failover when they die, are suspended, return or start together. In simulated
// time but for one flight.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/redundant_flight.hpp"
#include "tests/support/simulated_time.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace msg = messages::msg;
using namespace std::chrono_literals;

constexpr double kReferenceStep_m = 0.01;

class Standby : public testing::Test {
 protected:
  explicit Standby(const std::vector<std::string>& plant_options = plant_in_simulated_time(),
                   const std::vector<std::string>& mocap_options = mocap_in_simulated_time())
      : flight_(folder_.path(), plant_options, {}, mocap_options) {}

  // Flies around a square at a height of 1 m.
  void take_off() {
    flight_.fly(square_laps(0.5, 50));
    flight_.wait("the vehicle flies a side",
                 [&] { return flight_.z_ned() < -0.98 && flight_.speed() > 0.3; });
  }
  void hover(double height_m) {
    flight_.ask(control::RequestKind::kArm);
    flight_.ask(control::RequestKind::kTakeoff, -height_m);
    flight_.wait("the vehicle hovers",
                 [&] { return mode() == "holding" && flight_.z_ned() < 0.02 - height_m; });
  }
  // Returns the gap in the commands, ms.
  double kill_active_in_mission() {
    const std::int64_t at_ns = flight_.stamp_ns();
    flight_.kill(flight_.active());
    const FlightMetrics metrics = flight_.metrics(at_ns, at_ns + kSecond);
    EXPECT_GT(metrics.longest_gap_ms, 10.0) << "the gap must show the kill";
    EXPECT_LT(metrics.largest_deviation_m, kLargestDeviation_m);
    EXPECT_LT(metrics.largest_step_m, kReferenceStep_m);
    EXPECT_EQ(metrics.changes_of_controller, 1);
    EXPECT_EQ(mode(), "mission");
    return metrics.longest_gap_ms;
  }
  std::string mode() { return ground::mode_name(flight_.client().view().control.message.mode()); }
  std::string reason() { return flight_.client().view().control.message.reason().c_str(); }

  TemporaryFolder folder_;
  RedundantFlight flight_;
};

TEST_F(Standby, TakesOverWithinBoundsDuringAMission) {
  flight_.start_controller(5);
  flight_.start_controller(2);
  flight_.start_controller(9);
  flight_.wait_for_roles(1, 2);
  const ProgramResult result =
      run_program("swiftlet", flight_.on_network({"status", "--json"}), folder_.path());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const nlohmann::json status = nlohmann::json::parse(result.output);
  ASSERT_EQ(status.at("controllers").size(), 3U) << result.output;
  constexpr std::pair<const char*, int> kInOrder[] = {{"active", 5}, {"standby", 9}, {"standby", 2}};
  for (std::size_t i = 0; i < std::size(kInOrder); ++i) {
    EXPECT_EQ(status.at("controllers")[i].at("role"), kInOrder[i].first) << i;
    EXPECT_EQ(status.at("controllers")[i].at("failover_priority"), kInOrder[i].second) << i;
  }

  take_off();
  EXPECT_LT(kill_active_in_mission(), kLongestGap_ms);
  EXPECT_EQ(flight_.active().failover_priority, 9) << "the highest priority";
  // A new controller of any priority joins as standby and takes over next, with a mission that was uploaded
  // before it started.
  flight_.start_controller(1000);
  flight_.wait_for_roles(1, 2);
  const std::int64_t joined_ns = flight_.stamp_ns();
  EXPECT_EQ(flight_.metrics(joined_ns - kSecond / 2, joined_ns + kSecond / 2).changes_of_controller, 0);
  EXPECT_LT(kill_active_in_mission(), kLongestGap_ms);
  EXPECT_EQ(flight_.active().failover_priority, 1000);
  flight_.wait_for_roles(1, 1);
  kill_active_in_mission();
  EXPECT_EQ(flight_.active().failover_priority, 2);
}

TEST_F(Standby, ResumedControllerBecomesStandby) {
  Controller& first = flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  take_off();
  ASSERT_EQ(&flight_.active(), &first);
  const std::int64_t at_ns = flight_.stamp_ns();
  first.process->signal(SIGSTOP);
  flight_.wait("200 ms pass", [&] { return flight_.stamp_ns() > at_ns + kSecond / 5; });
  first.process->signal(SIGCONT);

  const FlightMetrics metrics = flight_.metrics(at_ns, at_ns + 2 * kSecond);
  EXPECT_LT(metrics.longest_gap_ms, kLongestGap_ms);
  EXPECT_LT(metrics.largest_deviation_m, kLargestDeviation_m);
  EXPECT_EQ(metrics.changes_of_controller, 1);
  flight_.wait_for_roles(1, 1);
  EXPECT_NE(&flight_.active(), &first);

  // The resumed standby has caught up with the state: it can take over.
  EXPECT_LT(kill_active_in_mission(), kLongestGap_ms);
  EXPECT_EQ(&flight_.active(), &first);
}

class StandbyInRealTime : public Standby {
 protected:
  StandbyInRealTime() : Standby({}, {}) {}

  // The longest time in which a standby that took over received no sample, as it logs, ms.
  static double pause_ms(const Controller& controller) {
    static constexpr const char* kText = "the longest pause between two samples was ";
    std::string log;
    EXPECT_TRUE(eventually([&] {
      log = controller.process->errors();
      return log.find(kText) != std::string::npos;
    })) << log;
    return std::stod(log.substr(log.find(kText) + std::string(kText).size()));
  }
};

// What a busy machine takes from the standby is told by its log, and not counted.
TEST_F(StandbyInRealTime, TakesOverWithinBounds) {
  flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  take_off();
  const double gap_ms = kill_active_in_mission();
  EXPECT_LT(gap_ms, kLongestGap_ms + pause_ms(flight_.active()));
}

TEST_F(Standby, OneOfTwoStartedTogetherBecomesActive) {
  const auto one = flight_.launch_controller(3);
  const auto two = flight_.launch_controller(3);
  flight_.wait_for_roles(1, 1);
  const std::int64_t at_ns = flight_.stamp_ns();
  const FlightMetrics metrics = flight_.metrics(at_ns, at_ns + kSecond);
  EXPECT_EQ(metrics.changes_of_controller, 0);
  EXPECT_EQ(flight_.recent_states().size(), 2U) << "each has its own id";
}

TEST_F(Standby, RestartedControllerEngagesInFlight) {
  Controller& first = flight_.start_controller(0);
  flight_.wait_for_roles(1, 0);
  hover(2.2);  // a fall from there lasts 0.67 s
  const std::int64_t at_ns = flight_.stamp_ns();
  flight_.kill(first);
  flight_.stop_time();  // a process may start slowly on a busy machine
  const std::unique_ptr<Program> second = flight_.launch_controller(0);
  flight_.wait("the second one is ready",
               [&] { return (second->output() + second->errors()).find("ready: ") != std::string::npos; });
  flight_.resume_time();
  flight_.wait("the vehicle holds", [&] { return mode() == "holding" && reason() == "engaged in flight"; });
  const FlightMetrics metrics = flight_.metrics(at_ns, at_ns + 3 * kSecond / 2);
  EXPECT_LT(metrics.lowest_z_ned, -0.3)
      << "fell too far; without a command for " << metrics.longest_gap_ms << " ms";
  flight_.ask(control::RequestKind::kLand);
  flight_.wait("the vehicle has landed", [&] { return mode() == "disarmed"; });
  EXPECT_EQ(reason(), "landed");
}

TEST_F(Standby, RestartedControllerStaysDisarmedOnTheGround) {
  Controller& first = flight_.start_controller(0);
  flight_.wait_for_roles(1, 0);
  flight_.ask(control::RequestKind::kArm);
  flight_.wait("the vehicle is armed", [&] { return mode() == "armed"; });
  flight_.kill(first);
  flight_.start_controller(0);
  flight_.wait_for_roles(1, 0);
  const std::int64_t at_ns = flight_.stamp_ns();
  flight_.metrics(at_ns, at_ns + kSecond);
  EXPECT_EQ(mode(), "disarmed");
  flight_.wait("the rotors are off",
               [&] { return !flight_.client().view().vehicle.message.rotors_running(); });
}

// GIVEN a take-off in progress WHEN its controller dies THEN the standby completes it, and the client
// receives its result and a connection event. A request that is sent when this one dies is answered by the next.
TEST_F(Standby, ActionAndRequestSucceedAcrossAFailover) {
  flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  ground::Vehicle vehicle(flight_.node_settings("program"));
  Inbox<ground::ConnectionEvent> events;
  vehicle.on_connection([&](const ground::ConnectionEvent& event) { events.put(event); });
  ASSERT_TRUE(vehicle.connect(kStuck).accepted());
  ASSERT_TRUE(vehicle.arm().accepted());
  const ground::ActionHandle climb = vehicle.take_off(1.0, 0.2);  // progress is told ten times a second
  ASSERT_TRUE(climb.accepted()) << climb.answer().reason;
  ASSERT_TRUE(eventually([&] { return climb.progress() > 0.2; }, kStuck));
  ASSERT_LT(climb.progress(), 1.0);
  flight_.kill(flight_.active());
  const ground::ActionResult result = climb.wait(kStuck);
  EXPECT_TRUE(result.done()) << result.reason;
  EXPECT_NEAR(vehicle.state().position_ned_m.z(), -1.0, 0.06);
  EXPECT_TRUE(events.wait(
      [](const auto& all) { return all.back().kind == ground::ConnectionEvent::Kind::kReplaced; }));
  EXPECT_TRUE(vehicle.connected());

  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  flight_.kill(flight_.active());
  flight_.ask(control::RequestKind::kLand);  // repeated until a controller answers
  flight_.wait("the vehicle has landed", [&] { return mode() == "disarmed"; });
}

// The settings that the controllers are started with, with another bandwidth of x and y.
control::SettingsRequest with_bandwidth(const char* name, double omega_n, double ramp_s) {
  control::ControlSettings settings = io::load_control_settings(in_source("config/control/motor_lag.yaml"));
  settings.name = name;
  settings.position.x.omega_n = settings.position.y.omega_n = omega_n;
  return control::settings_request(settings, {}, ramp_s);
}

// omega^2 + 2 zeta omega pole, with zeta 1 and a pole of 0.4 rad/s.
double p_gain(double omega_n) { return omega_n * omega_n + 0.8 * omega_n; }

// GIVEN gains that were changed in flight WHEN the controller dies THEN the standby flies with them and never
// with those of its file. The same for a standby that was started after the change, and in the middle of a
// change.
TEST_F(Standby, TakesOverWithTheGainsInForce) {
  flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  hover(1.0);
  ground::Vehicle vehicle(flight_.node_settings("program"));
  const ground::ActionHandle soft = vehicle.change_settings(with_bandwidth("soft", 1.0, 0.5));
  ASSERT_TRUE(soft.accepted()) << soft.answer().reason;
  ASSERT_TRUE(soft.wait(20s).done());

  Inbox<msg::ControlStatus> statuses;
  dds::Node node(flight_.node_settings("gains"));
  const dds::Subscription subscription = node.subscribe<msg::ControlStatus>(
      messages::topics::kControlStatus, [&](const msg::ControlStatus& status) { statuses.put(status); });
  const auto waits_for = [&](const char* what,
                             const std::function<bool(const msg::ControlStatus&)>& predicate) {
    flight_.wait(what, [&] {
      const auto all = statuses.items();
      return !all.empty() && predicate(all.back());
    });
  };
  std::uint64_t dead = flight_.active().id;
  flight_.kill(flight_.active());
  waits_for("the standby flies", [&](const auto& status) { return status.controller() != dead; });
  EXPECT_STREQ(statuses.items().back().settings().c_str(), "soft");

  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  ASSERT_TRUE(vehicle.change_settings(with_bandwidth("softer", 0.8, 3.0)).accepted());
  waits_for("the gains change", [](const auto& status) {
    return status.gains_progress() > 0.3 && status.gains_progress() < 0.9;
  });
  dead = flight_.active().id;
  flight_.kill(flight_.active());
  waits_for("the second standby flies", [&](const auto& status) { return status.controller() != dead; });
  waits_for("the change is complete", [](const auto& status) { return status.gains_progress() == 1.0; });

  EXPECT_STREQ(statuses.items().back().settings().c_str(), "softer");
  EXPECT_NEAR(statuses.items().back().gains().position_p()[0], p_gain(0.8), 1e-9);
  double most = 0.0;
  for (const msg::ControlStatus& status : statuses.items())
    most = std::max(most, status.gains().position_p()[0]);
  EXPECT_NEAR(most, p_gain(1.0), 1e-9) << "a takeover fell back to the gains of the file";
  EXPECT_EQ(mode(), "holding");
}

// GIVEN a controller that dies during an action WHEN another one starts THEN the client reports the lost
// connection, the new controller and the lost action, and can command the new controller.
TEST_F(Standby, ClientReconnectsToARestartedController) {
  using Kind = ground::ConnectionEvent::Kind;
  Controller& first = flight_.start_controller(0);
  flight_.wait_for_roles(1, 0);
  ground::Vehicle vehicle(flight_.node_settings("program"));
  Inbox<ground::ConnectionEvent> events;
  vehicle.on_connection([&](const ground::ConnectionEvent& event) { events.put(event); });
  ASSERT_TRUE(events.wait_for_count(1));
  EXPECT_EQ(events.items()[0].kind, Kind::kConnected);
  EXPECT_EQ(events.items()[0].controller, first.id);
  // Until a pose and a battery sample arrive, it is refused.
  ASSERT_TRUE(eventually([&] { return vehicle.arm().accepted(); }));
  const ground::ActionHandle climb = vehicle.take_off(0.5);
  ASSERT_TRUE(climb.accepted()) << climb.answer().reason;
  flight_.kill(first);
  ASSERT_TRUE(events.wait_for_count(2));
  EXPECT_EQ(events.items()[1].kind, Kind::kLost);
  EXPECT_FALSE(vehicle.connected());
  flight_.wait("the vehicle stands, its rotors off",  // a controller would engage in flight
               [&] { return !flight_.client().view().vehicle.message.rotors_running(); });

  const Controller& second = flight_.start_controller(0);
  ASSERT_TRUE(events.wait_for_count(3));
  EXPECT_EQ(events.items()[2].kind, Kind::kReplaced);
  EXPECT_EQ(events.items()[2].controller, second.id);
  EXPECT_TRUE(vehicle.connected());
  const ground::ActionResult lost = climb.wait(kStuck);
  EXPECT_EQ(lost.kind, ground::ActionResult::Kind::kLost) << lost.reason;
  std::string refusal;
  EXPECT_TRUE(eventually(
      [&] {
        const ground::Result answer = vehicle.arm().answer();
        refusal = answer.reason;
        return answer.accepted();
      },
      kStuck))
      << refusal;
  EXPECT_TRUE(vehicle.disarm().wait(5s).done());
}

}  // namespace
}  // namespace swiftlet::tests
