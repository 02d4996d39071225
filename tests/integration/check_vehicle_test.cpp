// `swiftlet check vehicle` with real processes: the plant passes, and defects at the wire are named. The check judges delays, so
// the plant runs in real time: what is faster than the clock turns a stall of the computer into a longer one of the vehicle.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/held_vehicle.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/spoiling_relay.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using ground::HandStep;
using nlohmann::json;
namespace msg = messages::msg;

class CheckVehicle : public testing::Test {
 protected:
  dds::NodeSettings node(const std::string& name, const std::string& vehicle) const {
    dds::NodeSettings settings;
    settings.name = name;
    settings.vehicle = vehicle;
    settings.domain = lock_.domain();
    return settings;
  }
  std::vector<std::string> network(std::vector<std::string> words) const {
    words.insert(words.end(), {"--localhost-only", "--domain", std::to_string(lock_.domain())});
    return words;
  }
  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> words = {}) const {
    return std::make_unique<Program>(program, network(std::move(words)), folder_.path());
  }
  ProgramResult swiftlet(std::vector<std::string> words) const {
    return run_program("swiftlet", network(std::move(words)), folder_.path(), kStuck);
  }
  ProgramResult check(std::vector<std::string> words) const {
    words.insert(words.begin(), {"check", "vehicle"});
    words.insert(words.end(), {"--json", "--time", "1"});
    return swiftlet(std::move(words));
  }
  void start_plant(std::vector<std::string> words = {}) {
    plant_ = start("swiftlet-plant", std::move(words));
  }
  void start_mocap() { mocap_ = start("swiftlet-mocap"); }
  bool plant_says(const std::string& text) const {
    return eventually([&] { return plant_->errors().find(text) != std::string::npos; });
  }
  // A simulation file like the default one, but without the floor.
  std::string no_floor() const {
    std::ifstream file(in_source("config/simulation/default.yaml"));
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string floor = "present: true";
    text.replace(text.find(floor), floor.size(), "present: false");
    return folder_.write("no_floor.yaml", text);
  }
  // A vehicle kl2 that is the plant with a defect.
  void spoil(Spoil spoil) {
    relay_ = std::make_unique<SpoilingRelay>(node("relay", "kl1"), node("plant", "kl2"), std::move(spoil));
  }

  static std::string finding_of(const ProgramResult& result, const std::string& check) {
    const json checks = json::parse(result.output).at("checks");
    const auto found =
        std::find_if(checks.begin(), checks.end(), [&](const json& it) { return it.at("name") == check; });
    if (found == checks.end()) return "no check " + check + " in " + result.output;
    return found->at("verdict").get<std::string>() + ": " + found->at("finding").get<std::string>();
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  std::unique_ptr<Program> plant_, mocap_;
  std::unique_ptr<SpoilingRelay> relay_;
};

TEST_F(CheckVehicle, ThePlantPassesAndItsRotorsEndOff) {
  start_plant();
  start_mocap();
  const ProgramResult result = check({"--props-off", "--yes"});
  ASSERT_FALSE(result.output.empty()) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(result.exit_code, report.at("failed") == 0 ? 0 : 1);
  for (const json& check : report.at("checks")) EXPECT_NE(check.at("verdict"), "fail") << check;
  for (const char* check : {"imu.rate", "imu.gravity", "battery.voltage", "mocap_pose.gravity",
                            "commands.timeout", "commands.lower_term", "commands.stop", "rotor_4.order"})
    EXPECT_EQ(finding_of(result, check), "pass: ");
  EXPECT_EQ(finding_of(result, "rotor_1.spin").find("skipped: nobody at a terminal"), 0);
  // It has timed out once, in the step without commands, and stands still at the end.
  EXPECT_TRUE(plant_says("rotors stopped on command")) << plant_->errors();
}

// GIVEN a vehicle whose rotors are connected as its file says, or two exchanged, WHEN it flies a hover test THEN it lands and is
// remembered, or its rotors are off and the two are named.
TEST_F(CheckVehicle, AHoverTestNamesTwoExchangedRotors) {
  const std::string first = "[0.04914392129246505, 0.04914392129246505, 0]";
  const std::string third = "[-0.04914392129246505, -0.04914392129246505, 0]";
  std::ifstream file(in_source("config/vehicles/kaylion.yaml"));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.replace(text.find(third), third.size(), first);
  text.replace(text.find(first), first.size(), third);
  const std::filesystem::path state = folder_.path() / "state";
  ASSERT_EQ(setenv("XDG_STATE_HOME", state.c_str(), 1), 0);
  const std::string kaylion = in_source("config/vehicles/kaylion.yaml");
  const std::string exchanged = folder_.write("exchanged.yaml", text);
  for (const std::string& vehicle : {exchanged, kaylion}) {
    start_plant({"--vehicle", vehicle});
    start_mocap();
    const auto control = start("swiftlet-control");
    const ProgramResult result = check({"--hover", "--yes"});
    EXPECT_EQ(finding_of(result, "hover.test"),
              vehicle == kaylion ? "pass: " : "fail: rotors 1 and 3 are exchanged")
        << result.output << result.errors;
    EXPECT_EQ(std::filesystem::exists(state / "swiftlet" / "hover_tests" / "kl1"), vehicle == kaylion);
    EXPECT_TRUE(plant_says("rotors stopped on command")) << plant_->errors();
    plant_.reset();
    mocap_.reset();
  }
  unsetenv("XDG_STATE_HOME");
}

TEST_F(CheckVehicle, SendsNoThrottlesToAVehicleThatDoesNotAcceptThem) {
  start_plant({"--level", "attitude"});
  start_mocap();
  const ProgramResult result = check({"--props-off", "--yes"});
  ASSERT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_EQ(json::parse(result.output).at("failed"), 1) << result.output;
  EXPECT_EQ(finding_of(result, "commands.steps"),
            "fail: the check commands throttles, and the vehicle accepts only level attitude");
}

TEST_F(CheckVehicle, AVehicleInAHandPasses) {
  constexpr HandStep kSteps[] = {HandStep::kRollRight, HandStep::kBack,      HandStep::kNoseUp,
                                 HandStep::kBack,      HandStep::kTurnRight, HandStep::kForward,
                                 HandStep::kUp,        HandStep::kWave};
  HeldVehicle vehicle(node("plant", "kl1"));
  Program check("swiftlet", network({"check", "vehicle", "--hand", "--json"}), folder_.path());
  for (std::size_t i = 0; i < std::size(kSteps); ++i) {
    const std::string prompt = "step " + std::to_string(i + 1) + " of ";
    if (!eventually([&] { return check.errors().find(prompt) != std::string::npos || check.exit_code(); }))
      break;
    vehicle.move(kSteps[i]);
  }
  const int exit_code = check.wait(kStuck);
  const ProgramResult result{exit_code, check.output(), check.errors()};
  ASSERT_FALSE(result.output.empty()) << result.errors;
  for (const char* name :
       {"hand.gyro", "hand.accelerometer", "hand.mocap_attitude", "hand.gyro_scale", "hand.mocap_forward",
        "hand.mocap_up", "hand.delay", "hand.alignment", "imu.wrap_around"})
    EXPECT_EQ(finding_of(result, name), "pass: ") << result.output;
}

TEST_F(CheckVehicle, DefectsAtTheWireAreNamed) {
  start_plant();
  Spoil defects;
  defects.imu = [](msg::Imu& imu) {
    for (double& axis : imu.specific_force_frd()) axis /= 9.80665;
    imu.stamp_ns(imu.stamp_ns() - 80'000'000);
    return imu.sequence_number() % 2 == 0;
  };
  defects.repeats_last_command = true;  // ignores the time-out
  defects.command = [](msg::ActuatorCommand& command) {
    std::swap(command.throttle()[1], command.throttle()[2]);
    return true;
  };
  spoil(defects);
  const ProgramResult result = check({"--vehicle-name", "kl2", "--props-off", "--yes"});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_EQ(finding_of(result, "imu.gravity").find("fail: accelerometer in g"), 0) << result.output;
  EXPECT_EQ(finding_of(result, "imu.sequence").find("fail: gaps: "), 0) << result.output;
  EXPECT_EQ(finding_of(result, "commands.timeout").find("fail: ignored time-out"), 0) << result.output;
  EXPECT_EQ(finding_of(result, "rotor_2.order").find("fail: two rotors exchanged"), 0) << result.output;
}

// Without a floor it falls, and turns as freely as on a tether. The accelerometer shows no gravity then.
TEST_F(CheckVehicle, ThrustShowsOrderAndSpinOfAVehicleThatMayTurn) {
  start_plant({"--simulation", no_floor()});
  const ProgramResult result = check({"--tethered", "--yes"});
  ASSERT_FALSE(result.output.empty()) << result.errors;
  for (const char* name : {"rotor_1.order", "rotor_2.order", "rotor_3.order", "rotor_4.order", "rotor_1.spin",
                           "rotor_2.spin", "rotor_3.spin", "rotor_4.spin"})
    EXPECT_EQ(finding_of(result, name), "pass: ");
  EXPECT_EQ(finding_of(result, "imu.gravity").find("fail: the accelerometer does not measure gravity"), 0);
}

TEST_F(CheckVehicle, APersonConfirmsOrderAndSpinByKeys) {
  start_plant();
  Terminal terminal("swiftlet", network({"check", "vehicle", "--props-off", "--time", "1"}), 180, 120);
  const auto shows = [&](const std::string& text) {
    return eventually([&] { return terminal.text().find(text) != std::string::npos; });
  };
  ASSERT_TRUE(shows("Type yes if all propellers are off:")) << terminal.text();
  terminal.type("yes\n");
  const char* const answers[] = {"1\na\n", "2\na\n", "3\na\n",
                                 "4\nc\n"};  // rotor 2 turns clockwise by its file
  for (int rotor = 1; rotor <= 4; ++rotor) {
    ASSERT_TRUE(shows("rotor " + std::to_string(rotor) + " of 4 turns faster")) << terminal.text();
    terminal.type(answers[rotor - 1]);
  }
  EXPECT_EQ(terminal.wait(kStuck), 1);
  EXPECT_NE(terminal.text().find("wrong spin: rotor 2 (front left) turns counter-clockwise"),
            std::string::npos)
      << terminal.text();
}

TEST_F(CheckVehicle, CommandsNoVehicleThatAControllerMayFly) {
  start_plant();
  Program running("swiftlet", network({"check", "vehicle", "--props-off", "--yes", "--json", "--time", "1"}),
                  folder_.path());
  ASSERT_TRUE(plant_says("rotors started")) << running.errors();
  const auto control = start("swiftlet-control");
  EXPECT_EQ(running.wait(kStuck), 1);
  EXPECT_EQ(finding_of({1, running.output(), running.errors()}, "commands.steps"),
            "fail: stopped, rotors off: a control service for kl1 is alive");
  EXPECT_TRUE(plant_says("rotors stopped on command")) << plant_->errors();

  ASSERT_TRUE(eventually([&] { return swiftlet({"status", "--json"}).exit_code == 0; })) << control->errors();
  const std::string before = plant_->errors();
  const ProgramResult refused = check({"--props-off", "--yes"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(finding_of(refused, "commands.steps"),
            "fail: refused to command the vehicle: a control service for kl1 is alive");
  EXPECT_EQ(plant_->errors().find("rotors started", before.size()), std::string::npos) << plant_->errors();
}

// The first check is of another vehicle: on a tether its rotors do not turn.
TEST_F(CheckVehicle, RotorsDoNotTurnWithAnotherVehicleFileAndAnInterruptTurnsThemOff) {
  start_plant();
  const ProgramResult result = check({"--tethered", "--yes", "--vehicle", "crazyflie2"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(finding_of(result, "commands.steps")
                .find("skipped: the vehicle file, which tells the throttle, is of another vehicle"),
            0)
      << result.output;
  EXPECT_EQ(plant_->errors().find("rotors started"), std::string::npos) << plant_->errors();

  Program running("swiftlet", network({"check", "vehicle", "--props-off", "--yes", "--time", "1"}),
                  folder_.path());
  ASSERT_TRUE(plant_says("rotors started")) << running.errors();
  running.signal(SIGINT);
  EXPECT_EQ(running.wait(kStuck), 1);
  EXPECT_NE(running.errors().find("swiftlet: check vehicle: interrupted"), std::string::npos)
      << running.errors();
  EXPECT_TRUE(plant_says("rotors stopped on command")) << plant_->errors();
}

// GIVEN a vehicle without a command time-out WHEN its IMU samples cease with the rotors running THEN they are turned off.
TEST_F(CheckVehicle, CeasingImuSamplesTurnTheRotorsOff) {
  start_plant();
  const auto silent = std::make_shared<std::atomic<bool>>(false);
  Spoil ignores_timeout;
  ignores_timeout.repeats_last_command = true;
  ignores_timeout.imu = [silent](msg::Imu&) { return !*silent; };
  spoil(ignores_timeout);
  Program running(
      "swiftlet",
      network({"check", "vehicle", "--props-off", "--yes", "--json", "--time", "1", "--vehicle-name", "kl2"}),
      folder_.path());
  ASSERT_TRUE(plant_says("rotors started")) << running.errors();
  *silent = true;
  EXPECT_EQ(running.wait(kStuck), 1);
  EXPECT_EQ(finding_of({1, running.output(), running.errors()}, "commands.steps"),
            "fail: stopped, rotors off: no imu sample for 0.5 s");
  EXPECT_TRUE(plant_says("rotors stopped on command")) << plant_->errors();
}

TEST_F(CheckVehicle, WrongUsageIsRefused) {
  const ProgramResult unconfirmed = swiftlet({"check", "vehicle", "--props-off"});
  EXPECT_EQ(unconfirmed.exit_code, 2);
  EXPECT_EQ(unconfirmed.errors,
            "swiftlet: check vehicle: --props-off: confirm with --yes that all propellers are off; the "
            "rotors will turn\n");
  EXPECT_EQ(swiftlet({"check", "vehicle", "--props-off", "--tethered"}).exit_code, 2);
  EXPECT_EQ(swiftlet({"check", "vehicle", "--props-off", "--hover"}).exit_code, 2);
  EXPECT_EQ(swiftlet({"fly", "square", "--skip-check"}).exit_code, 2) << "without --attach";
  EXPECT_EQ(swiftlet({"fly", "square", "--skip-hover-test"}).exit_code, 2) << "without --attach";
  EXPECT_EQ(swiftlet({"check", "vehicle", "--hand", "--tethered", "--yes"}).exit_code, 2);
  const ProgramResult nobody = swiftlet({"check", "vehicle", "--timeout", "0.1", "--time", "1"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_NE(nobody.output.find("missing: nobody publishes imu here"), std::string::npos) << nobody.output;
}

TEST_F(CheckVehicle, FlyArmsNoVehicleThatFailsTheCheck) {
  start_plant();
  spoil({{}, [](msg::Battery& battery) {
           battery.voltage_v(1e3 * battery.voltage_v());
           return true;
         }});
  const auto control = start("swiftlet-control", {"--vehicle-name", "kl2"});
  const ProgramResult fly =
      swiftlet({"fly", "square", "--attach", "--vehicle-name", "kl2", "--record", folder_.path() / "record"});
  EXPECT_EQ(fly.exit_code, 1);
  EXPECT_NE(fly.errors.find("battery in mV"), std::string::npos) << fly.errors;
  EXPECT_NE(fly.errors.find("swiftlet: fly: kl2 does not pass the check of vehicles and is not armed"),
            std::string::npos)
      << fly.errors;
  EXPECT_EQ(plant_->errors().find("rotors started"), std::string::npos) << plant_->errors();
}

}  // namespace
}  // namespace swiftlet::tests
