// Commands for all vehicles of a fleet that run.
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using nlohmann::json;

// Vehicles that run, beside each other along east at 1 m, in lockstep at four times real time.
class RunningSwarm : public testing::Test {
 protected:
  static constexpr const char* kNames = "a,b,c";

  std::vector<std::string> on_this_domain(std::vector<std::string> words) const {
    words.insert(words.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return words;
  }
  std::vector<std::string> of_process(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--vehicle-name", kNames, "--clock", "lockstep"});
    return on_this_domain(more);
  }
  ProgramResult swiftlet(const std::vector<std::string>& words) const {
    return run_program("swiftlet", on_this_domain(words), folder_.path(), kStuck);
  }
  // A command for all that it sees within a second.
  ProgramResult fleet(std::vector<std::string> words) const {
    words.insert(words.begin(), "fleet");
    words.insert(words.end(), {"--time", "1"});
    return swiftlet(words);
  }
  json status(const std::string& vehicle) const {
    const ProgramResult result = swiftlet({"status", "--json", "--watch", "0.2", "--vehicle-name", vehicle});
    return result.exit_code == 0 ? json::parse(result.output) : json::object();
  }
  std::string mode(const std::string& vehicle) const { return status(vehicle).value("mode", ""); }
  Eigen::Vector3d position(const std::string& vehicle) const {
    const json at = status(vehicle).at("position_ned_m");
    return {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
  }
  void arm(const std::string& names) const {
    ProgramResult armed;
    ASSERT_TRUE(eventually([&] {
      return (armed = swiftlet({"arm", "--vehicle-name", names})).exit_code == 0;
    })) << armed.errors;
  }
  void hover(const std::string& names) const {
    arm(names);
    const ProgramResult off = swiftlet({"takeoff", "1", "--vehicle-name", names});
    ASSERT_EQ(off.exit_code, 0) << off.errors;
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  Program plant_{"swiftlet-plant", of_process({"--speed", "4", "--spacing", "1"}), folder_.path()};
  Program mocap_{"swiftlet-mocap", of_process(), folder_.path()};
  Program control_{"swiftlet-control", of_process(), folder_.path()};
};

TEST_F(RunningSwarm, MovesAsOne) {
  hover(kNames);
  const Eigen::Vector3d a = position("a"), b = position("b"), c = position("c");
  const ProgramResult moved = fleet({"goto", "0.5", "1.2", "-1.4"});
  ASSERT_EQ(moved.exit_code, 0) << moved.errors;
  const Eigen::Vector3d move = Eigen::Vector3d(0.5, 1.2, -1.4) - (a + b + c) / 3.0;
  EXPECT_LT((position("a") - a - move).norm(), 0.06);
  EXPECT_LT((position("b") - b - move).norm(), 0.06);
  EXPECT_LT((position("c") - c - move).norm(), 0.06);

  // The answers take longer than the skew that is allowed: none goes on.
  const ProgramResult late = fleet({"goto", "0.3", "1.2", "-1.4", "--skew", "0"});
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_NE(late.errors.find("a: holds, because the last one may have begun "), std::string::npos)
      << late.errors;

  // A part of it, towards the rest.
  const ProgramResult refused = fleet({"goto", "0.5", "1.3", "-1.4", "--vehicle-name", "a"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("a would come too near to b: "), std::string::npos) << refused.errors;
  EXPECT_NE(refused.errors.find("nothing was sent"), std::string::npos) << refused.errors;
  // The vehicles and the safety of a fleet file.
  const std::string wide =
      folder_.write("wide.yaml",
                    "frame: ned\nsafety: {radius_xy_m: 0.6, radius_z_m: 0.6}\nvehicles:\n"
                    "  - {name: a, start_m: [0, 0], mission: square}\n"
                    "  - {name: b, start_m: [0, 1], mission: square}\n");
  const ProgramResult too_near = fleet({"goto", "0.5", "0.7", "-1.5", "--fleet", wide});
  EXPECT_EQ(too_near.exit_code, 2);
  EXPECT_NE(too_near.errors.find("a would come too near to b: "), std::string::npos) << too_near.errors;
  const ProgramResult both = fleet({"land", "--fleet", wide, "--radius-xy", "0.2"});
  EXPECT_EQ(both.exit_code, 2) << both.errors;
  // One refuses what lies outside its fence: the others hold.
  const ProgramResult outside = fleet({"goto", "0.5", "2.5", "-1.4"});
  EXPECT_EQ(outside.exit_code, 1);
  EXPECT_NE(outside.errors.find("a: holds, because c did not accept it"), std::string::npos)
      << outside.errors;
  EXPECT_LT((position("a") - a - move).norm(), 0.3);
}

TEST_F(RunningSwarm, LandsAndStopsAsOne) {
  hover(kNames);
  const ProgramResult one = fleet({"land", "--vehicle-name", "b"});
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(mode("b"), "disarmed");
  EXPECT_EQ(mode("a"), "holding");
  const ProgramResult all = fleet({"land"});
  ASSERT_EQ(all.exit_code, 0) << all.errors;
  for (const char* const name : {"a", "c"}) EXPECT_EQ(mode(name), "disarmed") << name;
  const ProgramResult again = fleet({"land"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.errors.find("no vehicle flies: nothing was sent"), std::string::npos) << again.errors;

  arm("a,b");
  EXPECT_EQ(fleet({"stop"}).exit_code, 2) << "without --yes";
  EXPECT_EQ(mode("a"), "armed");
  const ProgramResult stopped = fleet({"stop", "--yes", "--vehicle-name", "b"});
  EXPECT_EQ(stopped.exit_code, 0) << stopped.errors;
  EXPECT_EQ(mode("a"), "armed");
  EXPECT_EQ(mode("b"), "stopped");
  const ProgramResult all_stopped = fleet({"stop", "--yes"});
  EXPECT_EQ(all_stopped.exit_code, 0) << all_stopped.errors;
  for (const char* const name : {"a", "b", "c"}) EXPECT_EQ(mode(name), "stopped") << name;
}

// GIVEN a vehicle above one that stands WHEN all are to land THEN it holds, and the others land.
// GIVEN a vehicle that is powered, but has no control WHEN all are to land THEN the others land at once, and it is
// named unless it is known in time.
TEST_F(RunningSwarm, LandsNobodyOnAnotherAndTheOthersBesideAnUnknownOne) {
  hover("a,b");
  ASSERT_EQ(swiftlet({"goto", "0", "2", "-1.9", "--vehicle-name", "a"}).exit_code,
            0);  // above c, which stands
  const ProgramResult below = fleet({"land"});
  EXPECT_EQ(below.exit_code, 1);
  EXPECT_NE(below.errors.find("a: was not landed: it would come down on c"), std::string::npos)
      << below.errors;
  EXPECT_EQ(mode("a"), "holding");
  EXPECT_EQ(mode("b"), "disarmed");

  ASSERT_EQ(swiftlet({"goto", "0", "0", "-1", "--vehicle-name", "a"}).exit_code, 0);
  const Program powered("swiftlet-plant", on_this_domain({"--vehicle-name", "d", "--clock", "lockstep"}),
                        folder_.path());
  ASSERT_TRUE(eventually([&] {
    const std::string names = swiftlet({"list", "--names", "--time", "1"}).output;
    return names.find("d\n") != std::string::npos;
  }));
  const ProgramResult moved = fleet({"goto", "0.5", "1.2", "-1.4", "--timeout", "3"});
  EXPECT_EQ(moved.exit_code, 1);
  EXPECT_NE(moved.errors.find("d: mode and position are not known: nothing was sent"), std::string::npos)
      << moved.errors;
  Program patient("swiftlet", on_this_domain({"fleet", "land", "--timeout", "600"}), folder_.path());
  EXPECT_TRUE(eventually([&] { return mode("a") == "disarmed"; }));
  EXPECT_EQ(patient.errors().find("d: was not landed"), std::string::npos)
      << "it has not waited for d, and looks on for it";
  const ProgramResult landed = fleet({"land", "--timeout", "3"});
  EXPECT_EQ(landed.exit_code, 1);
  EXPECT_NE(landed.errors.find("d: was not landed: mode and position are not known"), std::string::npos)
      << landed.errors;

  const std::vector<std::string> of_d = on_this_domain({"--vehicle-name", "d", "--clock", "lockstep"});
  const Program mocap("swiftlet-mocap", of_d, folder_.path());
  const Program control("swiftlet-control", of_d, folder_.path());
  EXPECT_EQ(patient.wait(kStuck), 0) << patient.errors();
}

}  // namespace
}  // namespace swiftlet::tests
