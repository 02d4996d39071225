#include "swiftlet/analysis/pages/recorded/process_logs.hpp"

#include <ctime>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace swiftlet::pages::process_logs_test {

constexpr double kStart_s = 1.8e9;  // s since 1970

std::string at(int seconds, const std::string& text) {
  const auto time = static_cast<std::time_t>(kStart_s) + seconds;
  std::tm local{};
  ::localtime_r(&time, &local);
  std::string clock(16, ' ');
  clock.resize(std::strftime(clock.data(), clock.size(), "%H:%M:%S", &local));
  return clock + ".250 " + text + "\n";
}

FlightLog flight(double wall_start_s) {
  FlightLog out;
  out.start_s = -1.0;
  out.end_s = 40.0;
  out.wall_start_s = wall_start_s;
  out.events = {{2.0, "mode", "holding", false}};
  return out;
}

TEST(ProcessLogs, AreEventsAtTheirTimes) {
  const tests::TemporaryFolder folder;
  folder.write("swiftlet-control.log", at(1, "control info: plant joined") + "  continued\n" +
                                           at(39, "control warning: late: by 3 ms") +
                                           at(600, "control info: later"));
  folder.write("swiftlet-plant.log", at(3, "plant info: started"));
  folder.write("other.log", at(3, "other info: not of the flight"));
  FlightLog log = flight(kStart_s);
  add_process_logs(folder.path(), {"kl1"}, log);
  ASSERT_EQ(log.events.size(), 4U);
  EXPECT_EQ(log.events[0].text, "control info: plant joined");
  EXPECT_NEAR(log.events[0].time_s, 1.25, 1e-6);
  EXPECT_FALSE(log.events[0].warning);
  EXPECT_EQ(log.events[1].text, "holding");
  EXPECT_EQ(log.events[2].text, "plant info: started");
  EXPECT_EQ(log.events[3].text, "control warning: late: by 3 ms");
  EXPECT_TRUE(log.events[3].warning);
}

// A process that serves several vehicles names the one that a line is about.
TEST(ProcessLogs, AreThoseOfTheVehicle) {
  const tests::TemporaryFolder folder;
  folder.write("swiftlet-control.log", at(1, "control info: ready: vehicle kl1,kl2") +
                                           at(2, "control warning: kl1: mocap lost") +
                                           at(3, "control warning: kl2: mocap lost"));
  FlightLog log = flight(kStart_s);
  log.vehicle = "kl2";
  log.events.clear();
  add_process_logs(folder.path(), {"kl1", "kl2"}, log);
  ASSERT_EQ(log.events.size(), 2U);
  EXPECT_EQ(log.events[0].text, "control info: ready: vehicle kl1,kl2");
  EXPECT_EQ(log.events[1].text, "control warning: kl2: mocap lost");
}

TEST(ProcessLogs, HaveNoPlaceInSimulatedTime) {
  const tests::TemporaryFolder folder;
  folder.write("swiftlet-control.log", at(1, "control info: plant joined"));
  FlightLog log = flight(0.0);
  add_process_logs(folder.path(), {"kl1"}, log);
  EXPECT_EQ(log.events.size(), 1U);
}

}  // namespace swiftlet::pages::process_logs_test
