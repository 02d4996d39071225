// Programs that fly several vehicles from one context.
#include <array>
#include <future>

#include <gtest/gtest.h>

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using ground::ActionResult;
using ground::Vehicle;

class OneContext : public testing::Test {
 protected:
  // The processes of one vehicle, in lockstep at up to ten times real time.
  struct Processes {
    Processes(const OneContext& test, const std::string& vehicle)
        : plant("swiftlet-plant", test.words(vehicle, {"--speed", "10"}), test.folder_.path()),
          mocap("swiftlet-mocap", test.words(vehicle), test.folder_.path()),
          control("swiftlet-control", test.words(vehicle), test.folder_.path()) {}
    Program plant, mocap, control;
  };

  std::vector<std::string> words(const std::string& vehicle,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {
        "--domain", std::to_string(lock_.domain()), "--vehicle-name", vehicle, "--localhost-only", "--clock",
        "lockstep"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  dds::NodeSettings network() const {
    dds::NodeSettings network;
    network.name = "test";
    network.domain = lock_.domain();
    return network;
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
};

// GIVEN two vehicles of one participant WHEN each has a different request at the same time THEN each executes
// its own and reports its result.
TEST_F(OneContext, FliesTwoVehiclesConcurrently) {
  const Processes first_processes(*this, "kl1");
  const Processes second_processes(*this, "kl2");
  const ground::Context context(network());
  ASSERT_TRUE(eventually(
      [&] {
        return context.discovered_vehicles() == std::vector<std::string>{"kl1", "kl2"};
      },
      kStuck));
  Vehicle first(context, "kl1");
  Vehicle second(context, "kl2");
  for (Vehicle* const vehicle : {&first, &second}) {
    ASSERT_TRUE(vehicle->connect(kStuck).accepted());
    ASSERT_TRUE(vehicle->wait_until([](const auto& state) { return state.has_pose; }, kStuck));
    EXPECT_TRUE(vehicle->connected());
    ASSERT_TRUE(eventually([&] { return vehicle->arm().accepted(); }, kStuck));
  }
  EXPECT_EQ(first.name(), "kl1");

  const ground::ActionHandle lower = first.take_off(0.5, 0.8);
  const ground::ActionHandle higher = second.take_off(0.9, 0.8);
  EXPECT_TRUE(lower.accepted()) << lower.answer().reason;
  EXPECT_TRUE(higher.accepted()) << higher.answer().reason;
  for (const ground::ActionHandle& action : {lower, higher}) {
    const ActionResult result = action.wait(kStuck);
    EXPECT_TRUE(result.done()) << result.reason;
    EXPECT_EQ(action.progress(), 1.0);
  }
  EXPECT_NEAR(first.state().position_ned_m.z(), -0.5, 0.06);
  EXPECT_NEAR(second.state().position_ned_m.z(), -0.9, 0.06);

  const ground::ActionHandle move = first.go_to({{0.8, 0.0, -0.5}});
  const ground::ActionHandle landing = second.land();
  EXPECT_TRUE(landing.wait(kStuck).done());
  EXPECT_EQ(second.state().mode, control::Mode::kDisarmed);
  EXPECT_TRUE(move.wait(kStuck).done());
  EXPECT_NEAR(first.state().position_ned_m.x(), 0.8, 0.06);

  // More requests than the controller keeps in its history.
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(first.hold().accepted());
  EXPECT_TRUE(lower.wait(0ms).done());
  EXPECT_TRUE(move.wait(0ms).done());
}

TEST_F(OneContext, RefusesInvalidVehicleNames) {
  const ground::Context context(network());
  EXPECT_THROW(Vehicle(context, "kl 1"), std::runtime_error);
  EXPECT_THROW(Vehicle(context, ""), std::runtime_error);
}

}  // namespace
}  // namespace swiftlet::tests
