// swiftlet-px4 with control and motion capture as processes, and a scripted PX4 (tests/support/px4/scripted_px4.hpp) in the test:
// the links between them, by the wall clock. What the bridge does in flight is tests/unit/services/px4/px4_flight_test.cpp.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/program.hpp"
#include "tests/support/px4/scripted_px4.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using control::Mode;
using ground::View;
namespace msg = messages::msg;

constexpr std::uint8_t kPosition = 2, kAutoLand = 18;
constexpr double kHeight_m = 0.6;

std::string fault_of(const View& view) { return view.vehicle.message.fault().c_str(); }

class Px4 : public testing::Test {
 protected:
  static constexpr const char* kNames[] = {"kl1", "kl2"};

  dds::NodeSettings node(const std::string& name, const std::string& vehicle) const {
    dds::NodeSettings settings = settings_of(name.c_str(), lock_);
    settings.vehicle = vehicle;
    return settings;
  }
  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> arguments) const {
    const std::vector<std::string> common{"--domain", std::to_string(lock_.domain()), "--localhost-only"};
    arguments.insert(arguments.end(), common.begin(), common.end());
    return std::make_unique<Program>(program, arguments, folder_.path());
  }
  // Two instances of PX4, 1 m apart.
  void start_two() {
    for (int i = 0; i < 2; ++i) {
      ScriptedPx4Settings settings;
      settings.instance = i;
      settings.east_m = i;
      const std::string name = kNames[i];
      px4s_.push_back(std::make_unique<ScriptedPx4>(vehicle_, node("scripted-" + name, name), settings));
    }
  }

  const plant::Vehicle vehicle_ = io::load_vehicle(in_source("config/vehicles/kaylion.yaml"));
  dds::DomainLock lock_;
  TemporaryFolder folder_;
  std::vector<std::unique_ptr<ScriptedPx4>> px4s_;
};

// A vehicle with its control service, as the ground sees it.
class Seen {
 public:
  explicit Seen(const dds::NodeSettings& settings) : client_(settings) {}

  ground::Result ask(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    request.position_ned.z() = -kHeight_m;
    return client_.request(request, kStuck);
  }
  bool wait_until_ready() {
    return client_.wait(kStuck, [](const View& view) {
      return view.control.message.has_pose() && fault_of(view).empty() &&
             view.vehicle.message.control_levels() != 0;
    });
  }
  bool wait_for(Mode mode) {
    return client_.wait(kStuck, [mode](const View& view) {
      return view.control.message.mode() == static_cast<std::uint8_t>(mode);
    });
  }
  bool fault_is(const std::string& fault) {
    return client_.wait(kStuck, [&](const View& view) { return fault_of(view) == fault; });
  }
  std::string reason() const { return client_.view().control.message.reason().c_str(); }

 private:
  ground::Client client_;
};

// GIVEN two vehicles, commanded at the levels rates and trajectory WHEN the pilot of one takes over, and the control of the other
// dies THEN the first is stopped by the name of what happened and left alone, and the second is told to land.
TEST_F(Px4, HoversAtTwoLevelsUntilThePilotTakesOverOrControlDies) {
  start_two();
  const auto bridge = start("swiftlet-px4", {"--vehicle-name", "kl1,kl2", "--control-silence", "0.5"});
  const auto mocap = start("swiftlet-mocap", {"--vehicle-name", "kl1,kl2"});
  const auto rates = start("swiftlet-control", {"--vehicle-name", "kl1", "--level", "rates"});
  const auto trajectory = start("swiftlet-control", {"--vehicle-name", "kl2", "--level", "trajectory"});
  const auto errors = [&] { return bridge->errors() + rates->errors() + trajectory->errors(); };
  Seen first(node("ground", "kl1"));
  Seen second(node("ground", "kl2"));
  ASSERT_TRUE(first.wait_until_ready() && second.wait_until_ready()) << errors();
  for (Seen* const seen : {&first, &second}) {
    const ground::Result armed = seen->ask(control::RequestKind::kArm);
    ASSERT_TRUE(armed.accepted()) << armed.reason;
    const ground::Result off = seen->ask(control::RequestKind::kTakeoff);
    ASSERT_TRUE(off.accepted()) << off.reason;
  }
  for (Seen* const seen : {&first, &second})
    ASSERT_TRUE(seen->wait_for(Mode::kHolding)) << seen->reason() << errors();
  for (const auto& px4 : px4s_) EXPECT_NEAR(px4->height_m(), kHeight_m, 0.15);

  px4s_[0]->pilot_selects(kPosition);
  trajectory->signal(SIGKILL);
  const std::string taken_over = "PX4 is in mode Position (pilot or ground station)";
  ASSERT_TRUE(first.fault_is(taken_over)) << errors();
  EXPECT_TRUE(first.wait_for(Mode::kStopped)) << first.reason() << errors();
  EXPECT_NE(first.reason().find(taken_over), std::string::npos) << first.reason();
  EXPECT_TRUE(px4s_[0]->armed()) << "rotors off of control do not reach the pilot's vehicle";
  EXPECT_EQ(px4s_[0]->status().nav_state(), kPosition);

  ASSERT_TRUE(eventually([&] { return px4s_[1]->status().nav_state() == kAutoLand; })) << errors();
  EXPECT_FALSE(px4s_[1]->status().failsafe()) << "it was told to, before its failsafe acts";
  const std::uint64_t modes = px4s_[1]->offboard_modes();
  ASSERT_TRUE(eventually([&] { return !px4s_[1]->armed(); })) << errors();
  EXPECT_EQ(px4s_[1]->offboard_modes(), modes) << "nothing was streamed after its death";
  EXPECT_NEAR(px4s_[1]->height_m(), 0.0, 0.05);
}

TEST_F(Px4, OfAnotherVersionIsRefusedByName) {
  ScriptedPx4Settings newer;
  newer.status_topic = "/out/vehicle_status_v4";
  const ScriptedPx4 px4(vehicle_, node("scripted", "kl1"), newer);
  const auto bridge = start("swiftlet-px4", {});
  const auto control = start("swiftlet-control", {"--level", "rates"});
  Seen seen(node("ground", "kl1"));
  EXPECT_TRUE(seen.fault_is(
      "PX4 publishes /fmu/out/vehicle_status_v4, but swiftlet-px4 knows vehicle_status_v1, that of PX4 1.16"))
      << bridge->errors();
  EXPECT_FALSE(seen.ask(control::RequestKind::kArm).accepted());
  EXPECT_EQ(px4.offboard_modes(), 0U);
}

// GIVEN two instances of PX4 WHEN `swiftlet fly --vehicle px4` flies a mission with both THEN it starts mocap, bridge
// and control, both fly the mission beside each other and land, and the report has both.
TEST_F(Px4, FliesTwoInstancesByTheFlyCommand) {
  start_two();
  const std::string mission =
      folder_.write("hop.yaml",
                    "name: hop\nframe: ned\ntolerance_m: 0.2\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.4, speed_m_s: 0.5}\n"
                    "  - {kind: waypoint, position_m: [0.3, 0, -0.4], speed_m_s: 0.5}\n"
                    "  - {kind: land, speed_m_s: 0.5}\n");
  const ProgramResult result = run_program(
      "swiftlet",
      {"fly", mission, "--vehicle", "px4", "--vehicle-name", "kl1,kl2", "--domain",
       std::to_string(lock_.domain()), "--localhost-only", "--record", folder_.path() / "record", "--json"},
      folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  for (const char* const name : {"kl1", "kl2"}) EXPECT_NE(result.output.find(name), std::string::npos);
  for (const auto& px4 : px4s_) {
    EXPECT_FALSE(px4->armed());
    px4->with([](const Px4Simulation& simulation) {
      EXPECT_GT(simulation.setpoints(), 300U);
      EXPECT_TRUE(simulation.last_mode()->attitude()) << "level attitude, unless told";
      return 0;
    });
    EXPECT_NEAR(px4->height_m(), 0.0, 0.05);
  }
}

TEST_F(Px4, RefusesOptionsOfTheSimulation) {
  const ProgramResult result = run_program(
      "swiftlet", {"fly", "square", "--vehicle", "px4", "--clock", "lockstep"}, folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("--vehicle px4: PX4 is no simulation of swiftlet-plant"), std::string::npos)
      << result.errors;
}

}  // namespace
}  // namespace swiftlet::tests
