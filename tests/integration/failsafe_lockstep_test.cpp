// What goes wrong with the sensors and the vehicle, flown by real processes in lockstep: one fault a flight,
// at the same place in each. What the vehicle did is told by its trace, which is ground truth.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/text_file.hpp"
#include "tests/integration/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr double kFault_s = 8.0;  // simulated time; the vehicle hovers at 1 m by then

const std::string kHover =
    "name: hover\nframe: ned\ntolerance_m: 0.1\nitems:\n"
    "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.8, hold_s: 12}\n"
    "  - {kind: land, speed_m_s: 0.4}\n";

struct Moment {
  double time_s = 0.0;
  double north_m = 0.0, east_m = 0.0, height_m = 0.0;
  double sink_m_s = 0.0;
  double tilt_rad = 0.0;
  bool on_ground = false;
  bool commanded = false;  // the rotors are told to turn
};

// The columns of trace.csv:
// t_ns,px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1..om4,v_s,on_ground,mocap_frame,running,...
std::vector<Moment> read_trace(const std::filesystem::path& file) {
  std::vector<Moment> moments;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<double> v;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    if (v.size() < 22) break;
    Moment moment;
    moment.time_s = v[0] * 1e-9;
    moment.north_m = v[1];
    moment.east_m = v[2];
    moment.height_m = -v[3];
    moment.sink_m_s = v[6];
    moment.tilt_rad = std::acos(std::clamp(1.0 - 2.0 * (v[8] * v[8] + v[9] * v[9]), -1.0, 1.0));
    moment.on_ground = v[19] != 0.0;
    moment.commanded = v[21] != 0.0;
    moments.push_back(moment);
  }
  return moments;
}

struct Flown {  // NOLINT(bugprone-exception-escape): json is moved without one
  json report;
  std::vector<Moment> after;  // from the fault on

  double last_commanded_s() const {
    double last = kFault_s;
    for (const Moment& moment : after) {
      if (moment.commanded) last = moment.time_s;
    }
    return last;
  }
  double most_tilt_rad() const {
    double most = 0.0;
    for (const Moment& moment : after) most = std::max(most, moment.tilt_rad);
    return most;
  }
  double fastest_sink() const {
    double fastest = 0.0;
    for (const Moment& moment : after) fastest = std::max(fastest, moment.sink_m_s);
    return fastest;
  }
  double farthest_m() const {
    double farthest = 0.0;
    for (const Moment& moment : after)
      farthest = std::max(farthest, std::hypot(moment.north_m, moment.east_m));
    return farthest;
  }
  // The vehicle stands when its rotors are stopped.
  void expect_landed() const {
    ASSERT_FALSE(after.empty());
    EXPECT_TRUE(after.back().on_ground) << after.back().height_m;
    EXPECT_FALSE(after.back().commanded);
    EXPECT_LT(after.back().tilt_rad, 0.1);
  }
};

class FaultInFlight : public testing::Test {
 protected:
  // parameters: what the fault needs beside its kind, as YAML.
  Flown fly(const std::string& kind, const std::string& for_s, const std::string& parameters = "",
            double at_s = kFault_s) {
    std::string simulation = runtime::read_text_file(SWIFTLET_SOURCE_DIR "/config/simulation/default.yaml");
    simulation += "faults:\n  - {kind: " + kind + ", at_s: " + std::to_string(at_s) + ", for_s: " + for_s +
                  (parameters.empty() ? "" : ", " + parameters) + "}\n";
    const std::string file = folder_.write("faulty.yaml", simulation);
    const auto record = folder_.path() / "record";
    const Ending ending =
        run_program("swiftlet",
                    {"fly", folder_.write("hover.yaml", kHover), "--simulation", file, "--clock", "lockstep",
                     "--trace", "--json", "--record", record.string()},
                    folder_.path(), 120s);
    Flown flown;
    flown.report = json::parse(ending.output, nullptr, false);
    EXPECT_TRUE(flown.report.is_object()) << ending.errors;
    for (const Moment& moment : read_trace(record / "trace.csv")) {
      if (moment.time_s >= at_s) flown.after.push_back(moment);
    }
    return flown;
  }
  static std::string reason(const Flown& flown) { return flown.report.value("reason", "completed"); }

  TemporaryFolder folder_;
};

void expect_descended_level(const Flown& flown) {
  flown.expect_landed();
  EXPECT_LT(flown.most_tilt_rad(), 0.15);
  EXPECT_LT(flown.fastest_sink(), 0.8);
  EXPECT_LT(flown.farthest_m(), 1.0);
}

TEST_F(FaultInFlight, MocapStopsItDescendsLevel) {
  const Flown flown = fly("mocap_stop", "60");
  EXPECT_EQ(reason(flown), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, MocapFreezesItDescendsLevel) {
  const Flown flown = fly("mocap_freeze", "60");
  EXPECT_EQ(reason(flown), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, MocapLosesTheMarkersItDescendsLevel) {
  const Flown flown = fly("mocap_untracked", "60");
  EXPECT_EQ(reason(flown), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, MocapTakesTheMarkersForOthersItDescendsLevel) {
  const Flown flown = fly("mocap_jump", "60", "position_ned_m: [0, 0, 0], rotation_frd_rad: [0, 0, 3.1416]");
  EXPECT_EQ(reason(flown), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, MocapIsGoneForAMomentItFliesOn) {
  const Flown flown = fly("mocap_stop", "0.3");
  EXPECT_EQ(reason(flown), "completed");
  EXPECT_LT(flown.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, MocapJumpsForAMomentItFliesOn) {
  const Flown flown =
      fly("mocap_jump", "0.15", "position_ned_m: [1.5, 0.5, 0.3], rotation_frd_rad: [0, 0, 0]");
  EXPECT_EQ(reason(flown), "completed");
  EXPECT_LT(flown.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, MocapSeesAnotherBodyForAMomentItFliesOn) {
  const Flown flown = fly("mocap_swap", "0.15", "position_ned_m: [-1, 2, 0], yaw_rad: 2");
  EXPECT_EQ(reason(flown), "completed");
  EXPECT_LT(flown.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, MocapShowsABodyThatStaysOnTheGroundTheRotorsStopJustAboveIt) {
  const Flown flown = fly("mocap_swap", "60", "position_ned_m: [1, -1, 0], yaw_rad: 2", 0.1);
  EXPECT_EQ(reason(flown), "the mission was aborted: poses do not follow the take-off; rotors stopped");
  EXPECT_FALSE(flown.after.back().commanded);
  double highest = 0.0;
  for (const Moment& moment : flown.after) highest = std::max(highest, moment.height_m);
  EXPECT_GT(highest, 0.05);
  EXPECT_LT(highest, 0.3);
}

TEST_F(FaultInFlight, TheImuGivesNoNumbersTheRotorsStop) {
  const Flown flown = fly("imu_nan", "60");
  EXPECT_EQ(reason(flown), "the mission was aborted: IMU samples are not usable; rotors stopped");
  EXPECT_NEAR(flown.last_commanded_s(), kFault_s + 0.1, 0.01);
}

TEST_F(FaultInFlight, TheImuGivesNoNumbersForAMomentItFliesOn) {
  const Flown flown = fly("imu_nan", "0.05");
  EXPECT_EQ(reason(flown), "completed");
}

TEST_F(FaultInFlight, TheBatteryIsLowItLands) {
  const Flown flown = fly("battery_drop", "60", "voltage_v: 0.8");
  EXPECT_EQ(reason(flown), "the mission was aborted: battery is low; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, TheBatteryIsCriticalItLandsFaster) {
  const Flown low = fly("battery_drop", "60", "voltage_v: 0.8");
  const Flown critical = fly("battery_drop", "60", "voltage_v: 1.0");
  EXPECT_EQ(reason(critical), "the mission was aborted: battery is critical; landed");
  critical.expect_landed();
  EXPECT_LT(critical.last_commanded_s(), low.last_commanded_s() - 0.5);
}

TEST_F(FaultInFlight, TheBatteryIsSilentItLands) {
  const Flown flown = fly("battery_stop", "60");
  EXPECT_EQ(reason(flown), "the mission was aborted: no battery voltage; landed");
  expect_descended_level(flown);
}

TEST_F(FaultInFlight, APushTipsItOverTheRotorsStop) {
  const Flown flown = fly("push", "0.1", "force_ned_n: [0, 0, 0], moment_frd_n_m: [0.02, 0, 0]");
  EXPECT_EQ(reason(flown), "the mission was aborted: tipped over; rotors stopped");
  EXPECT_LT(flown.last_commanded_s(), kFault_s + 0.5);
  EXPECT_NEAR(flown.after.back().tilt_rad, 1.4, 0.3) << "they stop as soon as it is beyond";
}

TEST_F(FaultInFlight, AGaleBlowsItOutOfTheFenceItLandsInside) {
  const Flown flown = fly("push", "1.6", "force_ned_n: [0.42, 0, 0], moment_frd_n_m: [0, 0, 0]");
  EXPECT_EQ(reason(flown), "the mission was aborted: outside the fence; landed");
  EXPECT_GT(flown.farthest_m(), 3.2);
  flown.expect_landed();
  EXPECT_LE(std::hypot(flown.after.back().north_m, flown.after.back().east_m), 3.05);
}

}  // namespace
}  // namespace swiftlet::tests
