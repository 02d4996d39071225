// Several vehicles served by one process of each role: each fails, is suspended and is taken over alone.
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/text.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class Hosting : public testing::Test {
 protected:
  std::unique_ptr<Program> start(const std::string& role, const std::string& vehicles,
                                 std::vector<std::string> more) const {
    more.insert(more.end(),
                {"--vehicle-name", vehicles, "--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return std::make_unique<Program>("swiftlet-" + role, more, folder_.path());
  }
  ProgramResult ask(const std::string& vehicles, std::vector<std::string> words) const {
    words.insert(words.end(), {"--vehicle-name", vehicles, "--domain", std::to_string(lock_.domain()),
                               "--localhost-only"});
    return run_program("swiftlet", words, folder_.path());
  }
  json status_of(const std::string& vehicle) const {
    const ProgramResult result = ask(vehicle, {"status", "--json", "--watch", "0.1"});
    return result.exit_code == 0 ? json::parse(result.output) : json();
  }
  bool accepts(const std::string& vehicles, const std::vector<std::string>& words) const {
    return eventually([&] { return ask(vehicles, words).exit_code == 0; });
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
};

TEST_F(Hosting, AVehicleWhoseControllerIsSuspendedEndsAloneAndCanBeReplaced) {
  const std::vector<std::string> lockstep{"--clock", "lockstep"};
  const auto plant =
      start("plant", "kl1..kl2,base", {"--clock", "lockstep", "--spacing", "0.5", "--patience", "1"});
  const auto mocap = start("mocap", "kl1,kl2,base", lockstep);
  const auto control = start("control", "kl1,base", lockstep);
  const auto suspended = start("control", "kl2", lockstep);
  ASSERT_TRUE(accepts("kl1,kl2,base", {"arm"})) << plant->errors();

  // GIVEN a controller that no longer runs THEN the plant ends its vehicle, and the others take off.
  suspended->signal(SIGSTOP);
  ASSERT_TRUE(accepts("kl1,base", {"takeoff", "0.3", "--wait", "20"}));
  const char* const sentence = "kl2: lockstep: control is silent: IMU sample ";
  ASSERT_TRUE(eventually([&] { return plant->errors().find(sentence) != std::string::npos; }))
      << plant->errors();
  EXPECT_NE(plant->errors().find("this vehicle ends, 2 go on"), std::string::npos) << plant->errors();
  EXPECT_FALSE(plant->exit_code());

  // Another process may serve the vehicle now.
  std::unique_ptr<Program> other;
  EXPECT_TRUE(eventually([&] {
    other = start("plant", "kl2", lockstep);
    eventually([&] { return other->errors().find("ready: ") != std::string::npos || other->exit_code(); });
    return !other->exit_code();
  })) << other->errors();

  plant->signal(SIGTERM);
  EXPECT_EQ(plant->wait(kStuck), 1);
  EXPECT_NE(plant->errors().find("1 of 3 vehicles failed: " + std::string(sentence)), std::string::npos)
      << plant->errors();
  mocap->signal(SIGTERM);
  EXPECT_EQ(mocap->wait(kStuck), 0) << mocap->errors();
}

TEST_F(Hosting, AStandbyTakesOverAHostedVehicle) {
  const auto plant = start("plant", "kl1..kl2", {"--speed", "2"});
  const auto mocap = start("mocap", "kl1..kl2", {});
  const auto first = start("control", "kl1..kl2", {"--failover-priority", "5"});
  ASSERT_TRUE(accepts("kl1,kl2", {"arm"})) << first->errors();
  const auto standby = start("control", "kl2", {});
  ASSERT_TRUE(accepts("kl2", {"takeoff", "0.3", "--wait", "20"}));
  ASSERT_TRUE(eventually([&] {
    const json status = status_of("kl2");
    return status.is_object() && status.at("controllers").size() == 2;
  })) << status_of("kl2").dump();
  first->signal(SIGKILL);
  ASSERT_TRUE(eventually([&] { return standby->errors().find("role is active") != std::string::npos; }))
      << standby->errors();
  const json after = status_of("kl2");
  EXPECT_EQ(after.at("mode"), "holding") << after.dump();
  EXPECT_EQ(standby->errors().find("kl2: "), std::string::npos) << "one vehicle alone has no label";
}

TEST_F(Hosting, StatusOfSeveralVehiclesIsATableAndOfOneHasShortLines) {
  const auto plant = start("plant", "kl1,longer", {});
  const auto mocap = start("mocap", "kl1,longer", {});
  const auto control = start("control", "kl1,longer", {});
  ASSERT_TRUE(accepts("kl1,longer", {"arm"})) << control->errors();
  const ProgramResult table = ask("kl1,longer", {"status", "--watch", "0.1"});
  ASSERT_EQ(table.exit_code, 0) << table.errors;
  const std::vector<std::string> rows = io::split_text(table.output, '\n');
  ASSERT_GE(rows.size(), 3U) << table.output;
  EXPECT_EQ(rows[0].rfind("vehicle mode ", 0), 0U) << table.output;
  EXPECT_EQ(rows[1].rfind("kl1     armed ", 0), 0U) << table.output;
  EXPECT_EQ(rows[2].rfind("longer  armed ", 0), 0U) << table.output;
  for (const std::string& row : {rows[1], rows[2]}) EXPECT_EQ(row.size(), rows[0].size()) << table.output;
  EXPECT_EQ(json::parse(ask("kl1,longer", {"status", "--json"}).output).at("longer").at("mode"), "armed");
  for (const std::string& line : io::split_text(ask("kl1", {"status"}).output, '\n'))
    EXPECT_LT(line.size(), 100U) << line;
}

TEST_F(Hosting, RefusesABadListInOneSentence) {
  for (const char* const role : {"plant", "mocap", "control"}) {
    const auto program = start(role, "kl1..kl4,kl2", {});
    EXPECT_EQ(program->wait(kStuck), 2) << role;
    EXPECT_NE(program->errors().find("--vehicle-name: names kl2 twice"), std::string::npos)
        << program->errors();
  }
  const auto plant = start("plant", "kl1,kl2", {"--clock", "lockstep", "--trace", "trace.csv"});
  EXPECT_EQ(plant->wait(kStuck), 2);
  EXPECT_NE(plant->errors().find("--trace: of several vehicles the path must contain {}"), std::string::npos);
}

}  // namespace
}  // namespace swiftlet::tests
