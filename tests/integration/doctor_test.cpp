// `swiftlet doctor network` on two hosts at the same time.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/networks.hpp"
#include "tests/support/shifted_clock.hpp"

namespace swiftlet::tests {
namespace {

class Doctors : public Networks {
 protected:
  // Runs `swiftlet doctor network` on hosts 0 and 1 at the same time. Returns the report of host 0.
  json examine() const {
    const Words words = {"doctor", "network", "--time", time_s_, "--json"};
    const std::unique_ptr<Program> other = start_other(words);
    const ProgramResult own = swiftlet(0, words);
    EXPECT_NE(other->wait(kStuck), -1) << other->errors();
    json report = json::parse(own.output);
    EXPECT_EQ(own.exit_code, report.at("faults").empty() ? 0 : 1) << own.output << own.errors;
    return report;
  }
  std::unique_ptr<Program> start_other(const Words& words) const {
    const ShiftedClock clock(folder_.path() / "shift", clock_);
    return start(1, "swiftlet", words);
  }
  // The same until a report meets the predicate: on a busy machine one may end before the other begins.
  json examine_until(const std::function<bool(const json&)>& predicate) const {
    json report;
    EXPECT_TRUE(eventually([&] { return predicate(report = examine()); })) << report;
    return report;
  }
  bool has_measured(const json& report) const {
    const json& hosts = report.at("hosts");
    return hosts.size() == 1 && hosts[0].at("answered") > 0 && report.at("faults").empty();
  }
  void expect_plausible(const json& host) const {
    EXPECT_EQ(host.at("address"), hosts_->address(1));
    EXPECT_LE(host.at("answered"), host.at("sent"));
    const double shortest_ms = host.at("round_trip_min_ms");
    EXPECT_GT(shortest_ms, 0.0);
    EXPECT_LE(host.at("round_trip_min_ms"), host.at("round_trip_median_ms"));
    expect_offset(host, 0.0, 0.0);
  }
  void expect_offset(const json& host, double least_ms, double largest_ms) const {
    const double offset_ms = host.at("clock_offset_ms");
    const double uncertainty_ms = host.at("clock_uncertainty_ms");
    EXPECT_GE(offset_ms, least_ms - uncertainty_ms) << host;
    EXPECT_LE(offset_ms, largest_ms + uncertainty_ms) << host;
    EXPECT_GT(uncertainty_ms, 0.0);
  }

  std::string time_s_ = "1";
  ClockShift clock_{};  // of host 1
};

TEST_F(Doctors, MeasureMulticastAndTheClockOfAHostOverASwitch) {
  connect(Layout::kSwitch);
  options_ = {{}, {}, {}};
  const json report = examine_until([&](const json& it) { return has_measured(it); });
  ASSERT_EQ(report.at("interfaces").size(), 1U) << report;
  EXPECT_EQ(report.at("interfaces")[0].at("name"), "eth0");
  EXPECT_EQ(report.at("interfaces")[0].at("mtu_bytes"), 1500);
  EXPECT_EQ(report.at("interfaces")[0].at("own_multicast"), true);
  EXPECT_EQ(report.at("hosts")[0].at("multicast_from_there"), true);
  EXPECT_EQ(report.at("hosts")[0].at("multicast_to_there"), true);
  expect_plausible(report.at("hosts")[0]);

  clock_.shift_s = 3;
  clock_.drift_ppm = 1000.0;
  time_s_ = "3";  // in 1 s the filter's prior of 200 ppm pulls the drift by more than its uncertainty
  const json drifts = examine_until([&](const json& it) {
    if (!has_measured(it)) return false;
    const json& uncertainty_ppm = it.at("hosts")[0].at("clock_drift_uncertainty_ppm");
    return uncertainty_ppm.is_number() && uncertainty_ppm < 60.0;
  });
  EXPECT_NEAR(drifts.at("hosts")[0].at("clock_drift_ppm").get<double>(), 1000.0, 200.0) << drifts;
  expect_offset(drifts.at("hosts")[0], 3000.0, 3060.0);  // drifts for up to a minute
  EXPECT_EQ(drifts.at("hosts")[0].at("clock_steps"), 0);
  EXPECT_EQ(drifts.at("hints").back().get<std::string>().rfind("the clock of ", 0), 0U) << drifts;

  time_s_ = "1";
  clock_.drift_ppm = 0.0;
  clock_.step_s = 1.0;
  clock_.step_after_s = 0.6;
  const json steps = examine_until(
      [&](const json& it) { return has_measured(it) && it.at("hosts")[0].at("clock_steps") == 1; });
  expect_offset(steps.at("hosts")[0], 4000.0, 4000.0);
  EXPECT_NE(steps.at("hints").back().get<std::string>().find("stepped while it was measured"),
            std::string::npos)
      << steps;
}

TEST_F(Doctors, FindEachOtherThroughRoutersByPeersOnly) {
  connect(Layout::kRouter);
  options_ = {{}, {}, {}};
  const json alone = examine();
  EXPECT_EQ(alone.at("hosts"), json::array());
  ASSERT_EQ(alone.at("faults").size(), 1U) << alone;
  EXPECT_EQ(alone.at("faults")[0].get<std::string>().rfind("nobody answers in domain 0: ", 0), 0U) << alone;

  options_ = all_peers();
  const std::unique_ptr<Program> plant = start(2, "swiftlet-plant", {});
  const json report = examine_until([&](const json& it) {
    const json& processes = it.at("processes");
    return has_measured(it) && std::any_of(processes.begin(), processes.end(), [&](const json& process) {
             return process.at("name") == "plant" && process.at("process") == plant->pid();
           });
  });
  EXPECT_EQ(report.at("hosts")[0].at("multicast_from_there"), false);
  expect_plausible(report.at("hosts")[0]);
  const std::string silent = "peer " + hosts_->address(2) + " did not answer";  // no doctor there
  const json& hints = report.at("hints");
  EXPECT_TRUE(std::any_of(hints.begin(), hints.end(), [&](const json& hint) {
    return hint.get<std::string>().rfind(silent, 0) == 0;
  })) << report;
}

}  // namespace
}  // namespace swiftlet::tests
