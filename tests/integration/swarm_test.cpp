// Fleets from a file, flown over DDS.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A table of `swiftlet log csv`, by column.
using Table = std::map<std::string, std::vector<double>>;

Table read_table(const fs::path& csv) {
  std::ifstream file(csv);
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = fields_of(line);
  Table table;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    for (std::size_t i = 0; i < names.size(); ++i)
      table[names[i]].push_back(std::strtod(fields.at(i).c_str(), nullptr));
  }
  return table;
}

// The wall clock minus the vehicle's, ns: of the quickest of the IMU samples that were sent within these times, by the wall
// clock.
double clock_difference(const Table& imu, double from_ns, double to_ns) {
  double least_ns = std::numeric_limits<double>::infinity();
  const std::vector<double>&sent = imu.at("publish_time_ns"), &stamps = imu.at("stamp_ns");
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i] >= from_ns && sent[i] < to_ns) least_ns = std::min(least_ns, sent[i] - stamps[i]);
  }
  return least_ns;
}

// How a vehicle was started.
struct Start {
  double stamp_ns = 0.0;  // on its clock
  double wall_ns = 0.0;   // by the wall clock of this host
  double lost_ns = 0.0;   // by which its clock fell behind the host's before, while it was measured
};

Start start_of(const Table& command, const Table& imu) {
  Start start;
  const std::vector<double>& starts_ns = command.at("start_ns");  // 0 of other requests
  const auto last = std::find_if(starts_ns.rbegin(), starts_ns.rend(), [](double ns) { return ns > 0.0; });
  if (last == starts_ns.rend()) throw std::runtime_error("no mission was started");
  start.stamp_ns = *last;
  const double sent_ns =
      command.at("publish_time_ns").at(static_cast<std::size_t>(starts_ns.rend() - last) - 1);
  const double recorded_ns = imu.at("publish_time_ns").front();
  const double earlier_ns = clock_difference(imu, recorded_ns, recorded_ns + 0.2e9);
  const double later_ns = clock_difference(imu, sent_ns - 0.2e9, sent_ns);
  start.wall_ns = start.stamp_ns + later_ns;
  start.lost_ns = std::abs(later_ns - earlier_ns);
  return start;
}

// In lockstep all vehicles have one clock.
Start on_common_clock(Start start) {
  start.wall_ns = start.stamp_ns;
  return start;
}

// The time at which the climb begins, ns since the start. Its reference is a quintic that begins and ends without
// acceleration, so that the vertical acceleration is a cubic: this is its root before the samples from which it is
// found.
double climb_begin_after(const Table& reference, double start_ns) {
  const std::vector<double>&stamps = reference.at("stamp_ns"), &up = reference.at("acceleration_ned[2]");
  constexpr std::size_t kSamples = 4, kApart = 4;
  std::vector<double> t_s, a;
  for (std::size_t i = 0; i < up.size() && t_s.size() < kSamples * kApart; ++i) {
    if (stamps[i] < start_ns || (t_s.empty() && up[i] > -0.1)) continue;
    t_s.push_back(1e-9 * (stamps[i] - start_ns));
    a.push_back(up[i]);
  }
  if (t_s.size() < kSamples * kApart) return std::numeric_limits<double>::quiet_NaN();
  const auto cubic = [&](double at_s) {  // Lagrange
    double sum = 0.0;
    for (std::size_t i = 0; i < t_s.size(); i += kApart) {
      double term = a[i];
      for (std::size_t j = 0; j < t_s.size(); j += kApart)
        if (j != i) term *= (at_s - t_s[j]) / (t_s[i] - t_s[j]);
      sum += term;
    }
    return sum;
  };
  double before_s = t_s.front() - 0.1, after_s = t_s.front();
  if (cubic(before_s) <= 0.0 || cubic(after_s) >= 0.0) return std::numeric_limits<double>::quiet_NaN();
  while (after_s - before_s > 1e-9) {
    const double middle_s = 0.5 * (before_s + after_s);
    (cubic(middle_s) > 0.0 ? before_s : after_s) = middle_s;
  }
  return 1e9 * after_s;
}

// The vertical reference, m down, at a time after the start.
double z_after(const Table& reference, double start_ns, double after_ns) {
  const std::vector<double>&stamps = reference.at("stamp_ns"), &z = reference.at("position_ned[2]");
  const auto next = std::lower_bound(stamps.begin(), stamps.end(), start_ns + after_ns);
  if (next == stamps.begin() || next == stamps.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(next - stamps.begin());
  const double part = (start_ns + after_ns - stamps[i - 1]) / (stamps[i] - stamps[i - 1]);
  return z[i - 1] + part * (z[i] - z[i - 1]);
}

class SwarmFlight : public testing::Test {
 protected:
  SwarmFlight() {
    folder_.write("hop.yaml",
                  "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5}\n"
                  "  - {kind: land, speed_m_s: 0.4}\n");
  }
  std::string fleet(const std::string& other_vehicle) const {
    return folder_.write(
        "f.yaml",
        "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.4, radius_z_m: 0.6}\nvehicles:\n"
        "  - {name: a, start_m: [0.5, -1], mission: hop.yaml}\n"
        "  - {name: b, start_m: [0.5, 1], mission: hop.yaml, vehicle: " +
            other_vehicle + "}\n");
  }
  ProgramResult fly(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"fleet", "fly", file, "--record", record().string(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program("swiftlet", words, folder_.path(), kStuck);
  }
  // A topic of the last flight.
  Table recorded(const std::string& topic) const {
    const fs::path csv = folder_.path() / "topic.csv";
    const ProgramResult written = run_program(
        "swiftlet",
        {"log", "csv", (record() / "flight.mcap").string(), topic, "--output", csv.string(), "--replace"},
        folder_.path(), kStuck);
    EXPECT_EQ(written.exit_code, 0) << written.errors;
    return read_table(csv);
  }
  // Their climbs begin within this time of each other, by the wall clock, and they climb alike by their own clocks, each from the
  // height to which its lift-off has carried it at the end of the spool-up: a few millimetres.
  void expect_same_climb(const Start& a, const Start& b, double within_ns) const {
    const Table of_a = recorded("/a/reference"), of_b = recorded("/b/reference");
    const double begins_a_ns = climb_begin_after(of_a, a.stamp_ns);
    const double begins_b_ns = climb_begin_after(of_b, b.stamp_ns);
    EXPECT_NEAR(begins_a_ns, kSpoolUp_ns, 0.5e6);
    EXPECT_NEAR(a.wall_ns + begins_a_ns, b.wall_ns + begins_b_ns, within_ns);
    RecordProperty("climbs_apart_us",
                   static_cast<int>(1e-3 * (a.wall_ns - b.wall_ns + begins_a_ns - begins_b_ns)));
    double highest_m = 0.0;
    for (double after_ns = 1e9; after_ns < 3e9; after_ns += 1e7) {
      const double z_a = z_after(of_a, a.stamp_ns, after_ns), z_b = z_after(of_b, b.stamp_ns, after_ns);
      EXPECT_NEAR(z_a, z_b, 5e-3) << 1e-9 * after_ns << " s after the start";
      highest_m = std::max(highest_m, -z_a);
    }
    EXPECT_GT(highest_m, 0.5);
  }
  fs::path record() const { return folder_.path() / "record"; }

  static constexpr double kSpoolUp_ns = 0.8e9;
  static constexpr double kSteady_ns = 0.3e6;  // what is read of steady clocks
  TemporaryFolder folder_;
};

TEST_F(SwarmFlight, FliesVehiclesOfTwoFilesFromTheirPlaces) {
  const ProgramResult result = fly(fleet("kaylion"), {"--clock", "lockstep"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_NE(result.errors.find("without monitor, because it is not in real time"), std::string::npos)
      << result.errors;
  EXPECT_EQ(report.at("vehicles")[0].at("vehicle"), "crazyflie2");
  EXPECT_EQ(report.at("vehicles")[1].at("vehicle"), "kaylion");
  EXPECT_EQ(report.at("vehicles")[0].at("start_m"), json({0.5, -1.0}));
  EXPECT_EQ(report.at("vehicles")[1].at("start_m"), json({0.5, 1.0}));
  EXPECT_TRUE(fs::exists(record() / "swiftlet-plant-kaylion.log"));
  const Start a = start_of(recorded("/a/command"), recorded("/a/imu"));
  const Start b = start_of(recorded("/b/command"), recorded("/b/imu"));
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
  expect_same_climb(on_common_clock(a), on_common_clock(b), 0.5e6);
  // The recording has the files of both.
  const ProgramResult reported =
      run_program("swiftlet", {"report", record() / "flight.mcap", "--json"}, folder_.path());
  ASSERT_EQ(reported.exit_code, 0) << reported.errors;
  const json flights = json::parse(reported.output).at("flights");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string model = i == 0 ? "crazyflie2" : "kaylion";
    EXPECT_EQ(flights[i].at("report").at("vehicle"), model);
    EXPECT_EQ(flights[i].at("settings").at("vehicle.name"), model);
  }
}

TEST_F(SwarmFlight, SixVehiclesChangePlaces) {
  const ProgramResult result = fly("swap6", {"--clock", "lockstep"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  ASSERT_EQ(report.at("vehicles").size(), 6U);
  for (const json& vehicle : report.at("vehicles")) EXPECT_EQ(vehicle.at("completed"), true) << vehicle;
}

TEST_F(SwarmFlight, RefusesTwoThatLandOnOneSpot) {
  folder_.write(
      "meet.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 1, -1], speed_m_s: 0.5}\n  - {kind: land, speed_m_s: 0.4}\n");
  const std::string file = folder_.write(
      "crossing.yaml",
      "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.15, radius_z_m: 0.3}\nvehicles:\n"
      "  - {name: a, start_m: [0, 0], mission: meet.yaml}\n  - {name: b, start_m: [2.5, 0], mission: "
      "meet.yaml}\n");
  const ProgramResult result = fly(file);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("a and b come too near: 0.000 m apart at "), std::string::npos)
      << result.errors;
  EXPECT_FALSE(fs::exists(record()));
}

// GIVEN two vehicles in real time WHEN they start THEN their starts differ by 2 ms at most, besides what their clocks lose
// while they are measured, as on a computer that stalls.
// WHEN its pilot pauses one, and the other one is to pass the same place after it THEN that waits, the pilot's is not resumed,
// and both go on when the pilot resumes it.
TEST_F(SwarmFlight, StartsWithinTwoMillisecondsAndWaitsForOneThatThePilotHasPaused) {
  folder_.write(
      "first.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1.5, 0, -0.6], speed_m_s: 0.3}\n  - {kind: land, speed_m_s: 0.4}\n");
  folder_.write(
      "second.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n"
      "  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5, hold_s: 8}\n"
      "  - {kind: waypoint, position_m: [0, 1.5, -0.6], speed_m_s: 0.3}\n  - {kind: land, speed_m_s: 0.4}\n");
  const std::string file = folder_.write(
      "cross.yaml",
      "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.2, radius_z_m: 0.3}\nvehicles:\n"
      "  - {name: a, start_m: [-1.5, 0], mission: first.yaml}\n  - {name: b, start_m: [0, -1.5], mission: "
      "second.yaml}\n");
  Program fly("swiftlet", {"fleet", "fly", file, "--record", record().string(), "--json"}, folder_.path());
  const auto said = [&](const std::string& text) { return fly.errors().find(text) != std::string::npos; };
  ASSERT_TRUE(eventually([&] { return said("2/3 waypoint") || fly.exit_code(); })) << fly.errors();
  const std::size_t at = fly.errors().find(" in domain ");
  ASSERT_NE(at, std::string::npos);
  const std::string domain = std::to_string(std::stoi(fly.errors().substr(at + 11)));
  const auto pilot = [&](const char* what) {
    return run_program(
        "swiftlet",
        {"mission", what, "--vehicle-name", "a", "--no-wait", "--localhost-only", "--domain", domain},
        folder_.path());
  };
  const ProgramResult paused = pilot("pause");
  ASSERT_EQ(paused.exit_code, 0) << paused.errors;
  EXPECT_TRUE(eventually([&] { return said("b: waits for a"); })) << fly.errors();
  const ProgramResult status = run_program(
      "swiftlet", {"status", "--json", "--vehicle-name", "a", "--localhost-only", "--domain", domain},
      folder_.path());
  EXPECT_EQ(json::parse(status.output).at("mission").at("state"), "paused")
      << "nobody but the pilot resumes it";
  EXPECT_FALSE(said("a: goes on")) << fly.errors();
  const ProgramResult resumed = pilot("resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  ASSERT_EQ(fly.wait(kStuck), 0) << fly.errors();
  for (const json& vehicle : json::parse(fly.output()).at("vehicles"))
    EXPECT_EQ(vehicle.at("completed"), true);
  EXPECT_TRUE(said("b: goes on")) << fly.errors();
  EXPECT_FALSE(said("without monitor")) << fly.errors();

  const Start a = start_of(recorded("/a/command"), recorded("/a/imu"));
  const Start b = start_of(recorded("/b/command"), recorded("/b/imu"));
  const double lost_ns = a.lost_ns + b.lost_ns;
  const double within_ns = lost_ns > kSteady_ns ? 2e6 + lost_ns : 2e6;
  EXPECT_NEAR(a.wall_ns, b.wall_ns, within_ns);
  RecordProperty("difference_us", static_cast<int>(1e-3 * std::abs(a.wall_ns - b.wall_ns)));
  expect_same_climb(a, b, within_ns);
}

}  // namespace
}  // namespace swiftlet::tests
