#include "swiftlet/record/file/process_log.hpp"

#include <ctime>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/math/time.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::record::process_log_test {

constexpr std::int64_t kNow_s = 1'800'000'000;  // since 1970

std::string at(std::int64_t time_s, const std::string& text) {
  const std::time_t time = time_s;
  std::tm local{};
  ::localtime_r(&time, &local);
  std::string clock(16, ' ');
  clock.resize(std::strftime(clock.data(), clock.size(), "%H:%M:%S", &local));
  return clock + ".250 " + text + "\n";
}

TEST(ProcessLog, LinesOfAllProcessesAreInTheOrderOfTime) {
  const tests::TemporaryFolder folder;
  folder.write("swiftlet-control.log", at(kNow_s - 9, "control info: joined: plant") + "  continued\n" +
                                           at(kNow_s - 1, "control error: late"));
  folder.write("swiftlet-plant.log", at(kNow_s - 5, "plant warning: slow"));
  folder.write("other.log", at(kNow_s, "other info: not of the flight"));
  const auto lines = record::process_log_lines(folder.path(), kNow_s * math::kSecond_ns);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].time_ns, (kNow_s - 9) * math::kSecond_ns + math::kSecond_ns / 4);
  EXPECT_EQ(lines[0].process, "control");
  EXPECT_EQ(lines[0].level, "info");
  EXPECT_EQ(lines[0].text, "joined: plant");
  EXPECT_EQ(lines[1].process, "plant");
  EXPECT_EQ(lines[2].level, "error");
}

TEST(ProcessLog, KeepsBlanksOfATextAndSkipsWhatIsNoLine) {
  const tests::TemporaryFolder folder;
  folder.write("swiftlet-plant.log", at(kNow_s, "plant info:   deep") + "12:34:nan plant info: no time\n" +
                                         "12:34:-5.0 plant info: no time\n" +
                                         "12:34:05.0 plant info:close\n");
  const auto lines = record::process_log_lines(folder.path(), kNow_s * math::kSecond_ns);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text, "  deep");
}

// GIVEN a line of the evening before THEN it is not dated to the coming evening.
TEST(ProcessLog, TheDayIsTheNearest) {
  const tests::TemporaryFolder folder;
  constexpr std::int64_t kElevenHours_s = 39'600;
  folder.write("swiftlet-plant.log", at(kNow_s - kElevenHours_s, "plant info: before") +
                                         at(kNow_s + kElevenHours_s, "plant info: after"));
  const auto lines = record::process_log_lines(folder.path(), kNow_s * math::kSecond_ns);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].time_ns, (kNow_s - kElevenHours_s) * math::kSecond_ns + math::kSecond_ns / 4);
  EXPECT_EQ(lines[1].time_ns, (kNow_s + kElevenHours_s) * math::kSecond_ns + math::kSecond_ns / 4);
}

TEST(ProcessLog, BecomesFoxgloveLog) {
  const record::StandardMessage message =
      record::log_message({kNow_s * math::kSecond_ns + 7, "control", "warning", "late"});
  EXPECT_EQ(message.topic, "/log");
  EXPECT_STREQ(message.schema->name, "foxglove_msgs/msg/Log");
  // CDR little endian: header, sec, nanosec, level, then strings with their lengths.
  ASSERT_GT(message.payload.size(), 17U);
  EXPECT_EQ(static_cast<unsigned>(message.payload[8]), 7U);
  EXPECT_EQ(static_cast<unsigned>(message.payload[12]), 3U);
  const std::string bytes(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());
  EXPECT_NE(bytes.find("late"), std::string::npos);
  EXPECT_NE(bytes.find("control"), std::string::npos);
}

}  // namespace swiftlet::record::process_log_test
