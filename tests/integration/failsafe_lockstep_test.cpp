// Faults of sensors and vehicle: one fault per flight, at the same time in each. The vehicle's motion is read from its trace,
// which is ground truth. Flights that are completed are flown in one process: lockstep_test.cpp compares them with those of
// real processes in lockstep, bit for bit. Those that are aborted are flown in both ways here, and compared.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/text_file.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
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

struct TraceRow {
  double time_s = 0.0;
  double north_m = 0.0, east_m = 0.0, height_m = 0.0;
  double sink_m_s = 0.0;
  double tilt_rad = 0.0;
  bool on_ground = false;
  bool commanded = false;  // the rotors are commanded to run
};

// The columns of trace.csv:
// t_ns,px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1..om4,v_s,on_ground,mocap_frame,running,...
std::vector<TraceRow> read_trace(const std::filesystem::path& file) {
  std::vector<TraceRow> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<double> v;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    if (v.size() < 22) break;
    TraceRow row;
    row.time_s = v[0] * 1e-9;
    row.north_m = v[1];
    row.east_m = v[2];
    row.height_m = -v[3];
    row.sink_m_s = v[6];
    row.tilt_rad = std::acos(std::clamp(1.0 - 2.0 * (v[8] * v[8] + v[9] * v[9]), -1.0, 1.0));
    row.on_ground = v[19] != 0.0;
    row.commanded = v[21] != 0.0;
    rows.push_back(row);
  }
  return rows;
}

struct FaultFlight {  // NOLINT(bugprone-exception-escape): json is moved without one
  json report;
  std::string trace;
  std::vector<TraceRow> after;  // from the fault on

  double last_commanded_s() const {
    double last = kFault_s;
    for (const TraceRow& row : after) {
      if (row.commanded) last = row.time_s;
    }
    return last;
  }
  double most_tilt_rad() const {
    double most = 0.0;
    for (const TraceRow& row : after) most = std::max(most, row.tilt_rad);
    return most;
  }
  double fastest_sink() const {
    double fastest = 0.0;
    for (const TraceRow& row : after) fastest = std::max(fastest, row.sink_m_s);
    return fastest;
  }
  double farthest_m() const {
    double farthest = 0.0;
    for (const TraceRow& row : after) farthest = std::max(farthest, std::hypot(row.north_m, row.east_m));
    return farthest;
  }
  // The vehicle is on the ground and upright when its rotors stop.
  void expect_landed() const {
    ASSERT_FALSE(after.empty());
    EXPECT_TRUE(after.back().on_ground) << after.back().height_m;
    EXPECT_FALSE(after.back().commanded);
    EXPECT_LT(after.back().tilt_rad, 0.1);
  }
};

class FaultInFlight : public testing::Test {
 protected:
  // parameters: of the fault beside its kind, as YAML.
  FaultFlight fly(const std::string& kind, const std::string& for_s, const std::string& parameters = "",
                  double at_s = kFault_s) {
    return fly({"sim", "fly"}, kind, for_s, parameters, at_s);
  }
  FaultFlight fly_over_dds(const std::string& kind, const std::string& for_s = "60",
                           const std::string& parameters = "", double at_s = kFault_s) {
    const FaultFlight over_dds = fly({"fly", "--clock", "lockstep"}, kind, for_s, parameters, at_s);
    const FaultFlight in_process = fly(kind, for_s, parameters, at_s);
    EXPECT_EQ(reason(over_dds), reason(in_process));
    EXPECT_TRUE(over_dds.trace == in_process.trace);
    expect_same_record(flights_ - 1, flights_);
    return over_dds;
  }
  static std::string reason(const FaultFlight& flight) { return flight.report.value("reason", "completed"); }

 private:
  FaultFlight fly(std::vector<std::string> words, const std::string& kind, const std::string& for_s,
                  const std::string& parameters, double at_s) {
    std::string simulation = io::read_text_file(in_source("config/simulation/default.yaml"));
    simulation += "faults:\n  - {kind: " + kind + ", at_s: " + std::to_string(at_s) + ", for_s: " + for_s +
                  (parameters.empty() ? "" : ", " + parameters) + "}\n";
    const std::string file = folder_.write("faulty.yaml", simulation);
    const auto record = folder_.path() / ("record-" + std::to_string(++flights_));
    words.insert(words.end(), {folder_.write("hover.yaml", kHover), "--simulation", file, "--trace", "--json",
                               "--record", record.string()});
    const ProgramResult result = run_program("swiftlet", words, folder_.path(), kStuck);
    FaultFlight flight;
    flight.report = json::parse(result.output, nullptr, false);
    EXPECT_TRUE(flight.report.is_object()) << result.errors;
    flight.trace = io::read_text_file(record / "trace.csv");
    for (const TraceRow& row : read_trace(record / "trace.csv")) {
      if (row.time_s >= at_s) flight.after.push_back(row);
    }
    return flight;
  }

  record::Flight recorded(int flight) const {
    const auto file = folder_.path() / ("record-" + std::to_string(flight)) / record::kFlightFile;
    return record::read_flight(mcap::Reader(file), "kl1");
  }

  // The texts of the log in the record that tell of faults.
  std::vector<std::string> fault_lines(int flight) const {
    const mcap::Reader file(folder_.path() / ("record-" + std::to_string(flight)) / record::kFlightFile);
    std::vector<std::string> lines;
    mcap::Messages messages(file, {{"/log"}});
    while (messages.next()) {
      const mcap::ByteView payload = messages.message().payload;
      std::string text(payload.data, payload.data + payload.size);
      if (text.find("fault: ") != std::string::npos) lines.push_back(std::move(text));
    }
    return lines;
  }

  // How long a vehicle is recorded after its flight depends on the processes, and on a loaded computer samples may be lost on their
  // way to the record.
  void expect_same_record(int one, int other) const {
    const record::Flight a = recorded(one);
    const record::Flight b = recorded(other);
    const auto expect_same = [](const auto& rows_a, const auto& rows_b, const auto& equal) {
      std::size_t both = 0;
      auto b_row = rows_b.begin();
      for (const auto& a_row : rows_a) {
        while (b_row != rows_b.end() && b_row->stamp_ns < a_row.stamp_ns) ++b_row;
        if (b_row == rows_b.end() || b_row->stamp_ns != a_row.stamp_ns) continue;
        ASSERT_TRUE(equal(a_row, *b_row)) << a_row.stamp_ns;
        ++both;
      }
      EXPECT_GT(both, rows_b.size() * 4 / 5);
    };
    expect_same(a.truth, b.truth,
                [](const auto& p, const auto& q) { return p.position_ned == q.position_ned; });
    expect_same(a.reference, b.reference, [](const auto& p, const auto& q) {
      return p.mode == q.mode && p.position_ned == q.position_ned && p.thrust_n == q.thrust_n;
    });
    expect_same(a.estimate, b.estimate,
                [](const auto& p, const auto& q) { return p.position_ned == q.position_ned; });
    expect_same(a.commands, b.commands,
                [](const auto& p, const auto& q) { return p.throttle == q.throttle; });
    ASSERT_FALSE(a.mission.empty());
    ASSERT_FALSE(b.mission.empty());
    EXPECT_EQ(a.mission.back().state, b.mission.back().state);
    EXPECT_EQ(a.mission.back().reason, b.mission.back().reason);
    EXPECT_EQ(a.requests.size(), b.requests.size());
    for (const int flight : {one, other}) {
      const std::vector<std::string> lines = fault_lines(flight);
      ASSERT_EQ(lines.size(), 1U);
      EXPECT_EQ(recorded(flight).faults.size(), 1U);
      EXPECT_NE(lines.front().find("fault: " + recorded(flight).faults.front().text), std::string::npos);
    }
  }

  TemporaryFolder folder_;
  int flights_ = 0;
};

void expect_descended_level(const FaultFlight& flight) {
  flight.expect_landed();
  EXPECT_LT(flight.most_tilt_rad(), 0.15);
  EXPECT_LT(flight.fastest_sink(), 0.8);
  EXPECT_LT(flight.farthest_m(), 1.0);
}

TEST_F(FaultInFlight, DescendsLevelWhenMocapStops) {
  const FaultFlight flight = fly_over_dds("mocap_stop");
  EXPECT_EQ(reason(flight), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flight);
}

TEST_F(FaultInFlight, DescendsLevelWhenMocapFreezes) {
  const FaultFlight flight = fly_over_dds("mocap_freeze", "60");
  EXPECT_EQ(reason(flight), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flight);
}

TEST_F(FaultInFlight, DescendsLevelWhenMocapLosesTheMarkers) {
  const FaultFlight flight = fly_over_dds("mocap_untracked", "60");
  EXPECT_EQ(reason(flight), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flight);
}

TEST_F(FaultInFlight, DescendsLevelWhenMocapConfusesTheMarkers) {
  const FaultFlight flight =
      fly_over_dds("mocap_jump", "60", "position_ned_m: [0, 0, 0], rotation_frd_rad: [0, 0, 3.1416]");
  EXPECT_EQ(reason(flight), "the mission was aborted: no mocap pose; landed");
  expect_descended_level(flight);
}

// The vehicle holds where poses come back, until it is asked to land.
TEST_F(FaultInFlight, LandsWhenMocapComesBackInTheAir) {
  const FaultFlight flight = fly_over_dds("mocap_stop", "1");
  EXPECT_EQ(reason(flight), "the mission was aborted: no mocap pose; landed");
  flight.expect_landed();
  EXPECT_GT(flight.last_commanded_s(), kFault_s + 6.0);
}

TEST_F(FaultInFlight, StopsRotorsWhenTheImuComesBackTooLate) {
  const FaultFlight flight = fly_over_dds("imu_stop", "7");
  EXPECT_EQ(reason(flight), "the mission was aborted: IMU samples were missing; rotors stopped");
}

TEST_F(FaultInFlight, FliesOnAfterAShortMocapOutage) {
  const FaultFlight flight = fly("mocap_stop", "0.3");
  EXPECT_EQ(reason(flight), "completed");
  EXPECT_LT(flight.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, FliesOnAfterAShortMocapJump) {
  const FaultFlight flight =
      fly("mocap_jump", "0.15", "position_ned_m: [1.5, 0.5, 0.3], rotation_frd_rad: [0, 0, 0]");
  EXPECT_EQ(reason(flight), "completed");
  EXPECT_LT(flight.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, FliesOnAfterMocapBrieflyTracksAnotherBody) {
  const FaultFlight flight = fly("mocap_swap", "0.15", "position_ned_m: [-1, 2, 0], yaw_rad: 2");
  EXPECT_EQ(reason(flight), "completed");
  EXPECT_LT(flight.report.at("peak_3d_m"), 0.05);
}

TEST_F(FaultInFlight, StopsRotorsWhenPosesDoNotFollowTheTakeoff) {
  const FaultFlight flight = fly_over_dds("mocap_swap", "60", "position_ned_m: [1, -1, 0], yaw_rad: 2", 0.1);
  EXPECT_EQ(reason(flight), "the mission was aborted: poses do not follow the take-off; rotors stopped");
  EXPECT_FALSE(flight.after.back().commanded);
  double highest = 0.0;
  for (const TraceRow& row : flight.after) highest = std::max(highest, row.height_m);
  EXPECT_GT(highest, 0.05);
  EXPECT_LT(highest, 0.3);
}

TEST_F(FaultInFlight, StopsRotorsWhenTheImuSendsNaN) {
  const FaultFlight flight = fly_over_dds("imu_nan");
  EXPECT_EQ(reason(flight), "the mission was aborted: IMU samples are not usable; rotors stopped");
  EXPECT_NEAR(flight.last_commanded_s(), kFault_s + 0.1, 0.01);
}

TEST_F(FaultInFlight, FliesOnAfterAShortImuNaN) {
  const FaultFlight flight = fly("imu_nan", "0.05");
  EXPECT_EQ(reason(flight), "completed");
}

TEST_F(FaultInFlight, LandsWhenTheBatteryIsLowAndFasterWhenItIsCritical) {
  const FaultFlight low = fly_over_dds("battery_drop", "60", "voltage_v: 0.8");
  EXPECT_EQ(reason(low), "the mission was aborted: battery is low; landed");
  expect_descended_level(low);
  const FaultFlight critical = fly_over_dds("battery_drop", "60", "voltage_v: 1.0");
  EXPECT_EQ(reason(critical), "the mission was aborted: battery is critical; landed");
  critical.expect_landed();
  EXPECT_LT(critical.last_commanded_s(), low.last_commanded_s() - 0.5);
}

TEST_F(FaultInFlight, LandsWithoutBatterySamples) {
  const FaultFlight flight = fly_over_dds("battery_stop", "60");
  EXPECT_EQ(reason(flight), "the mission was aborted: no battery voltage; landed");
  expect_descended_level(flight);
}

TEST_F(FaultInFlight, StopsRotorsWhenTippedOver) {
  const FaultFlight flight =
      fly_over_dds("push", "0.1", "force_ned_n: [0, 0, 0], moment_frd_n_m: [0.02, 0, 0]");
  EXPECT_EQ(reason(flight), "the mission was aborted: tipped over; rotors stopped");
  EXPECT_LT(flight.last_commanded_s(), kFault_s + 0.5);
  EXPECT_NEAR(flight.after.back().tilt_rad, 1.4, 0.3) << "the rotors must stop right at the tilt limit";
}

TEST_F(FaultInFlight, LandsInsideTheFenceWhenBlownOut) {
  const FaultFlight flight =
      fly_over_dds("push", "1.6", "force_ned_n: [0.42, 0, 0], moment_frd_n_m: [0, 0, 0]");
  EXPECT_EQ(reason(flight), "the mission was aborted: outside the fence; landed");
  EXPECT_GT(flight.farthest_m(), 3.2);
  flight.expect_landed();
  EXPECT_LE(std::hypot(flight.after.back().north_m, flight.after.back().east_m), 3.05);
}

}  // namespace
}  // namespace swiftlet::tests
