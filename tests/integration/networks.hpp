// Processes on three hosts: network namespaces on a switch, or behind a router that forwards no multicast.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {

using nlohmann::json;
using Layout = HostNetwork::Layout;
using Words = std::vector<std::string>;

// Plant and motion capture on host 0, control on host 1, and the ground tools on host 2. In lockstep, so that a busy
// machine slows the flight down instead of failing it.
class Networks : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  }

  void connect(Layout layout) { hosts_ = std::make_unique<HostNetwork>(layout, 3); }
  void start_all(const std::vector<Words>& options_of_hosts) {
    options_ = options_of_hosts;
    plant_ = start(0, "swiftlet-plant", {"--clock", "lockstep", "--speed", "16"});
    mocap_ = start(0, "swiftlet-mocap", {"--clock", "lockstep"});
    control_ = start(1, "swiftlet-control", {"--clock", "lockstep"});
  }
  // The other hosts, as peers.
  std::vector<Words> all_peers() const {
    const std::string a = hosts_->address(0);
    const std::string b = hosts_->address(1);
    const std::string c = hosts_->address(2);
    return {{"--peer", b, "--peer", c}, {"--peer", a, "--peer", c}, {"--peer", a, "--peer", b}};
  }

  std::unique_ptr<Program> start(int host, const std::string& program, Words words) const {
    const Words& options = options_.at(static_cast<std::size_t>(host));
    words.insert(words.end(), options.begin(), options.end());
    if (reach_ != nullptr) words.emplace_back(reach_);
    const HostNetwork::Inside inside(*hosts_, host);
    return std::make_unique<Program>(program, std::move(words), folder_.path());
  }
  ProgramResult swiftlet(int host, Words words) const {
    const std::unique_ptr<Program> program = start(host, "swiftlet", std::move(words));
    const int exit_code = program->wait(kStuck);
    return {exit_code, program->output(), program->errors()};
  }
  bool finds_the_vehicle(int host) const {
    return eventually([&] {
      const ProgramResult result = swiftlet(host, {"list", "--json"});
      if (result.exit_code != 0) return false;
      const json list = json::parse(result.output);
      return list.size() == 1 && list[0].at("mode") == "disarmed" && list[0].at("model") == "kaylion" &&
             list[0].at("controllers") == 1 && list[0].at("mocap_hz") > 20.0;
    });
  }
  // `swiftlet list` and `swiftlet doctor network` on host 1 find nothing, and say why.
  void expect_names_the_key(const Words& options, const std::string& sentence) const {
    for (Words words : {Words{"list"}, Words{"doctor", "network"}}) {
      words.insert(words.end(), options.begin(), options.end());
      ProgramResult result;
      EXPECT_TRUE(eventually([&] {
        result = swiftlet(1, words);
        return (result.output + result.errors).find(sentence) != std::string::npos;
      })) << sentence
          << " is not in " << result.output << result.errors;
      EXPECT_EQ(result.exit_code, 1) << words[0];
    }
  }
  // Whether the tools that show one vehicle do so.
  void expect_shows_the_vehicle(int host) const {
    const ProgramResult status = swiftlet(host, {"status", "--json", "--watch", "0.1"});
    EXPECT_EQ(status.exit_code, 0) << status.errors;
    Words words = options_.at(static_cast<std::size_t>(host));
    words.insert(words.begin(), "watch");
    words.emplace_back(reach_);
    const HostNetwork::Inside inside(*hosts_, host);
    Terminal watch("swiftlet", words, 100, 40);
    EXPECT_TRUE(eventually([&] { return watch.text().find("disarmed") != std::string::npos; }))
        << watch.text();
    watch.type("q");
    EXPECT_EQ(watch.wait(kStuck), 0);
  }
  void expect_flies(const Words& mission) const {
    Words words = {"fly"};
    words.insert(words.end(), mission.begin(), mission.end());
    words.insert(words.end(), {"--attach", "--json", "--record", (folder_.path() / "record").string()});
    const ProgramResult flight = swiftlet(2, words);
    ASSERT_EQ(flight.exit_code, 0) << flight.errors << logs();
    EXPECT_LT(json::parse(flight.output).at("rms_3d_m"), 0.05);
  }
  std::string logs() const { return plant_->errors() + mocap_->errors() + control_->errors(); }

  const char* reach_ = "--open-network";  // an option of all programs
  TemporaryFolder folder_;
  std::unique_ptr<HostNetwork> hosts_;
  std::vector<Words> options_;
  std::unique_ptr<Program> plant_, mocap_, control_;
};

}  // namespace swiftlet::tests
