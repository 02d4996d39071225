// Faults of processes and network: a process is killed, suspended or restarted, or its clock steps. Ground truth shows what
// the vehicle did, control_status why. All but the steps of clocks are flown in simulated time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <limits>
#include <string>
#include <sys/mman.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/client/simulation_clock.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/separate_processes.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using control::Mode;
using ground::View;
using record::TruthRow;
namespace msg = ground::msg;

class Failsafe : public SeparateProcesses {
 protected:
  double lowest_m() const {
    double lowest = 1e9;
    for (const record::TruthRow& row : truth()) lowest = std::min(lowest, -row.position_ned[2]);
    return lowest;
  }
  double most_tilt_rad() const {
    double most = 0.0;
    for (const record::TruthRow& row : truth()) most = std::max(most, tilt_rad(row));
    return most;
  }
  double farthest_m() const {
    double farthest = 0.0;
    for (const record::TruthRow& row : truth())
      farthest = std::max(farthest, std::hypot(row.position_ned[0], row.position_ned[1]));
    return farthest;
  }
  double fastest_sink() const {
    double fastest = 0.0;
    for (const record::TruthRow& row : truth()) fastest = std::max(fastest, row.velocity_ned[2]);
    return fastest;
  }
  bool settles_at(double x, double y, double z) const {
    return eventually([&] { return distance_m(x, y, z) < 0.05; }, kTimeout);
  }
  // A file with the control settings of motor_lag in which `from` is replaced.
  std::string settings_with(const std::string& from, const std::string& to) const {
    std::string text = io::read_text_file(in_source("config/control/motor_lag.yaml"));
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return folder_.write("control.yaml", text.replace(at, from.size(), to));
  }
  std::string simulation_with(const std::string& faults) const {
    return folder_.write("simulation.yaml", io::read_text_file(in_source("config/simulation/default.yaml")) +
                                                "faults:\n" + faults);
  }
};

TEST_F(Failsafe, DescendsLevelAndDisarmsWhenMocapIsKilled) {
  start_all();
  hover();
  mocap_->signal(SIGKILL);
  ASSERT_TRUE(reported(Mode::kDescent, "no mocap pose")) << mode_log();
  ASSERT_TRUE(reported(Mode::kDisarmed, "landed without position")) << mode_log();
  ASSERT_TRUE(wait_until_rotors_off());
  EXPECT_TRUE(wait_until_on_ground());
  EXPECT_LT(most_tilt_rad(), 0.2);
  EXPECT_LT(fastest_sink(), 0.8);
  EXPECT_LT(farthest_m(), 1.0);
}

// Heartbeats of the tool come as often as telemetry: the vehicle must not be faster than a busy machine schedules the tool.
TEST_F(Failsafe, LandsWhenTheGroundToolIsKilled) {
  start_all({}, {}, "3");
  wait_until_ready();
  const std::string mission =
      folder_.write("hover.yaml",
                    "frame: ned\ntolerance_m: 0.1\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.8, speed_m_s: 0.8, hold_s: 300}\n"
                    "  - {kind: land, speed_m_s: 0.4}\n");
  Program fly("swiftlet",
              {"fly", mission, "--attach", "--localhost-only", "--domain", std::to_string(lock_.domain()),
               "--record", folder_.path() / "record"},
              folder_.path());
  ASSERT_TRUE(eventually([&] { return -client_->view().truth.message.position_ned()[2] > 0.7; }, kTimeout))
      << fly.errors();
  EXPECT_TRUE(
      client_->wait(kTimeout, [](const View& view) { return view.control.message.ground_links() == 1; }));
  clear_history();
  fly.signal(SIGKILL);
  ASSERT_TRUE(reported(Mode::kLanding, "ground link lost")) << mode_log();
  ASSERT_TRUE(reported(Mode::kDisarmed, "landed")) << mode_log();
  EXPECT_TRUE(wait_until_on_ground());
  EXPECT_LT(most_tilt_rad(), 0.2);
  EXPECT_FALSE(plant_->exit_code() || mocap_->exit_code() || control_->exit_code());
}

TEST_F(Failsafe, FliesOnAfterTheExitOfAShortCommandAndASuspensionOfControlFor200Ms) {
  start_all();
  hover();
  const ProgramResult result = run_program(
      "swiftlet", {"goto", "0.3", "0", "-1", "--domain", std::to_string(lock_.domain()), "--localhost-only"},
      folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  wait_vehicle_time(3.0);
  EXPECT_EQ(client_->view().control.message.ground_links(), 0);
  EXPECT_TRUE(settles_at(0.3, 0, -1));
  EXPECT_EQ(mode_log(), "holding: take-off completed\nholding: requested\n");

  control_->signal(SIGSTOP);
  wait_vehicle_time(0.2);
  control_->signal(SIGCONT);
  wait_vehicle_time(4.0);
  EXPECT_EQ(mode_log(), "holding: take-off completed\nholding: requested\n");
  EXPECT_GT(lowest_m(), 0.5);
  EXPECT_TRUE(settles_at(0.3, 0, -1));
}

TEST_F(Failsafe, RotorsStopWhenControlIsKilledAndARestartCanFly) {
  start_all();
  hover();
  control_->signal(SIGKILL);
  ASSERT_TRUE(wait_until_rotors_off());
  ASSERT_TRUE(wait_until_on_ground());
  EXPECT_NE(std::string(client_->view().vehicle.message.fault().c_str()), "");
  ASSERT_TRUE(eventually([&] { return distance_m(0, 0, 0) < 2.0 && fastest_rotor(truth().back()) < 10.0; }));
  control_ = start("swiftlet-control");
  ASSERT_TRUE(reported(Mode::kDisarmed, "started")) << mode_log();
  if (tilt_rad(truth().back()) > 0.3) return;  // the vehicle lies on its side
  hover();
}

TEST_F(Failsafe, RotorsStopAndStayOffWhenCommandsCease) {
  start_all();
  hover();
  control_->signal(SIGSTOP);
  ASSERT_TRUE(wait_until_rotors_off());
  wait_vehicle_time(1.2);  // below the liveliness lease, after which peers treat it as dead
  control_->signal(SIGCONT);
  ASSERT_TRUE(reported(Mode::kStopped, "IMU samples were missing") ||
              reported(Mode::kStopped, "tipped over", 1s))
      << mode_log();
  ASSERT_TRUE(wait_until_rotors_off());
  clear_history();
  wait_vehicle_time(1.0);
  for (const record::TruthRow& row : truth()) ASSERT_LT(fastest_rotor(row), 100.0);
}

// A fault of the simulation at a time up to which the test lets time advance when the vehicle hovers.
class FailsafeAtATime : public Failsafe {
 protected:
  static constexpr double kFault_s = 14.0;

  void hover_until(const std::string& fault) {
    const std::string simulation =
        simulation_with("  - {" + fault + ", at_s: " + std::to_string(kFault_s) + "}\n");
    control_ = start("swiftlet-control", {"--clock", "lockstep"});
    mocap_ = start("swiftlet-mocap", {"--clock", "lockstep", "--simulation", simulation});
    plant_ = start("swiftlet-plant", {"--clock", "lockstep", "--paused", "--simulation", simulation});
    clock_.up_to(std::llround((kFault_s - 0.1) * 1e9));
    hover();
  }
  void go_on() { clock_.without_end(); }
  // Lets time advance up to then.
  bool rotors_run_at(double time_s) {
    const std::int64_t stamp_ns = std::llround(time_s * 1e9);
    clock_.up_to(stamp_ns);
    EXPECT_TRUE(client_->wait(kTimeout, [&](const View& view) {
      return view.vehicle.message.paused() && view.vehicle.message.stamp_ns() >= stamp_ns - 2'000'000;
    }));
    return client_->view().vehicle.message.rotors_running();
  }

 private:
  ground::SimulationClockPublisher clock_{*watcher_, std::numeric_limits<std::int64_t>::max() / 2};
};

TEST_F(FailsafeAtATime, HoldsWhenMocapReturns) {
  hover_until("kind: mocap_stop, for_s: 1.2");
  go_on();
  ASSERT_TRUE(reported(Mode::kDescent, "no mocap pose")) << mode_log();
  ASSERT_TRUE(reported(Mode::kHolding, "pose regained")) << mode_log();
  wait_vehicle_time(3.0);
  EXPECT_GT(lowest_m(), 0.3);
  EXPECT_LT(client_->view().estimate.message.velocity_ned()[2], 0.05);
}

TEST_F(FailsafeAtATime, RotorsStopAndStayOffWhenTheImuFallsSilent) {
  hover_until("kind: imu_stop, for_s: 1.5");
  // By the vehicle's own time-out of 0.5 s.
  EXPECT_TRUE(rotors_run_at(kFault_s + 0.35));
  EXPECT_FALSE(rotors_run_at(kFault_s + 0.65));
  go_on();
  ASSERT_TRUE(reported(Mode::kStopped, "IMU samples were missing") ||
              reported(Mode::kStopped, "tipped over", 1s))
      << mode_log();
  clear_history();
  wait_vehicle_time(1.0);
  for (const record::TruthRow& row : truth()) ASSERT_LT(fastest_rotor(row), 100.0);
}

TEST_F(Failsafe, HoldsInsideTheFenceWhenSetpointsLeaveIt) {
  start_all(
      {"--control", settings_with("fence_max_ned_m: [3.0, 3.0, 0.0]", "fence_max_ned_m: [0.6, 3.0, 0.0]")});
  hover();
  auto setpoints = watcher_->publish(messages::topics::kSetpoint);
  ASSERT_TRUE(eventually([&] { return setpoints.matched() == 1; }));
  // By the vehicle's clock: 0.4 m/s northwards, through the fence.
  const std::int64_t start_ns = stamp_ns();
  control::Setpoint setpoint;
  setpoint.position_ned.z() = -1.0;
  ASSERT_TRUE(eventually(
      [&] {
        const double elapsed_s = static_cast<double>(stamp_ns() - start_ns) * 1e-9;
        setpoint.stamp_ns = stamp_ns();
        ++setpoint.sequence;
        setpoint.position_ned.x() = 0.4 * elapsed_s;
        setpoint.velocity_ned.x() = 0.4;
        setpoints.publish(messages::to_message(setpoint));
        return elapsed_s > 4.0;
      },
      kTimeout));
  EXPECT_TRUE(reported(Mode::kSetpoint, "setpoints received")) << mode_log();
  EXPECT_TRUE(reported(Mode::kHolding, "setpoints stopped")) << mode_log();
  wait_vehicle_time(1.0);
  double farthest_north = 0.0;
  for (const record::TruthRow& row : truth()) farthest_north = std::max(farthest_north, row.position_ned[0]);
  EXPECT_GT(farthest_north, 0.3);
  // The reference stops before the fence; the vehicle overshoots the stop by up to 3 cm.
  EXPECT_LT(farthest_north, 0.635) << "overshoots the fence at 0.6 m by more than 3.5 cm";
  EXPECT_EQ(client_->view().control.message.mode(), static_cast<std::uint8_t>(Mode::kHolding));
}

// CLOCK_REALTIME of a process that the test steps.
class SteppedClock {
 public:
  explicit SteppedClock(std::string file) : file_(std::move(file)) {
    const int opened = open(file_.c_str(), O_RDWR | O_CLOEXEC);
    shift_s_ = static_cast<std::int64_t*>(
        mmap(nullptr, sizeof(std::int64_t), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0));
    close(opened);
  }
  ~SteppedClock() { munmap(shift_s_, sizeof(std::int64_t)); }
  SteppedClock(const SteppedClock&) = delete;
  SteppedClock& operator=(const SteppedClock&) = delete;

  void step(std::int64_t seconds) { *shift_s_ = *shift_s_ + seconds; }
  // Programs started from now on have this clock.
  void preload(const char* drift_ppm = "0") const {
    setenv("SWIFTLET_CLOCK_SHIFT", file_.c_str(), 1);
    setenv("SWIFTLET_CLOCK_DRIFT_PPM", drift_ppm, 1);
    setenv("LD_PRELOAD", SWIFTLET_PRELOADS, 1);
  }
  static void stop_preloading() {
    for (const char* const variable : {"LD_PRELOAD", "SWIFTLET_CLOCK_SHIFT", "SWIFTLET_CLOCK_DRIFT_PPM"})
      unsetenv(variable);
  }

 private:
  const std::string file_;
  std::int64_t* shift_s_ = nullptr;
};

class SteppedClocks : public Failsafe {
 protected:
  std::string file_of(const std::string& name) const {
    return folder_.write(name, std::string(sizeof(std::int64_t), '\0'));
  }
  double farthest_from_hover_m() const {
    double farthest = 0.0;
    for (const record::TruthRow& row : truth()) {
      farthest =
          std::max(farthest, std::hypot(row.position_ned[0], row.position_ned[1], row.position_ned[2] + 1.0));
    }
    return farthest;
  }

  SteppedClock of_control_{file_of("control")}, of_plant_{file_of("plant")}, of_mocap_{file_of("mocap")};
};

// Frames are due every 10 ms of the vehicle's clock; ground truth reaches motion capture a little later.
void expect_frames_on_time(const std::vector<std::int64_t>& stamps_ns) {
  constexpr std::int64_t kPeriodNs = 10'000'000;
  std::vector<std::int64_t> late_ns;
  for (const std::int64_t stamp_ns : stamps_ns)
    late_ns.push_back((stamp_ns + kPeriodNs / 2) % kPeriodNs - kPeriodNs / 2);
  std::sort(late_ns.begin(), late_ns.end());
  EXPECT_GT(late_ns[late_ns.size() / 2], -500'000);
  EXPECT_LT(late_ns[late_ns.size() / 2], 2'000'000);
}

// Clocks of one process, and of several at once. Motion capture stamps its frames with the clock of its host: 3 s ahead, 50 ppm
// fast, and set in flight; they are translated to the vehicle's. By the wall clock: the stamps of frames are those of the host.
TEST_F(SteppedClocks, DoNotDisturbTheFlight) {
  Inbox<std::int64_t> stamps_ns;
  const auto poses = watcher_->subscribe<msg::MocapPose>(
      messages::topics::kMocapPose, [&](const auto& pose) { stamps_ns.put(pose.stamp_ns()); });
  of_mocap_.step(3);
  of_mocap_.preload("50");
  mocap_ = start("swiftlet-mocap", {"--frame-clock", "host"});
  of_control_.preload();
  control_ = start("swiftlet-control");
  of_plant_.preload();
  plant_ = start("swiftlet-plant");
  SteppedClock::stop_preloading();
  hover();
  for (const auto& [of_plant, step] : {std::pair{false, 3600}, std::pair{true, -7200}}) {
    of_control_.step(step);
    if (of_plant) of_plant_.step(step);
    wait_vehicle_time(2.0);
    const ground::Result answer = ask(control::RequestKind::kHold);
    EXPECT_TRUE(answer.accepted()) << step << ": " << answer.reason;
    EXPECT_LT(client_->view().control.message.pose_age_s(), 0.2) << "after a step of " << step << " s";
  }
  EXPECT_LT(farthest_from_hover_m(), 0.05);

  Inbox<std::int64_t> offsets_ns;
  const auto clocks =
      watcher_->subscribe<msg::ClockStatus>(messages::topics::kClockStatus, [&](const auto& clock) {
        if (clock.known()) offsets_ns.put(clock.offset_ns());
      });
  // The simulated vehicle's clock stands still while its host does: those steps are shorter.
  const auto has_stepped = [&](double step_s, std::size_t since) {
    const std::vector<std::int64_t> known_ns = offsets_ns.items();
    for (std::size_t i = std::max<std::size_t>(since, 1); i < known_ns.size(); ++i) {
      if (std::abs(1e-9 * static_cast<double>(known_ns[i] - known_ns[i - 1]) - step_s) < 0.5) return true;
    }
    return false;
  };
  for (const std::int64_t step : {1, -1}) {
    ASSERT_TRUE(eventually([&] { return offsets_ns.size() > 0; }, kTimeout)) << mocap_->errors();
    const std::size_t before = offsets_ns.size();
    const std::uint64_t steps = client_->view().clock.message.steps();
    of_mocap_.step(step);
    ASSERT_TRUE(eventually(
        [&] {
          return has_stepped(static_cast<double>(step), before) &&
                 client_->view().clock.message.steps() > steps;
        },
        kTimeout))
        << mocap_->errors();
    wait_vehicle_time(1.0);
  }
  EXPECT_TRUE(settles_at(0, 0, -1));
  EXPECT_EQ(mode_log(), "holding: take-off completed\nholding: requested\n") << mocap_->errors();
  EXPECT_GT(lowest_m(), 0.95);

  expect_frames_on_time(stamps_ns.items());
}

}  // namespace
}  // namespace swiftlet::tests
