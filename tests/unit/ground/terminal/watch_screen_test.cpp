#include "swiftlet/ground/terminal/watch_screen.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace swiftlet::ground::watch_screen_test {

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
  control.imu_age_s(0.001);
  control.mocap_age_s(0.01);
  control.battery_age_s(0.1);
  control.cycles(1000);
  control.low_battery_voltage_v(3.5);
  control.critical_battery_voltage_v(3.3);
  hear(view.control, control);
  msg::Estimate estimate;
  estimate.position_ned({0.001, 0.0, -1.0});
  estimate.q_ned_from_frd({0.9238795325, 0.0, 0.0, -0.3826834324});  // yaw -45 deg
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

TEST(WatchScreen, FitsAnyScreenSize) {
  View view = in_flight();
  view.battery.message.voltage_v(3.0);
  for (const int width : {1, 10, 40, 80, 200}) {
    for (const int height : {1, 2, 5, 24, 60}) {
      const auto lines = watch_screen(view, facts(), kNow, width, height);
      ASSERT_EQ(lines.size(), static_cast<std::size_t>(height));
      for (const ScreenLine& line : lines)
        ASSERT_EQ(cut_to(line.text, static_cast<std::size_t>(width)), line.text);
    }
  }
  const auto small = watch_screen(view, facts(), kNow, 80, 3);
  EXPECT_EQ(small[0].text, "kl1 in domain 0: holding (take-off completed), airborne");
  EXPECT_EQ(small[1].text, "! battery is critical: 3.00 V, below 3.30 V")
      << "the most important warning stays";
  EXPECT_EQ(small[1].emphasis, Emphasis::kWarning);
}

TEST(WatchScreen, ShowsTheKeysBelow) {
  EXPECT_EQ(watch_screen(in_flight(), facts(), kNow, 80, 24).back().text,
            "h hold   l land   s stop (rotors off): each asks for y   q quit");
  EXPECT_EQ(watch_screen(in_flight(), facts(), kNow, 40, 3).back().text, "h hold l land s stop q quit");
}

TEST(WatchScreen, ShowsTheClockOfMotionCapture) {
  View view = in_flight();
  const auto text = [&] { return text_of(watch_screen(view, facts(), kNow, 80, 60)); };
  EXPECT_EQ(text().find("clock  "), std::string::npos);
  msg::ClockStatus clock;
  clock.known(true);
  clock.offset_ns(3'000'524'000);
  clock.drift(50.2e-6);
  clock.steps(1);
  hear(view.clock, clock);
  EXPECT_NE(text().find("clock       +3.000524 s, +50.2 ppm, set once\n"), std::string::npos) << text();
  EXPECT_TRUE(warnings_of(view, kNow).empty());
  view.clock.message.steps(2);
  view.clock.message.known(false);
  EXPECT_NE(text().find(" ppm, set 2 times\n"), std::string::npos) << text();
  EXPECT_EQ(warnings_of(view, kNow),
            std::vector<std::string>({"poses are withheld: the clock of motion capture is unknown"}));
}

TEST(WatchScreen, SaysThatLinesAreCutOrLeftOut) {
  const auto narrow = watch_screen(in_flight(), facts(), kNow, 30, 60);
  EXPECT_EQ(narrow.back().text, "terminal too small, 80x24 sho" + std::string(kCut));
  EXPECT_NE(text_of(narrow).find("position       0.001    0.000" + std::string(kCut)), std::string::npos);
  const auto small = watch_screen(in_flight(), facts(), kNow, 40, 12);
  EXPECT_EQ(small[10].text, "h hold l land s stop q quit");
  EXPECT_EQ(small[11].text, "terminal too small, 80x24 shows all");
  EXPECT_EQ(small[11].emphasis, Emphasis::kWarning);
  EXPECT_EQ(text_of(watch_screen(in_flight(), facts(), kNow, 80, 24)).find("too small"), std::string::npos);
}

TEST(CutTo, CountsCharactersAndMarksTheCut) {
  EXPECT_EQ(cut_to("abc", 3), "abc");
  EXPECT_EQ(cut_to("abcd", 3), "ab" + std::string(kCut));
  EXPECT_EQ(cut_to("ab" + std::string(kCut), 3), "ab" + std::string(kCut));
  EXPECT_EQ(cut_to("abc", 0), "");
}

TEST(WatchScreen, ShowsPositionAndTrackingError) {
  const std::string text = text_of(watch_screen(in_flight(), facts(), kNow, 100, 40));
  EXPECT_NE(text.find("no warnings\n"), std::string::npos) << text;
  EXPECT_NE(text.find("position       0.001    0.000   -1.000 m\n"), std::string::npos) << text;
  EXPECT_NE(text.find("error            1.0      0.0      0.0 mm   3-D 1.0 mm\n"), std::string::npos) << text;
}

TEST(WatchScreen, ShowsAttitudeAndHeading) {
  const std::string text = text_of(watch_screen(in_flight(), facts(), kNow, 80, 24));
  EXPECT_NE(text.find("attitude    roll 0.0, pitch 0.0, heading 315.0 deg\n"), std::string::npos) << text;
  EXPECT_NE(watch_line(in_flight(), facts(), kNow).find("heading 315.0 deg"), std::string::npos);
}

TEST(WatchScreen, ShowsFirstWhoIsSilent) {
  View view = in_flight();
  view.control.message.imu_age_s(3.0);
  view.battery.message.voltage_v(3.0);
  for (const int width : {80, 200}) {
    const auto lines = watch_screen(view, facts(), kNow, width, 24);
    EXPECT_EQ(lines[0].text.rfind("VEHICLE SILENT for 3.0 s, since ", 0), 0U) << lines[0].text;
    EXPECT_EQ(lines[0].emphasis, Emphasis::kWarning);
    EXPECT_EQ(lines[1].text, "kl1 in domain 0: holding (take-off completed), airborne");
    EXPECT_EQ(text_of(lines).find("no warnings"), std::string::npos);
  }
  EXPECT_EQ(watch_line(view, facts(), kNow).rfind("kl1: VEHICLE SILENT for 3.0 s, since ", 0), 0U);
  view = in_flight();
  view.control.received -= std::chrono::seconds(3);
  const auto lines = watch_screen(view, facts(), kNow, 80, 24);
  EXPECT_EQ(lines[0].text.rfind("CONTROL SERVICE SILENT for 3.0 s", 0), 0U) << lines[0].text;
  EXPECT_EQ(lines[1].text, "kl1 in domain 0: last known: holding (take-off completed), airborne");
}

TEST(WatchScreen, UsesAWideScreenInTwoColumns) {
  const auto line_with = [](const std::vector<ScreenLine>& lines, const std::string& word) {
    return std::find_if(lines.begin(), lines.end(), [&](const ScreenLine& line) {
      return line.text.rfind(word, 0) == 0 || line.right_text.rfind(word, 0) == 0;
    });
  };
  for (const int width : {kWideScreen, 200}) {
    const auto lines = watch_screen(in_flight(), facts(), kNow, width, 12);
    for (const char* word : {"position", "attitude", "error"}) {
      ASSERT_NE(line_with(lines, word), lines.end()) << word;
      EXPECT_LE(line_with(lines, word)->text.size(), static_cast<std::size_t>(kRightColumn) - 1);
    }
    for (const char* word : {"battery", "rates", "latency", "control ", "controllers"}) {
      ASSERT_NE(line_with(lines, word), lines.end()) << word;
      EXPECT_NE(line_with(lines, word)->right_text, "") << word;
      EXPECT_LE(line_with(lines, word)->right_text.size(), static_cast<std::size_t>(width - kRightColumn));
    }
  }
  for (const ScreenLine& line : watch_screen(in_flight(), facts(), kNow, kWideScreen - 1, 40))
    EXPECT_EQ(line.right_text, "");
}

TEST(WatchScreen, WrapsWhatDoesNotFitOnALine) {
  WatchFacts waiting = facts();
  waiting.where =
      "no control service for vehicle kl1 in domain 0; processes found: none; is it running in this domain "
      "(--domain, ROS_DOMAIN_ID)?";
  const std::string text = text_of(watch_screen(View(), waiting, kNow, 80, 10));
  EXPECT_NE(text.find("ROS_DOMAIN_ID)?"), std::string::npos) << text;

  WatchFacts refused = facts();
  refused.message = "hold: " + waiting.where;
  const auto lines = watch_screen(in_flight(), refused, kNow, 80, 24);
  ASSERT_EQ(lines.size(), 24U);
  EXPECT_EQ(lines[22].text.rfind("hold: no control service", 0), 0U) << lines[22].text;
  EXPECT_NE(lines[23].text.find("ROS_DOMAIN_ID)?"), std::string::npos) << lines[23].text;
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
  warns([](View& v) { v.control.message.source_conflict() = "IMU samples of b are ignored"; },
        "IMU samples of b are ignored");
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

}  // namespace swiftlet::ground::watch_screen_test
