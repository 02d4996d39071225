// Setpoint streams and the examples with running processes.
#include <cmath>
#include <cstdio>

#include "tests/support/hop_mission.hpp"
#include "tests/support/online_flight.hpp"

namespace swiftlet::tests {
namespace {

// At twice real time: the setpoints come from another process, which has to keep up with the vehicle's clock.
class StreamFlight : public OnlineFlight {
 protected:
  void SetUp() override { start("2"); }

  std::string circle(double rate_hz, double duration_s) const {
    std::string rows = "t [s],x_ned [m],y_ned [m],z_ned [m],vx_ned [m/s],vy_ned [m/s],vz_ned [m/s]\n";
    for (int i = 0; i <= static_cast<int>(duration_s * rate_hz); ++i) {
      const double t = i / rate_hz;
      const double angle = 0.5 * t;
      char row[160];
      std::snprintf(row, sizeof row, "%.3f,%.4f,%.4f,-0.6,%.4f,%.4f,0\n", t, 0.4 * (std::cos(angle) - 1.0),
                    0.4 * std::sin(angle), -0.2 * std::sin(angle), 0.2 * std::cos(angle));
      rows += row;
    }
    return folder_.write("circle.csv", rows);
  }
};

TEST_F(StreamFlight, FliesAFileOfPositionsAndHolds) {
  const std::string file = circle(10.0, 4.0);
  const ProgramResult on_ground = swiftlet({"stream", file});
  EXPECT_EQ(on_ground.exit_code, 1);
  EXPECT_NE(on_ground.errors.find("setpoints are not accepted while disarmed"), std::string::npos)
      << on_ground.errors;
  take_off();
  const ProgramResult result = swiftlet({"stream", file, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("sent"), 41);
  EXPECT_EQ(report.at("refused"), 0);
  EXPECT_GT(report.at("accepted"), 20);
  EXPECT_EQ(report.at("mode"), "holding");
  EXPECT_NEAR(report.at("duration_s").get<double>(), 4.0, 0.5);
  EXPECT_EQ(state().mode_reason, "setpoints stopped");
  EXPECT_NEAR(state().position_ned_m.y(), 0.4 * std::sin(2.0), 0.25);
}

// The flight of a record; then streams of which setpoints are refused, at the end and on the way.
TEST_F(StreamFlight, FliesTheReferenceOfARecordAndNamesWhatIsRefused) {
  const ProgramResult flown = run_program(
      "swiftlet",
      {"sim", "fly", folder_.write("hop.yaml", kHopMission), "--record", folder_.path() / "first"},
      folder_.path());
  ASSERT_EQ(flown.exit_code, 0) << flown.errors;
  const std::string table = folder_.path() / "hop.csv";
  const ProgramResult written =
      run_program("swiftlet", {"log", "csv", folder_.path() / "first", "-o", table}, folder_.path());
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  take_off();
  const ProgramResult result = swiftlet({"stream", table, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
  EXPECT_EQ(json::parse(result.output).at("refused"), 0);
  EXPECT_TRUE(reaches_place(0.5, -0.3, -0.7)) << "the hop before its landing";

  const std::string low = folder_.write("low.csv",
                                        "t [s],x_ned [m],y_ned [m],z_ned [m]\n"
                                        "0,0.5,-0.3,-0.6\n0.4,0.5,-0.3,-0.5\n0.8,0.5,-0.3,-0.05\n");
  const ProgramResult below = swiftlet({"stream", low, "--json"});
  EXPECT_EQ(below.exit_code, 1) << below.output;
  const std::string reason = json::parse(below.output).at("reason");
  EXPECT_NE(reason.find("1 of 3 setpoints refused: setpoint: z = -0.050 m is 0.050 m above the ground"),
            std::string::npos)
      << reason;

  const std::string out =
      folder_.write("out.csv", "t [s],vx_ned [cm/s],vy_ned [cm/s],vz_ned [cm/s]\n0,150,0,0\n9,150,0,0\n");
  const ProgramResult slow = swiftlet({"stream", out});
  EXPECT_EQ(slow.exit_code, 2);
  EXPECT_NE(slow.errors.find("the row after t = 0.000 s is 9.000 s later, limit 0.5 s"), std::string::npos)
      << slow.errors;
  const ProgramResult outside = swiftlet({"stream", out, "--rate", "5", "--land"});
  EXPECT_EQ(outside.exit_code, 1);
  EXPECT_NE(outside.errors.find(" setpoints refused: setpoint: stopping point: x is"), std::string::npos)
      << outside.errors;
  EXPECT_EQ(outside.errors.find("setpoints stopped"), std::string::npos) << outside.errors;
  EXPECT_NE(outside.output.find("now disarmed at ("), std::string::npos) << outside.output;
  EXPECT_LT(state().position_ned_m.x(), 3.0);
}

ProgramResult example(const std::string& name, int domain) {
  const TemporaryFolder folder;
  return run_program(name, {"kl7", std::to_string(domain)}, folder.path(), kStuck);
}

TEST(Examples, ExplainTheirArguments) {
  const TemporaryFolder folder;
  for (const std::string name : {"example-fly-square", "example-stream-circle", "example-fly-mission"}) {
    const ProgramResult help = run_program(name, {"--help"}, folder.path());
    EXPECT_EQ(help.exit_code, 0) << name << help.errors;
    EXPECT_NE(help.output.find(" [VEHICLE] [DOMAIN] [--open-network]\n"), std::string::npos) << help.output;
    EXPECT_EQ(run_program(name, {"file", "kl7", "domain"}, folder.path()).exit_code, 2) << name;
    EXPECT_EQ(run_program(name, {"--fast"}, folder.path()).exit_code, 2) << name;
  }
  const ProgramResult name = run_program("example-fly-square", {"kl 7", "0"}, folder.path());
  EXPECT_EQ(name.exit_code, 1);
  EXPECT_NE(name.errors.find("kl 7"), std::string::npos) << name.errors;
  EXPECT_EQ(run_program("example-fly-mission", {}, folder.path()).exit_code, 2);
}

TEST_F(OnlineFlight, ExampleFliesASquare) {
  const ProgramResult result = example("example-fly-square", lock_.domain());
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  EXPECT_NE(result.output.find("land: done"), std::string::npos) << result.output;
  EXPECT_TRUE(reaches_mode(control::Mode::kDisarmed));
}

TEST_F(StreamFlight, ExampleStreamsACircle) {
  const ProgramResult result = example("example-stream-circle", lock_.domain());
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  const std::size_t at = result.output.find("up to ");
  ASSERT_NE(at, std::string::npos) << result.output;
  EXPECT_NEAR(std::stod(result.output.substr(at + 6)), 1.0, 0.05);
  EXPECT_TRUE(reaches_mode(control::Mode::kDisarmed));
}

TEST_F(StreamFlight, ExampleFliesAMissionFileAndStreams) {
  const std::string file =
      folder_.write("there.yaml",
                    "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.8, speed_m_s: 0.8}\n"
                    "  - {kind: waypoint, position_m: [-0.5, 0, -0.6], speed_m_s: 0.8}\n");
  const ProgramResult result = run_program(
      "example-fly-mission", {file, "kl7", std::to_string(lock_.domain())}, folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  for (const char* line :
       {"control process connected: ", "arm: done\n", "take off: done\n", "mission: done\n", "land: done\n"})
    EXPECT_NE(result.output.find(line), std::string::npos) << line << "\n" << result.output;
  EXPECT_TRUE(reaches_mode(control::Mode::kDisarmed));
  EXPECT_NEAR(state().position_ned_m.x(), -0.1, 0.2) << "0.2 m/s north for 2 s";
}

}  // namespace
}  // namespace swiftlet::tests
