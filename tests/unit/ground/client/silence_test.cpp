#include "swiftlet/ground/client/silence.hpp"

#include <cmath>
#include <ctime>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::ground::silence_test {

using namespace std::chrono_literals;

const Clock::time_point kNow{1h};

template <class T>
Latest<T> heard(const T& message, Clock::time_point at) {
  return {message, at, 1};
}

// All stream; control_status is `age` old.
View healthy(std::chrono::milliseconds age = 0ms) {
  View view;
  msg::ControlStatus control;
  control.pose_age_s(0.01);
  control.imu_age_s(0.001);
  control.mocap_age_s(0.01);
  control.battery_age_s(0.05);
  view.control = heard(control, kNow - age);
  view.vehicle = heard(msg::VehicleInfo(), kNow);
  view.battery = heard(msg::Battery(), kNow);
  return view;
}

std::string text_of(const View& view) {
  std::string text;
  for (const Silence& silence : silences_of(view, kNow)) {
    text += silence.who + " " + (silence.for_s ? std::to_string(std::lround(*silence.for_s)) : "never") + ";";
  }
  return text;
}

TEST(Silences, AreNoneWhileAllSend) {
  EXPECT_EQ(text_of(healthy()), "");
  EXPECT_EQ(text_of(healthy(900ms)), "");
}

TEST(Silences, AreThoseThatControlReports) {
  View view = healthy();
  view.control.message.imu_age_s(3.0);
  view.control.message.mocap_age_s(4.0);
  view.control.message.battery_age_s(5.0);
  EXPECT_EQ(text_of(view), "vehicle 3;motion capture 4;battery 5;");
}

TEST(Silences, GrowWithTheAgeOfTheReport) {
  View view = healthy(600ms);
  view.control.message.imu_age_s(2.9);
  const auto silences = silences_of(view, kNow);
  ASSERT_EQ(silences.size(), 1U);
  EXPECT_NEAR(silences[0].for_s.value_or(0.0), 3.5, 1e-9);
}

TEST(Silences, NameWhatHasNeverSent) {
  View view = healthy();
  view.control.message.imu_age_s(-1.0);
  view.control.message.battery_age_s(-1.0);
  EXPECT_EQ(text_of(view), "vehicle never;battery never;");
}

TEST(Silences, OfControlAloneLeaveTheVehicleToItsOwnTopics) {
  View view = healthy(3s);
  EXPECT_EQ(text_of(view), "control service 3;");
  view.vehicle.received = view.battery.received = kNow - 4s;
  EXPECT_EQ(text_of(view), "control service 3;vehicle 4;battery 4;");
  view.vehicle.received = kNow;
  EXPECT_EQ(text_of(view), "control service 3;battery 4;");
  view.battery.received = kNow;
  EXPECT_EQ(text_of(view), "control service 3;");
  EXPECT_EQ(text_of(View()), "control service never;vehicle never;");
}

TEST(Silences, SaySinceWhen) {
  std::tm local{};
  local.tm_year = 125;
  local.tm_mday = 1;
  local.tm_hour = 14;
  local.tm_min = 3;
  local.tm_sec = 10;
  const auto now = std::chrono::system_clock::from_time_t(std::mktime(&local));
  EXPECT_EQ(to_string(Silence{"vehicle", 3.0}, now), "VEHICLE SILENT for 3.0 s, since 14:03:07");
  EXPECT_EQ(to_string(Silence{"vehicle", 3.0, "no IMU sample"}, now),
            "VEHICLE SILENT for 3.0 s, since 14:03:07 (no IMU sample)");
  EXPECT_EQ(to_string(Silence{"motion capture", std::nullopt}, now),
            "MOTION CAPTURE SILENT: nothing has come from it yet");
}

TEST(ControlIsSilent, ByItsOwnSilenceAlone) {
  View view = healthy();
  view.control.message.imu_age_s(3.0);
  EXPECT_FALSE(control_is_silent(silences_of(view, kNow)));
  EXPECT_TRUE(control_is_silent(silences_of(healthy(3s), kNow)));
  EXPECT_TRUE(control_is_silent(silences_of(View(), kNow)));
}

TEST(PoseAge, GrowsWhileControlIsSilent) {
  EXPECT_DOUBLE_EQ(pose_age_s(healthy(), kNow), 0.01);
  EXPECT_DOUBLE_EQ(pose_age_s(healthy(3s), kNow), 3.01);
}

}  // namespace swiftlet::ground::silence_test
