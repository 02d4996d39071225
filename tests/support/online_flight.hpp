// Fixtures for the online commands with running processes, each on its own DDS domain.
#pragma once

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {

using namespace std::chrono_literals;
using nlohmann::json;

class Online : public testing::Test {
 protected:
  std::vector<std::string> network() const {
    return {"--domain", std::to_string(lock_.domain()), "--vehicle-name", "kl7", "--localhost-only"};
  }
  // Runs `swiftlet` with these arguments on this domain.
  ProgramResult swiftlet(std::vector<std::string> words, std::chrono::milliseconds timeout = kStuck) const {
    for (const std::string& word : network()) words.push_back(word);
    return run_program("swiftlet", std::move(words), folder_.path(), timeout);
  }
  std::vector<std::string> lockstep(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = network();
    words.insert(words.end(), {"--clock", "lockstep"});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  json status() const {
    const ProgramResult result = swiftlet({"status", "--json", "--watch", "0.1"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.exit_code == 0 ? json::parse(result.output) : json();
  }
  // Waits until the status meets the predicate; otherwise prints the last one and logs().
  template <class Predicate>
  bool reaches(const char* what, const Predicate& predicate) const {
    json last;
    const bool reached = eventually([&] { return predicate(last = status()); }, kStuck);
    EXPECT_TRUE(reached) << what << "\n" << last << "\n" << logs();
    return reached;
  }
  virtual std::string logs() const { return ""; }

  comms::DomainLock lock_;
  TemporaryFolder folder_;
};

// In lockstep at twice real time: the tools use the vehicle's clock as with a real vehicle, and a busy
// machine slows the flight down instead of failing it.
class OnlineFlight : public Online {
 protected:
  OnlineFlight()
      : plant_("swiftlet-plant", lockstep({"--speed", "2"}), folder_.path()),
        mocap_("swiftlet-mocap", lockstep(), folder_.path()),
        control_("swiftlet-control", lockstep(), folder_.path()) {}

  void SetUp() override {
    ASSERT_TRUE(reaches("has_pose", [](const json& status) { return status.at("has_pose") == true; }));
  }

  std::string logs() const override { return plant_.errors() + mocap_.errors() + control_.errors(); }

  bool reaches_mode(const std::string& mode) const {
    return reaches(mode.c_str(), [&](const json& status) { return status.at("mode") == mode; });
  }
  bool reaches_place(double x, double y, double z) const {
    return reaches("place", [&](const json& status) {
      const auto& at = status.at("position_ned_m");
      return std::hypot(at[0].get<double>() - x, at[1].get<double>() - y, at[2].get<double>() - z) < 0.02;
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
  void take_off() const {
    expect_accepted({"arm"});
    expect_accepted({"takeoff", "0.6"});
    ASSERT_TRUE(reaches_mode("holding"));
  }

  std::vector<std::string> attach(const std::string& mission) const {
    return {"fly",
            mission,
            "--attach",
            "--localhost-only",
            "--domain",
            std::to_string(lock_.domain()),
            "--vehicle-name",
            "kl7",
            "--json",
            "--record",
            folder_.path() / "record"};
  }

  Program plant_, mocap_, control_;
};

}  // namespace swiftlet::tests
