// Flights by keys and by a joystick, with running processes.
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include "swiftlet/ground/client/vehicle.hpp"
#include "tests/support/online_flight.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using control::Mode;
using ground::VehicleState;

const std::string kUp = "\x1bOA";  // as an xterm sends the arrow keys to a full-screen program
const std::string kRight = "\x1bOC";

comms::NodeSettings node_of(int domain) {
  comms::NodeSettings node{"test"};
  node.vehicle = "kl7";
  node.domain = domain;
  node.localhost_only = true;
  node.deadlines = false;
  return node;
}

class TeleopFlight : public OnlineFlight {
 protected:
  TeleopFlight() : vehicle_(node_of(lock_.domain())) {}

  void SetUp() override {
    OnlineFlight::SetUp();
    ASSERT_TRUE(vehicle_.connect(kStuck).accepted());
  }
  std::vector<std::string> teleop(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), "teleop");
    for (const std::string& word : network()) more.push_back(word);
    return more;
  }
  VehicleState state() const { return vehicle_.state(); }
  double north_m() const { return state().position_ned_m.x(); }
  double height_m() const { return -state().position_ned_m.z(); }

  static bool shows(Terminal& terminal, const std::string& text) {
    return eventually([&] { return terminal.text().find(text) != std::string::npos; }, kStuck);
  }
  // Holds a key until the condition is true: types it again and again, as a keyboard does.
  static bool hold_key(Terminal& terminal, const std::string& key, const std::function<bool()>& condition) {
    return eventually(
        [&] {
          terminal.type(key);
          return condition();
        },
        kStuck, 30ms);
  }
  // By a request, not because setpoints stopped to come.
  bool comes_to_hold_by_request() {
    return vehicle_.wait_until(
        [](const VehicleState& state) {
          return state.mode == Mode::kHolding && state.mode_reason == "requested";
        },
        kStuck);
  }
  bool comes_to_rest() {
    return vehicle_.wait_until([](const VehicleState& state) { return state.velocity_ned_m_s.norm() < 0.02; },
                               kStuck);
  }

  ground::Vehicle vehicle_;
};

TEST_F(TeleopFlight, KeysMoveTheVehicleAndTheirReleaseHoldsIt) {
  take_off();
  Terminal terminal("swiftlet", teleop({"--speed", "0.6", "--climb-speed", "0.4"}), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding (take-off completed)")) << terminal.text();
  for (const char* part : {"position  north ", "command   forward +0.00", "arrows ", "x     hold and quit"})
    EXPECT_TRUE(shows(terminal, part)) << part << terminal.text();
  EXPECT_EQ(state().mode, Mode::kHolding) << "no key, no setpoint";

  ASSERT_TRUE(hold_key(terminal, kUp, [this] { return north_m() > 0.3; })) << terminal.text();
  EXPECT_LT(state().velocity_ned_m_s.norm(), 0.7);
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  ASSERT_TRUE(comes_to_rest());
  EXPECT_NEAR(state().position_ned_m.y(), 0.0, 0.05);

  ASSERT_TRUE(hold_key(terminal, "w", [this] { return height_m() > 0.8; })) << terminal.text();
  const auto yaw = [this] {
    const Eigen::Vector3d nose = state().q_ned_from_frd * Eigen::Vector3d::UnitX();
    return std::atan2(nose.y(), nose.x());
  };
  ASSERT_TRUE(hold_key(terminal, "e", [&] { return yaw() > 1.2; })) << terminal.text();
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  const double east_m = state().position_ned_m.y();
  // The nose points to the east: so does the upward arrow.
  ASSERT_TRUE(hold_key(terminal, kUp, [&] { return state().position_ned_m.y() > east_m + 0.2; }))
      << terminal.text();

  terminal.type(" ");
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  terminal.type("x");
  EXPECT_EQ(terminal.wait(kStuck), 0) << terminal.text();
  EXPECT_TRUE(terminal.is_restored());
  EXPECT_TRUE(shows(terminal, "refused; now holding at (")) << terminal.text();
}

TEST_F(TeleopFlight, ShowsARefusedVelocity) {
  take_off();
  Terminal terminal("swiftlet", teleop({"--speed", "9"}), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding")) << terminal.text();
  ASSERT_TRUE(hold_key(terminal, kUp, [&] { return terminal.text().find("speed") != std::string::npos; }))
      << terminal.text();
  EXPECT_EQ(state().mode, Mode::kHolding);
  EXPECT_LT(north_m(), 0.05);
}

TEST_F(TeleopFlight, HoldsWhenTheTerminalIsClosed) {
  take_off();
  Terminal terminal("swiftlet", teleop(), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding")) << terminal.text();
  ASSERT_TRUE(hold_key(terminal, kRight, [this] { return state().position_ned_m.y() > 0.1; }))
      << terminal.text();
  terminal.hang_up();
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  EXPECT_EQ(terminal.wait(kStuck), 1);
}

TEST_F(TeleopFlight, HoldsWhenItIsInterrupted) {
  take_off();
  Terminal terminal("swiftlet", teleop(), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding")) << terminal.text();
  ASSERT_TRUE(hold_key(terminal, kUp, [this] { return north_m() > 0.1; })) << terminal.text();
  terminal.type("\x03");
  EXPECT_EQ(terminal.wait(kStuck), 0);
  EXPECT_TRUE(terminal.is_restored());
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
}

TEST_F(TeleopFlight, VehicleHoldsWhenTeleopIsKilled) {
  take_off();
  Terminal terminal("swiftlet", teleop(), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding")) << terminal.text();
  ASSERT_TRUE(hold_key(terminal, kUp, [this] { return north_m() > 0.1; })) << terminal.text();
  terminal.signal(SIGKILL);
  ASSERT_TRUE(vehicle_.wait_until(
      [](const VehicleState& state) { return state.mode_reason == "setpoints stopped"; }, kStuck));
  EXPECT_EQ(state().mode, Mode::kHolding);
}

TEST_F(TeleopFlight, RequiresAVehicleInTheAirAndEndsWhenItLands) {
  {
    Terminal terminal("swiftlet", teleop(), 80, 24);
    EXPECT_EQ(terminal.wait(kStuck), 1);
    EXPECT_TRUE(shows(terminal, "kl7 is disarmed; take off first: swiftlet arm && swiftlet"))
        << terminal.text();
  }
  take_off();
  Terminal terminal("swiftlet", teleop(), 80, 24);
  ASSERT_TRUE(shows(terminal, "kl7 holding")) << terminal.text();
  ASSERT_TRUE(vehicle_.land().accepted());
  EXPECT_EQ(terminal.wait(kStuck), 1);
  EXPECT_TRUE(terminal.is_restored());
  EXPECT_TRUE(shows(terminal, "swiftlet: teleop: the vehicle is landing: requested")) << terminal.text();
}

class JoystickFlight : public TeleopFlight {
 protected:
  void SetUp() override {
    TeleopFlight::SetUp();
    ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  }
  void TearDown() override { unplug(); }

  std::string path() const { return folder_.path() / "event5"; }
  void plug() {
    ASSERT_TRUE(
        eventually([this] { return (writer_ = open(path().c_str(), O_WRONLY | O_NONBLOCK)) >= 0; }, kStuck))
        << "nobody reads the FIFO";
  }
  void unplug() {
    if (writer_ >= 0) close(writer_);
    writer_ = -1;
  }
  void put(int type, int code, int value) const {
    input_event event{};
    event.type = static_cast<std::uint16_t>(type);
    event.code = static_cast<std::uint16_t>(code);
    event.value = value;
    ASSERT_EQ(write(writer_, &event, sizeof event), static_cast<ssize_t>(sizeof event));
  }

  int writer_ = -1;
};

TEST_F(JoystickFlight, MovesWhileTheDeadManButtonIsHeld) {
  take_off();
  Program program("swiftlet", teleop({"--joystick", path(), "--speed", "0.6", "--json"}), folder_.path());
  plug();
  put(EV_ABS, ABS_RY, -32768);
  ASSERT_TRUE(
      eventually([&] { return program.errors().find("teleop: kl7 holding") != std::string::npos; }, kStuck))
      << program.errors();
  put(EV_KEY, BTN_TR, 1);
  put(EV_SYN, SYN_REPORT, 0);
  ASSERT_TRUE(
      vehicle_.wait_until([](const VehicleState& state) { return state.position_ned_m.x() > 0.2; }, kStuck));
  put(EV_KEY, BTN_TR, 0);
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  ASSERT_TRUE(comes_to_rest());

  const double north_before_m = north_m();
  put(EV_ABS, ABS_RY, 0);
  put(EV_ABS, ABS_Y, -32768);
  put(EV_KEY, BTN_TL, 1);
  ASSERT_TRUE(
      vehicle_.wait_until([](const VehicleState& state) { return state.position_ned_m.z() < -0.8; }, kStuck));
  EXPECT_NEAR(north_m(), north_before_m, 0.05);
  unplug();
  ASSERT_TRUE(comes_to_hold_by_request()) << state().mode_reason;
  EXPECT_EQ(program.wait(kStuck), 1);
  const json report = json::parse(program.output());
  EXPECT_EQ(report.at("mode"), "holding");
  EXPECT_EQ(report.at("reason"), "the joystick " + path() + " was lost");
  EXPECT_GT(report.at("accepted"), 20);
  EXPECT_EQ(report.at("refused"), 0);
}

}  // namespace
}  // namespace swiftlet::tests
