// Flights by keys and by a joystick, with running processes.
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/online_flight.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using control::Mode;

const std::string kUp = "\x1bOA";  // as an xterm sends the arrow keys to a full-screen program
const std::string kRight = "\x1bOC";

// At twice real time: keys and sticks are sampled by the wall clock, as a pilot moves them.
class TeleopFlight : public OnlineFlight {
 protected:
  void SetUp() override { start("2"); }

  Terminal teleop(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), "teleop");
    return {"swiftlet", on_network(std::move(options)), 80, 24};
  }
  double north_m() const { return state().position_ned_m.x(); }
  double height_m() const { return -state().position_ned_m.z(); }

  static bool shows(Terminal& terminal, const std::string& text) {
    const bool shown = eventually([&] { return terminal.text().find(text) != std::string::npos; });
    EXPECT_TRUE(shown) << text << "\n" << terminal.text();
    return shown;
  }
  // Holds a key until the condition is true: types it again and again, as a keyboard does.
  static bool hold_key(Terminal& terminal, const std::string& key, const std::function<bool()>& condition) {
    const bool reached = eventually(
        [&] {
          terminal.type(key);
          return condition();
        },
        kStuck, 30ms);
    EXPECT_TRUE(reached) << terminal.text();
    return reached;
  }
  // By a request, not because setpoints stopped to come.
  bool comes_to_hold_by_request() const {
    return reaches("hold by request", [](const VehicleState& now) {
      return now.mode == Mode::kHolding && now.mode_reason == "requested";
    });
  }
  bool comes_to_rest() const {
    return reaches("rest", [](const VehicleState& now) { return now.velocity_ned_m_s.norm() < 0.02; });
  }
};

TEST_F(TeleopFlight, KeysMoveTheVehicleAndTheirReleaseHoldsIt) {
  take_off();
  Terminal terminal = teleop({"--speed", "0.6", "--climb-speed", "0.4"});
  ASSERT_TRUE(shows(terminal, "kl7 holding (take-off completed)"));
  for (const char* part : {"position  north ", "command   forward +0.00", "arrows ", "x     hold and quit"})
    ASSERT_TRUE(shows(terminal, part));
  EXPECT_EQ(state().mode, Mode::kHolding) << "no key, no setpoint";

  ASSERT_TRUE(hold_key(terminal, kUp, [this] { return north_m() > 0.3; }));
  EXPECT_LT(state().velocity_ned_m_s.norm(), 0.7);
  ASSERT_TRUE(comes_to_hold_by_request());
  ASSERT_TRUE(comes_to_rest());
  EXPECT_NEAR(state().position_ned_m.y(), 0.0, 0.05);

  ASSERT_TRUE(hold_key(terminal, "w", [this] { return height_m() > 0.8; }));
  const auto yaw = [this] {
    const Eigen::Vector3d nose = state().q_ned_from_frd * Eigen::Vector3d::UnitX();
    return std::atan2(nose.y(), nose.x());
  };
  ASSERT_TRUE(hold_key(terminal, "e", [&] { return yaw() > 1.2; }));
  ASSERT_TRUE(comes_to_hold_by_request());
  const double east_m = state().position_ned_m.y();
  // The nose points to the east: so does the upward arrow.
  ASSERT_TRUE(hold_key(terminal, kUp, [&] { return state().position_ned_m.y() > east_m + 0.2; }));

  terminal.type(" ");
  ASSERT_TRUE(comes_to_hold_by_request());
  terminal.type("x");
  EXPECT_EQ(terminal.wait(kStuck), 0) << terminal.text();
  EXPECT_TRUE(terminal.is_restored());
  EXPECT_TRUE(shows(terminal, "refused; now holding at ("));
}

TEST_F(TeleopFlight, HoldsTheVehicleHoweverItEnds) {
  take_off();
  {
    Terminal interrupted = teleop();
    ASSERT_TRUE(shows(interrupted, "kl7 holding"));
    ASSERT_TRUE(hold_key(interrupted, kUp, [this] { return north_m() > 0.1; }));
    interrupted.type("\x03");
    EXPECT_EQ(interrupted.wait(kStuck), 0);
    EXPECT_TRUE(interrupted.is_restored());
    ASSERT_TRUE(comes_to_hold_by_request());
  }
  {
    Terminal closed = teleop();
    ASSERT_TRUE(shows(closed, "kl7 holding"));
    ASSERT_TRUE(hold_key(closed, kRight, [this] { return state().position_ned_m.y() > 0.1; }));
    closed.hang_up();
    ASSERT_TRUE(comes_to_hold_by_request());
    EXPECT_EQ(closed.wait(kStuck), 1);
  }
  Terminal killed = teleop();
  ASSERT_TRUE(shows(killed, "kl7 holding"));
  const double begin_m = north_m();
  ASSERT_TRUE(hold_key(killed, kUp, [&] { return north_m() > begin_m + 0.1; }));
  killed.signal(SIGKILL);
  ASSERT_TRUE(reaches("hold without setpoints",
                      [](const VehicleState& now) { return now.mode_reason == "setpoints stopped"; }));
  EXPECT_EQ(state().mode, Mode::kHolding);
}

TEST_F(TeleopFlight, RequiresAVehicleInTheAirShowsRefusalsAndEndsWhenItLands) {
  {
    Terminal terminal = teleop();
    EXPECT_EQ(terminal.wait(kStuck), 1);
    EXPECT_TRUE(shows(terminal, "kl7 is disarmed; take off first: swiftlet arm && swiftlet"));
  }
  take_off();
  Terminal terminal = teleop({"--speed", "9"});
  ASSERT_TRUE(shows(terminal, "kl7 holding"));
  ASSERT_TRUE(hold_key(terminal, kUp, [&] { return terminal.text().find("speed") != std::string::npos; }));
  EXPECT_EQ(state().mode, Mode::kHolding);
  EXPECT_LT(north_m(), 0.05);
  ASSERT_TRUE(comes_to_hold_by_request()) << "the key is released";
  ASSERT_TRUE(vehicle_.land().accepted());
  EXPECT_EQ(terminal.wait(kStuck), 1);
  EXPECT_TRUE(terminal.is_restored());
  EXPECT_TRUE(shows(terminal, "swiftlet: teleop: the vehicle is landing: requested"));
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
  Program program = begin({"teleop", "--joystick", path(), "--speed", "0.6", "--json"});
  plug();
  put(EV_ABS, ABS_RY, -32768);
  ASSERT_TRUE(eventually([&] { return program.errors().find("teleop: kl7 holding") != std::string::npos; }))
      << program.errors();
  put(EV_KEY, BTN_TR, 1);
  put(EV_SYN, SYN_REPORT, 0);
  ASSERT_TRUE(reaches("a place", [](const VehicleState& now) { return now.position_ned_m.x() > 0.2; }));
  put(EV_KEY, BTN_TR, 0);
  ASSERT_TRUE(comes_to_hold_by_request());
  ASSERT_TRUE(comes_to_rest());

  const double north_before_m = north_m();
  put(EV_ABS, ABS_RY, 0);
  put(EV_ABS, ABS_Y, -32768);
  put(EV_KEY, BTN_TL, 1);
  ASSERT_TRUE(reaches("a height", [](const VehicleState& now) { return now.position_ned_m.z() < -0.8; }));
  EXPECT_NEAR(north_m(), north_before_m, 0.05);
  unplug();
  ASSERT_TRUE(comes_to_hold_by_request());
  EXPECT_EQ(program.wait(kStuck), 1);
  const json report = json::parse(program.output());
  EXPECT_EQ(report.at("mode"), "holding");
  EXPECT_EQ(report.at("reason"), "the joystick " + path() + " was lost");
  EXPECT_GT(report.at("accepted"), 20);
  EXPECT_EQ(report.at("refused"), 0);
}

}  // namespace
}  // namespace swiftlet::tests
