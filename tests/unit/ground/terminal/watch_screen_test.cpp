#include "swiftlet/ground/terminal/watch_screen.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace swiftlet::ground {
namespace {

const Clock::time_point kNow = Clock::time_point() + std::chrono::hours(1);

template <class T>
void hear(Latest<T>& latest, const T& message) {
  latest = {message, kNow, 1};
}

// Holding at 1 m, without warnings.
View in_flight() {
  View view;
  msg::ControlStatus control;
  control.mode(msg::ControlStatus_Constants::MODE_HOLDING);
  control.reason() = "take-off completed";
  control.airborne(true);
  control.has_pose(true);
  control.cycles(1000);
  control.low_battery_voltage_v(3.5);
  control.critical_battery_voltage_v(3.3);
  hear(view.control, control);
  msg::Estimate estimate;
  estimate.position_ned({0.001, 0.0, -1.0});
  hear(view.estimate, estimate);
  msg::Reference reference;
  reference.position_ned({0.0, 0.0, -1.0});
  hear(view.reference, reference);
  msg::Battery battery;
  battery.voltage_v(3.9);
  battery.state_of_charge(0.5);
  hear(view.battery, battery);
  msg::VehicleInfo vehicle;
  hear(view.vehicle, vehicle);
  return view;
}

WatchFacts facts() {
  WatchFacts facts;
  facts.vehicle = "kl1";
  return facts;
}

std::string text_of(const std::vector<ScreenLine>& lines) {
  std::string text;
  for (const ScreenLine& line : lines) text += line.text + "\n";
  return text;
}

TEST(WatchScreen, FitsAnyScreenSizeWithKeysOnTheLastLine) {
  View view = in_flight();
  view.battery.message.voltage_v(3.0);
  for (const int width : {1, 10, 40, 80, 200}) {
    for (const int height : {1, 2, 5, 24, 60}) {
      const auto lines = watch_screen(view, facts(), kNow, width, height);
      ASSERT_EQ(lines.size(), static_cast<std::size_t>(height));
      for (const ScreenLine& line : lines) ASSERT_LE(line.text.size(), static_cast<std::size_t>(width));
      EXPECT_EQ(lines.back().text, std::string("h hold   l land   s stop (rotors off)   q quit")
                                       .substr(0, static_cast<std::size_t>(width)));
    }
  }
  const auto small = watch_screen(view, facts(), kNow, 80, 3);
  EXPECT_EQ(small[0].text, "kl1 in domain 0: holding (take-off completed), airborne");
  EXPECT_EQ(small[1].text, "! battery is critical: 3.00 V, below 3.30 V")
      << "the most important warning stays";
  EXPECT_EQ(small[1].emphasis, Emphasis::kWarning);
}

TEST(WatchScreen, ShowsPositionAndTrackingError) {
  const std::string text = text_of(watch_screen(in_flight(), facts(), kNow, 100, 40));
  EXPECT_NE(text.find("no warnings\n"), std::string::npos) << text;
  EXPECT_NE(text.find("position       0.001    0.000   -1.000 m\n"), std::string::npos) << text;
  EXPECT_NE(text.find("error            1.0      0.0      0.0 mm   3-D 1.0 mm\n"), std::string::npos) << text;
}

TEST(WatchScreen, ShowsWhatItWaitsFor) {
  WatchFacts waiting = facts();
  waiting.where = "no control service for vehicle kl1 in domain 0";
  const std::string text = text_of(watch_screen(View(), waiting, kNow, 100, 10));
  EXPECT_NE(text.find("waiting: no control service for vehicle kl1"), std::string::npos) << text;
  EXPECT_EQ(watch_line(View(), waiting, kNow),
            "kl1: waiting: no control service for vehicle kl1 in domain 0");
}

TEST(Warnings, NameEveryAbnormalCondition) {
  EXPECT_TRUE(warnings_of(in_flight(), kNow).empty());
  const auto warns = [](const std::function<void(View&)>& change, const std::string& sentence) {
    View view = in_flight();
    change(view);
    const auto warnings = warnings_of(view, kNow);
    EXPECT_TRUE(std::find(warnings.begin(), warnings.end(), sentence) != warnings.end()) << sentence;
  };
  warns([](View& v) { v.control.received -= std::chrono::seconds(3); }, "no control status for 3 s");
  warns([](View& v) { v.control.message.mode(msg::ControlStatus_Constants::MODE_STOPPED); },
        "rotors stopped: take-off completed");
  warns([](View& v) { v.control.message.has_pose(false); }, "no pose for 0.0 s");
  warns([](View& v) { v.battery.message.voltage_v(3.4); }, "battery is low: 3.40 V, below 3.50 V");
  warns([](View& v) { v.battery.message.voltage_v(3.2); }, "battery is critical: 3.20 V, below 3.30 V");
  warns([](View& v) { v.estimate.message.position_ned({0.5, 0, -1}); }, "tracking error 0.50 m");
  warns([](View& v) { v.control.message.saturated(true); }, "commands saturate at the rotor limits");
  warns([](View& v) { v.control.message.deadline_misses(50); }, "5.0 % of the control steps are late");
  warns([](View& v) { v.vehicle.message.fault() = "no commands"; }, "vehicle: no commands");
  warns([](View& v) { v.estimate.message.pose_fault(msg::Estimate_Constants::POSE_FAULT_FROZEN); },
        "poses are refused: frozen");
  EXPECT_EQ(warnings_of(View(), kNow), std::vector<std::string>({"no control service"}));
}

// The thresholds come from the vehicle's settings, not from the defaults of this program.
TEST(Warnings, UseTheBatteryThresholdsOfTheVehicle) {
  View view = in_flight();
  view.control.message.low_battery_voltage_v(6.8);  // two cells
  view.control.message.critical_battery_voltage_v(6.4);
  view.battery.message.voltage_v(6.7);
  EXPECT_EQ(warnings_of(view, kNow), std::vector<std::string>({"battery is low: 6.70 V, below 6.80 V"}));
  EXPECT_NE(text_of(watch_screen(view, facts(), kNow, 100, 40)).find("lands below 6.80 V\n"),
            std::string::npos);

  view.control.message.low_battery_voltage_v(3.0);
  view.control.message.critical_battery_voltage_v(2.8);
  view.battery.message.voltage_v(3.2);
  EXPECT_EQ(warnings_of(view, kNow), std::vector<std::string>());
}

TEST(Warnings, MarkAnAssumedThreshold) {
  View view = in_flight();
  view.control.message.low_battery_voltage_v(0.0);
  view.control.message.critical_battery_voltage_v(0.0);
  view.battery.message.voltage_v(3.2);
  EXPECT_EQ(warnings_of(view, kNow),
            std::vector<std::string>({"battery is low: 3.20 V, below 3.30 V (assumed)"}));
  EXPECT_NE(text_of(watch_screen(view, facts(), kNow, 100, 40)).find("lands below 3.30 V (assumed)\n"),
            std::string::npos);
}

}  // namespace
}  // namespace swiftlet::ground
