// An external autopilot flies the plant over MAVLink: PX4's simulator interface.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <termios.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/scripted_autopilot.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;

constexpr const char* kScaled = "3";  // times real time, of an autopilot without lockstep

class Autopilot : public testing::Test {
 protected:
  std::vector<std::string> on_this_domain(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return arguments;
  }
  std::unique_ptr<Program> start_plant(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"--autopilot", "mavlink"});
    return std::make_unique<Program>("swiftlet-plant", on_this_domain(std::move(arguments)), folder_.path());
  }
  std::unique_ptr<Program> start_lockstep(std::vector<std::string> arguments = {}) const {
    arguments.insert(arguments.end(), {"--autopilot-port", std::to_string(port_), "--clock", "lockstep",
                                       "--autopilot-timeout", "60"});
    return start_plant(std::move(arguments));
  }
  std::unique_ptr<ScriptedAutopilot> autopilot(const ScriptedAutopilotSettings& settings = {}) const {
    return std::make_unique<ScriptedAutopilot>(vehicle_, plant::SiteSettings(), settings);
  }
  // The plant says this on standard error, or in its log there.
  bool says(const Program& plant, const std::string& text) const {
    return eventually([&] { return plant.errors().find(text) != std::string::npos; });
  }
  dds::NodeSettings node() const {
    dds::NodeSettings settings;
    settings.name = "watcher";
    settings.domain = lock_.domain();
    return settings;
  }

  const dds::DomainLock lock_;
  const TemporaryFolder folder_;
  const int port_ = 14'600 + 2 * lock_.domain();  // and the next one: nobody else's, as the domain
  const plant::Vehicle vehicle_ = io::load_vehicle(in_source("config/vehicles/kaylion.yaml"));
};

TEST_F(Autopilot, HoversInLockstepAndRepeatsExactly) {
  AutopilotLog logs[2];
  std::string traces[2];
  for (int run = 0; run < 2; ++run) {
    const auto trace = folder_.path() / ("trace" + std::to_string(run) + ".csv");
    const auto plant = start_lockstep({"--trace", trace.string()});
    const auto pilot = autopilot();
    ASSERT_TRUE(pilot->connect(port_, kStuck)) << plant->errors();
    ASSERT_TRUE(pilot->fly_until(8.0, kStuck)) << plant->errors();
    pilot->disconnect();
    ASSERT_TRUE(says(*plant, "rotors stopped: no actuator command for 0.5 s"));
    plant->signal(SIGTERM);
    ASSERT_EQ(plant->wait(kStuck), 0) << plant->errors();
    logs[run] = pilot->log();
    traces[run] = contents(trace);
  }
  const AutopilotLog& log = logs[0];
  EXPECT_NEAR(log.height_m, 0.5, 0.05);
  EXPECT_LT(log.position_ned.head<2>().norm(), 0.1);
  // Every sample comes, at the rates of the settings.
  EXPECT_EQ(log.sensor_times_us.front(), 2000U);
  EXPECT_EQ(log.sensor_times_us.back(), 8'000'000U);
  EXPECT_EQ(log.irregular, 0U);
  EXPECT_EQ(log.imus, 4000);
  EXPECT_NEAR(log.barometers, 400, 1);
  EXPECT_NEAR(log.magnetometers, 800, 1);
  EXPECT_NEAR(log.gps, 80, 1);
  EXPECT_NEAR(log.heartbeats, 8, 1);
  EXPECT_EQ(log.times, log.heartbeats);
  // Zurich: 488 m and 47.4 deg north, the field points north and down.
  EXPECT_NEAR(static_cast<double>(log.first_barometer.abs_pressure), 956.0, 3.0);
  EXPECT_NEAR(static_cast<double>(log.first_barometer.pressure_alt), 488.0, 25.0);
  EXPECT_NEAR(static_cast<double>(log.first_barometer.temperature), 11.83, 0.01);
  EXPECT_NEAR(1e-7 * log.first_gps.lat, 47.397742, 1e-4);
  EXPECT_NEAR(1e-3 * log.first_gps.alt, 488.0, 5.0);
  EXPECT_EQ(log.first_gps.fix_type, mavlink::HilGps::kFix3d);
  // The second flight is the same, bit by bit.
  EXPECT_EQ(logs[1].sensor_times_us.size(), log.sensor_times_us.size());
  EXPECT_TRUE(logs[1].bytes == log.bytes);
  EXPECT_GT(traces[0].size(), 100'000U);
  // The rest of a trace depends on when the plant was ended.
  const std::size_t common = std::min(traces[0].size(), traces[1].size());
  EXPECT_GT(common, traces[0].size() / 2);
  EXPECT_TRUE(traces[0].compare(0, common, traces[1], 0, common) == 0);
}

TEST_F(Autopilot, HoversWithoutLockstepAndIsSeenByTheTools) {
  const auto plant =
      start_plant({"--autopilot-port", std::to_string(port_), "--no-realtime", "--speed", kScaled});
  ScriptedAutopilotSettings settings;
  settings.lockstep = false;  // a board in HITL mode
  const auto pilot = autopilot(settings);
  ASSERT_TRUE(pilot->connect(port_, kStuck)) << plant->errors();
  ASSERT_TRUE(pilot->fly_until(1.0, kStuck));
  const double start_s = static_cast<double>(pilot->log().sensor_times_us.front()) * 1e-6;
  ASSERT_TRUE(pilot->fly_until(start_s + 6.0, kStuck)) << plant->errors();
  EXPECT_NEAR(pilot->log().height_m, 0.5, 0.1);

  double time_s = start_s + 6.0;
  const auto status = [&](std::vector<std::string> words) {
    Program program("swiftlet", on_this_domain(std::move(words)), folder_.path());
    while (!program.exit_code() && pilot->fly_until(time_s += 0.1, kStuck)) {
    }
    EXPECT_EQ(program.exit_code(), 0) << program.errors();
    return program.output();
  };
  const std::string link = "MAVLink on TCP port " + std::to_string(port_);
  const std::string text = status({"status"});
  EXPECT_NE(text.find("flown by " + link + ", rotors running"), std::string::npos) << text;
  const std::string json = status({"status", "--json"});
  for (const std::string& part : {"\"autopilot\": \"" + link + "\"", std::string("\"mode\": null"),
                                  std::string("\"airborne\": null"), std::string("\"control\": null")})
    EXPECT_NE(json.find(part), std::string::npos) << part << "\n" << json;
}

TEST_F(Autopilot, HoversOverASerialDevice) {
  const int board = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(board, 0);
  ASSERT_EQ(::grantpt(board), 0);
  ASSERT_EQ(::unlockpt(board), 0);
  const std::string device = ::ptsname(board);
  const int keeps_it_open =
      ::open(device.c_str(), O_RDWR | O_NOCTTY);  // a pseudo-terminal without it reports a hang-up
  termios raw{};
  ::tcgetattr(keeps_it_open, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(keeps_it_open, TCSANOW, &raw);
  const auto plant =
      start_plant({"--autopilot-device", device, "--baud", "921600", "--no-realtime", "--speed", kScaled});
  ASSERT_TRUE(says(*plant, "ready: "));
  ScriptedAutopilotSettings settings;
  settings.lockstep = false;
  const auto pilot = autopilot(settings);
  pilot->use(board);
  ASSERT_TRUE(pilot->fly_until(0.01, kStuck)) << plant->errors();
  const double start_s = static_cast<double>(pilot->log().sensor_times_us.front()) * 1e-6;
  ASSERT_TRUE(pilot->fly_until(start_s + 6.0, kStuck)) << plant->errors();
  EXPECT_NEAR(pilot->log().height_m, 0.5, 0.1);
  ::close(keeps_it_open);
}

TEST_F(Autopilot, RotorsStopIfItDisconnectsInFlightAndItMayComeBack) {
  dds::Node watcher(node());
  Inbox<std::pair<bool, std::string>> states;
  const auto subscription =
      watcher.subscribe<messages::msg::VehicleInfo>(messages::topics::kVehicleInfo, [&](const auto& info) {
        states.put({info.rotors_running(), info.fault().c_str()});
      });
  const auto plant = start_lockstep();
  const auto pilot = autopilot();
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  ASSERT_TRUE(pilot->fly_until(4.0, kStuck));
  EXPECT_GT(pilot->log().height_m, 0.3);
  ASSERT_TRUE(states.wait([](const auto& all) { return !all.empty() && all.back().first; }));
  pilot->disconnect();
  EXPECT_TRUE(says(*plant, "autopilot disconnected"));
  EXPECT_TRUE(states.wait([](const auto& all) {
    return !all.back().first && all.back().second == "no actuator command for 0.5 s";
  }));
  const auto second = autopilot();
  ASSERT_TRUE(second->connect(port_, kStuck));
  const double now_s = 4.0;
  ASSERT_TRUE(second->fly_until(now_s + 0.1, kStuck));
  const double there_s = static_cast<double>(second->log().sensor_times_us.back()) * 1e-6;
  ASSERT_TRUE(second->fly_until(there_s + 6.0, kStuck)) << plant->errors();
  EXPECT_NEAR(second->log().height_m, 0.5, 0.1);
}

TEST_F(Autopilot, ASilentOneStopsTheRotorsInLockstepToo) {
  const auto plant = start_plant(
      {"--autopilot-port", std::to_string(port_), "--clock", "lockstep", "--autopilot-timeout", "0.3"});
  const auto pilot = autopilot();
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  ASSERT_TRUE(pilot->fly_until(2.0, kStuck));
  EXPECT_TRUE(says(*plant, "autopilot: no answer to the sample of t = 2.0"));
  EXPECT_TRUE(says(*plant, "rotors stopped: no actuator command for 0.5 s"));
}

// GIVEN an autopilot whose loops are half as fast as the IMU WHEN it flies in lockstep THEN time waits for its answers only.
TEST_F(Autopilot, OneThatAnswersEverySecondSampleFliesInLockstepToo) {
  const auto plant = start_plant(
      {"--autopilot-port", std::to_string(port_), "--clock", "lockstep", "--autopilot-timeout", "0.3"});
  ScriptedAutopilotSettings settings;
  settings.samples_per_answer = 2;
  const auto pilot = autopilot(settings);
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  ASSERT_TRUE(pilot->fly_until(4.0, kStuck)) << plant->errors();
  EXPECT_NEAR(pilot->log().height_m, 0.5, 0.4) << "its gains are those of the whole rate";
  EXPECT_TRUE(says(*plant, "autopilot: answers one of 2 samples"));
  const std::string log = plant->errors();
  std::size_t overdue = 0;
  for (std::size_t at = log.find("no answer to"); at != std::string::npos;
       at = log.find("no answer to", at + 1))
    ++overdue;
  EXPECT_LE(overdue, 3U) << log;
}

// GIVEN another process that is the vehicle WHEN the plant publishes the truth alone THEN with stamps of that vehicle's clock.
TEST_F(Autopilot, TheTruthAloneHasTheStampsOfTheVehicle) {
  constexpr std::int64_t kAhead = 7'000'000'000;
  dds::Node vehicle(node());
  const clocks::ClockServer clock(vehicle, [] { return runtime::monotonic_ns() + kAhead; });
  Inbox<std::int64_t> ages;
  const auto truth = vehicle.subscribe<messages::msg::GroundTruth>(
      messages::topics::kGroundTruth,
      [&](const auto& message) { ages.put(runtime::monotonic_ns() + kAhead - message.stamp_ns()); });
  const auto plant = start_plant(
      {"--autopilot-port", std::to_string(port_), "--clock", "lockstep", "--speed", "1", "--truth-only"});
  const auto pilot = autopilot();
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  ASSERT_TRUE(pilot->fly_until(1.5, kStuck)) << plant->errors();
  ASSERT_GT(ages.size(), 20U);
  for (const std::int64_t age_ns : ages.items()) {
    EXPECT_GT(age_ns, -50'000'000);
    EXPECT_LT(age_ns, 5'000'000'000) << "a busy machine may be late, but not by the origin of a clock";
  }
  for (const std::string& topic : vehicle.topics_seen()) {
    EXPECT_EQ(topic.find("/imu"), std::string::npos);
    EXPECT_EQ(topic.find("/vehicle_info"), std::string::npos);
  }
}

TEST_F(Autopilot, AnswersRequestsForItsClock) {
  const auto plant = start_plant({"--autopilot-port", std::to_string(port_)});
  dds::Node watcher(node());
  clocks::ClockClient client(watcher, runtime::monotonic_ns);
  EXPECT_TRUE(eventually([&] {
    client.ask_if_due();
    return client.to_vehicle(runtime::monotonic_ns()).has_value();
  })) << plant->errors();
}

TEST_F(Autopilot, IgnoresNoiseWrongChecksumsAndOtherSystems) {
  const auto plant = start_lockstep();
  const auto pilot = autopilot();
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  mavlink::HilActuatorControls full;
  full.mode = 129;
  full.controls.fill(1.0F);
  const mavlink::FrameBytes sound =
      mavlink::encode(mavlink::to_frame(full, {1, 1}, 0), mavlink::HilActuatorControls::kCrcExtra);
  std::vector<std::uint8_t> wrong(sound.data.begin(),
                                  sound.data.begin() + static_cast<std::ptrdiff_t>(sound.size));
  wrong.back() = static_cast<std::uint8_t>(wrong.back() ^ 1U);
  for (int i = 1; i <= 80; ++i) {
    ASSERT_TRUE(pilot->fly_until(0.1 * i, kStuck)) << plant->errors();
    full.time_usec = pilot->log().sensor_times_us.back();
    pilot->send({0x00, 0xff, 0xfe, 0x00});
    pilot->send(wrong);
    pilot->send_message(full, 42);
  }
  EXPECT_NEAR(pilot->log().height_m, 0.5, 0.05);
  EXPECT_TRUE(says(*plant, "bytes that are no MAVLink frame"));
  EXPECT_TRUE(says(*plant, "messages of other systems than 1, the last of 42"));
}

TEST_F(Autopilot, RefusesControlsThatAreNoNumbers) {
  const auto plant = start_lockstep();
  const auto pilot = autopilot();
  ASSERT_TRUE(pilot->connect(port_, kStuck));
  ASSERT_TRUE(pilot->fly_until(1.0, kStuck));
  mavlink::HilActuatorControls bad;
  bad.time_usec = pilot->log().sensor_times_us.back();
  bad.flags = mavlink::HilActuatorControls::kLockstep;
  bad.mode = 129;
  bad.controls.fill(std::numeric_limits<float>::quiet_NaN());
  pilot->send_message(bad, 1);
  ASSERT_TRUE(pilot->fly_until(1.5, kStuck));
  EXPECT_TRUE(says(*plant, "throttle is not a number within 0 .. 1"));
}

TEST_F(Autopilot, EachOfSeveralVehiclesHasAPort) {
  const auto plant = start_lockstep({"--vehicle-name", "a,b"});
  const auto first = autopilot();
  const auto second = autopilot();
  ASSERT_TRUE(first->connect(port_, kStuck)) << plant->errors();
  ASSERT_TRUE(second->connect(port_ + 1, kStuck)) << plant->errors();
  ASSERT_TRUE(first->fly_until(3.0, kStuck));
  ASSERT_TRUE(second->fly_until(1.0, kStuck));
  EXPECT_GT(first->log().height_m, 0.3);
  EXPECT_FALSE(first->log().bytes == second->log().bytes);  // another seed
}

TEST_F(Autopilot, APortInUseIsNamed) {
  const auto first = start_lockstep();
  ASSERT_TRUE(says(*first, "waiting for the autopilot"));
  const ProgramResult second = run_program("swiftlet-plant",
                                           on_this_domain({"--autopilot", "mavlink", "--autopilot-port",
                                                           std::to_string(port_), "--vehicle-name", "other"}),
                                           folder_.path(), kStuck);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.errors.find("port " + std::to_string(port_) +
                               " of 127.0.0.1 is in use: end the other simulator, or choose another "
                               "--autopilot-port"),
            std::string::npos)
      << second.errors;
}

TEST_F(Autopilot, WrongOptionsAreRefused) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"--autopilot-controls", "1,2,3"}, "one number for each of the 4 rotors"},
      {{"--autopilot-controls", "1,2,3,17"}, "rotor 4: is 17, must be a control from 1 to 16"},
      {{"--autopilot-controls", "1,2,3,2"}, "rotor 4: control 2 drives another rotor already"},
      {{"--autopilot-range", "1", "0"}, "--autopilot-range: is 1 to 0"},
      {{"--autopilot-address", "localhost"}, "must be an IPv4 address in digits"},
      {{"--autopilot-device", "/dev/null", "--clock", "lockstep"}, "needs --clock realtime"},
      {{"--autopilot-device", "/dev/null", "--baud", "9600"},
       "--baud: is 9600, must be one of 57600, 115200, "},
      {{"--autopilot-device", "/dev/null", "--autopilot-port", "4561"},
       "--autopilot-port excludes --autopilot-device"},
      {{"--clock", "lockstep", "--paused"}, "--paused: is not possible with --autopilot"},
      {{"--level", "rates"}, "--level: an autopilot commands throttles, level actuators"},
  };
  for (const auto& [words, sentence] : cases) {
    std::vector<std::string> arguments = words;
    arguments.insert(arguments.end(), {"--autopilot", "mavlink"});
    const ProgramResult result =
        run_program("swiftlet-plant", on_this_domain(arguments), folder_.path(), kStuck);
    EXPECT_EQ(result.exit_code, 2) << sentence << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  }
  const ProgramResult no_device = run_program(
      "swiftlet-plant", on_this_domain({"--autopilot", "mavlink", "--autopilot-device", "/dev/null"}),
      folder_.path(), kStuck);
  EXPECT_EQ(no_device.exit_code, 1);
  EXPECT_NE(no_device.errors.find("cannot open the serial device /dev/null: "), std::string::npos)
      << no_device.errors;
}

}  // namespace
}  // namespace swiftlet::tests
