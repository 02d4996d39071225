#include "swiftlet/analysis/logs/log_diff.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/schemas.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::analysis::log_diff_test {

constexpr std::int64_t kMs = 1'000'000;

// A flight along north at 1 m/s, whose mission starts at start_ns. Estimates each period_ns for 2 s.
struct Flight {
  std::int64_t start_ns = 0;
  std::int64_t period_ns = 10 * kMs;
  double east_m = 0.0;
  double yaw = 0.0;
  bool with_mission = true;
  std::uint64_t controller = 1;
};

class LogDiff : public testing::Test {
 protected:
  template <class T>
  void write(mcap::Writer& file, const std::string& topic, T message, std::int64_t time_ns) {
    const messages::MessageSchema& schema = messages::schema_of<T>();
    auto& channel = channels_[topic];
    if (!channel)
      channel =
          file.add_channel(topic, file.add_schema(schema.name, "ros2msg", schema.definition), "cdr", {});
    const auto payload = dds::to_payload(message);
    file.write(mcap::Message{*channel, 1, time_ns, time_ns, {payload.data(), payload.size()}});
  }

  mcap::Reader recorded(const std::string& name, const Flight& flight) {
    const std::string path = folder_.path() / name;
    channels_.clear();
    mcap::Writer file(path, {});
    if (flight.with_mission) {
      messages::msg::MissionStatus status;
      status.stamp_ns(flight.start_ns);
      status.state(messages::msg::MissionStatus_Constants::RUNNING);
      write(file, "/kl1/mission_status", status, flight.start_ns);
    }
    for (std::int64_t t = 0; t <= 2000 * kMs; t += flight.period_ns) {
      messages::msg::Estimate estimate;
      estimate.stamp_ns(flight.start_ns + t);
      estimate.sequence_number(flight.controller + static_cast<std::uint64_t>(t));
      estimate.position_ned({static_cast<double>(t) * 1e-9, flight.east_m, 0.0});
      estimate.q_ned_from_frd({std::cos(flight.yaw / 2.0), 0.0, 0.0, std::sin(flight.yaw / 2.0)});
      write(file, "/kl1/estimate", estimate, flight.start_ns + t);
    }
    file.close();
    return mcap::Reader(path);
  }

  static const SignalDifference& signal(const TopicDifference& topic, const std::string& name) {
    const auto found = std::find_if(topic.signals.begin(), topic.signals.end(),
                                    [&](const SignalDifference& one) { return one.name == name; });
    if (found == topic.signals.end()) throw std::runtime_error("no signal " + name);
    return *found;
  }

  tests::TemporaryFolder folder_;
  std::map<std::string, std::optional<std::uint16_t>> channels_;
};

TEST_F(LogDiff, OfTheSameFlightIsNone) {
  const mcap::Reader a = recorded("a.mcap", {});
  const mcap::Reader b = recorded("b.mcap", {});
  const auto topics = difference(a, b, {});
  ASSERT_EQ(topics.size(), 2U);
  for (const TopicDifference& topic : topics) {
    EXPECT_TRUE(topic.equal) << topic.topic;
    EXPECT_EQ(topic.messages_a, topic.messages_b);
  }
}

TEST_F(LogDiff, CountsTimesFromTheStartOfTheMission) {
  const mcap::Reader a = recorded("a.mcap", {});
  Flight later;
  later.start_ns = 1'700'000'000'000'000'003;
  later.controller = 77;
  const mcap::Reader b = recorded("b.mcap", later);
  const auto topics = difference(a, b, {"/kl1/estimate"});
  ASSERT_EQ(topics.size(), 1U);
  EXPECT_FALSE(topics[0].equal) << "other stamps";
  EXPECT_EQ(topics[0].compared, 201U);
  for (const SignalDifference& signal : topics[0].signals) EXPECT_EQ(signal.max, 0.0) << signal.name;
}

TEST_F(LogDiff, IsTheLengthOfAVectorAndTheAngleOfAnAttitude) {
  const mcap::Reader a = recorded("a.mcap", {});
  Flight other;
  other.east_m = 0.25;
  other.yaw = -0.3;
  const mcap::Reader b = recorded("b.mcap", other);
  const auto topics = difference(a, b, {"/kl1/estimate"});
  EXPECT_NEAR(signal(topics[0], "position_ned").rms, 0.25, 1e-12);
  EXPECT_NEAR(signal(topics[0], "q_ned_from_frd").max, 0.3, 1e-12);
  EXPECT_EQ(signal(topics[0], "velocity_ned").max, 0.0);
  for (const SignalDifference& one : topics[0].signals) EXPECT_NE(one.name, "sequence_number");
}

TEST_F(LogDiff, InterpolatesAnotherRateButNoLongGap) {
  const mcap::Reader a = recorded("a.mcap", {});
  Flight slower;
  slower.period_ns = 130 * kMs;
  const mcap::Reader b = recorded("b.mcap", slower);
  const auto dense = difference(a, b, {"/kl1/estimate"});
  EXPECT_EQ(dense[0].compared, 196U) << "up to the last of B, at 1.95 s";
  EXPECT_NEAR(signal(dense[0], "position_ned").max, 0.0, 1e-12);
  Flight sparse;
  sparse.period_ns = 1500 * kMs;
  const mcap::Reader c = recorded("c.mcap", sparse);
  EXPECT_EQ(difference(a, c, {"/kl1/estimate"})[0].compared, 2U) << "those of equal times";
}

TEST_F(LogDiff, WithoutAMissionCountsFromTheFirstMessage) {
  Flight early;
  early.with_mission = false;
  Flight late = early;
  late.start_ns = 5'000 * kMs;
  const mcap::Reader a = recorded("a.mcap", early);
  const mcap::Reader b = recorded("b.mcap", late);
  EXPECT_EQ(difference(a, b, {})[0].compared, 201U);
}

TEST_F(LogDiff, NamesATopicThatIsInNeitherFile) {
  const mcap::Reader a = recorded("a.mcap", {});
  const mcap::Reader b = recorded("b.mcap", {});
  EXPECT_THROW(difference(a, b, {"/kl1/imu"}), io::ConfigError);
}

}  // namespace swiftlet::analysis::log_diff_test
