// Fixtures for the online commands with running processes, each on its own DDS domain.
#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {

using namespace std::chrono_literals;
using ground::VehicleState;
using nlohmann::json;

class Online : public testing::Test {
 protected:
  std::vector<std::string> network() const {
    return {"--domain", std::to_string(lock_.domain()), "--vehicle-name", "kl7", "--localhost-only"};
  }
  std::vector<std::string> on_network(std::vector<std::string> words) const {
    for (const std::string& word : network()) words.push_back(word);
    return words;
  }
  // Runs `swiftlet` with these arguments on this domain.
  ProgramResult swiftlet(std::vector<std::string> words) const {
    return run_program("swiftlet", on_network(std::move(words)), folder_.path(), kStuck);
  }
  // Starts it.
  Program begin(std::vector<std::string> words) const {
    return {"swiftlet", on_network(std::move(words)), folder_.path()};
  }
  std::unique_ptr<Program> start_in_lockstep(const char* program, std::vector<std::string> words = {}) const {
    words.insert(words.end(), {"--clock", "lockstep"});
    return std::make_unique<Program>(program, on_network(std::move(words)), folder_.path());
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
};

// A vehicle that flies in lockstep at up to ten times real time: the tools follow its clock as with a real vehicle, and
// a busy machine slows the flight down instead of failing it. The test flies it by the C++ API; what is tested, by
// the tools.
class OnlineFlight : public Online {
 protected:
  OnlineFlight() : vehicle_(settings()) {}
  ~OnlineFlight() override {  // they end at the same time
    for (Program* const process : {plant_.get(), mocap_.get(), control_.get()}) {
      if (process != nullptr) process->signal(SIGTERM);
    }
  }

  void SetUp() override { start(); }

  void start(const char* speed = "10", std::vector<std::string> plant_options = {},
             std::vector<std::string> control_options = {}) {
    plant_options.insert(plant_options.end(), {"--speed", speed});
    plant_ = start_in_lockstep("swiftlet-plant", std::move(plant_options));
    mocap_ = start_in_lockstep("swiftlet-mocap");
    control_ = start_in_lockstep("swiftlet-control", std::move(control_options));
    ASSERT_TRUE(reaches("has_pose", [](const VehicleState& state) { return state.has_pose; }));
  }

  json status() const {
    const ProgramResult result = swiftlet({"status", "--json", "--watch", "0.1"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.exit_code == 0 ? json::parse(result.output) : json();
  }

  VehicleState state() const { return vehicle_.state(); }
  // Waits until the state meets the predicate; otherwise prints what the processes said.
  bool reaches(const std::string& what, const std::function<bool(const VehicleState&)>& predicate) const {
    const bool reached = vehicle_.wait_until(predicate, kStuck);
    const VehicleState now = state();
    EXPECT_TRUE(reached) << what << ": " << control::to_string(now.mode) << " (" << now.mode_reason
                         << "), at " << now.position_ned_m.transpose() << "\n"
                         << plant_->errors() << mocap_->errors() << control_->errors();
    return reached;
  }
  bool reaches_mode(control::Mode mode) const {
    return reaches(control::to_string(mode),
                   [mode](const VehicleState& state) { return state.mode == mode; });
  }
  bool reaches_place(double x, double y, double z) const {
    return reaches("place", [&](const VehicleState& state) {
      return (state.position_ned_m - Eigen::Vector3d(x, y, z)).norm() < 0.02;
    });
  }

  // Does not wait until the action ends.
  void expect_accepted(std::vector<std::string> words) const {
    const std::string what = words.front();
    words.emplace_back("--no-wait");
    const ProgramResult result = swiftlet(words);
    EXPECT_EQ(result.exit_code, 0) << what << ": " << result.errors;
    EXPECT_EQ(result.output, what + ": accepted by kl7\n");
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& reason) const {
    const ProgramResult result = swiftlet(words);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors, "swiftlet: " + words.front() + ": " + reason + "\n");
  }
  void arm() {
    ground::Result armed;  // refused until control has heard the battery too
    ASSERT_TRUE(eventually([&] { return (armed = vehicle_.arm(kStuck).answer()).accepted(); }))
        << armed.reason;
  }
  void take_off() {
    ASSERT_NO_FATAL_FAILURE(arm());
    const ground::ActionResult off = vehicle_.take_off(0.6, 0.8, kStuck).wait(kStuck);
    ASSERT_TRUE(off.done()) << off.reason;
  }
  void land() {
    const ground::ActionResult landed = vehicle_.land(0.4, kStuck).wait(kStuck);
    ASSERT_TRUE(landed.done()) << landed.reason;
  }

  dds::NodeSettings settings() const {
    dds::NodeSettings settings = settings_of("test", lock_);
    settings.vehicle = "kl7";
    return settings;
  }

  std::unique_ptr<Program> plant_, mocap_, control_;
  ground::Vehicle vehicle_;
};

}  // namespace swiftlet::tests
