// The messages of a topic as they arrive.
#include "swiftlet/ground/client/topic_stream.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::ground::topic_stream_test {

using namespace std::chrono_literals;

constexpr auto kPatience = tests::kStuck;

class TopicStreamTest : public testing::Test {
 protected:
  dds::NodeSettings settings(const std::string& name) const {
    dds::NodeSettings settings{name, "kl1", domain_.domain()};
    return settings;
  }
  static double number(const TopicStream& stream, const TopicStream::Sample& sample,
                       const std::string& name) {
    const auto& columns = stream.columns();
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const mcap::Column& column) { return column.name == name; });
    return std::get<double>(sample.values.at(static_cast<std::size_t>(at - columns.begin())));
  }

  dds::DomainLock domain_;
};

TEST_F(TopicStreamTest, GivesEachMessageOnceInOrder) {
  dds::Node sender(settings("plant"));
  auto infos = sender.publish(messages::topics::kVehicleInfo);  // reliable: none is lost
  const dds::Participant participant(settings("ground"));
  TopicStream stream(participant, "kl1", "vehicle_info");
  EXPECT_FALSE(stream.next(0ms));
  messages::msg::VehicleInfo message;
  message.wire_version(messages::kWireVersion);
  for (int i = 1; i <= 3; ++i) {
    message.mass_kg(0.5 * i);
    infos.publish(message);
    const auto sample = stream.next(kPatience);
    ASSERT_TRUE(sample);
    EXPECT_EQ(number(stream, *sample, "mass_kg"), 0.5 * i);
  }
  EXPECT_FALSE(stream.next(0ms));
  EXPECT_EQ(stream.dropped(), 0U);
}

TEST_F(TopicStreamTest, DropsTheOldestOfTooMany) {
  dds::Node sender(settings("control"));
  auto estimates = sender.publish(messages::topics::kEstimate);
  const dds::Participant participant(settings("ground"));
  TopicStream stream(participant, "kl1", "estimate", 2);
  ASSERT_TRUE(tests::eventually([&] { return estimates.matched() > 0; }));
  messages::msg::Estimate message;
  std::uint64_t sent = 0;
  ASSERT_TRUE(tests::eventually([&] {
    message.position_ned({1.0 * static_cast<double>(++sent), 0.0, 0.0});
    estimates.publish(message);
    return stream.dropped() >= 3;
  }));
  const auto oldest = stream.next(kPatience);
  ASSERT_TRUE(oldest);
  EXPECT_GT(number(stream, *oldest, "position_ned[0]"), 3.0);
}

TEST_F(TopicStreamTest, RefusesAnUnknownTopicAndNamesAll) {
  const dds::Participant participant(settings("ground"));
  try {
    const TopicStream stream(participant, "kl1", "nothing");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("'nothing' is no topic of a vehicle. Topics: imu, ", 0), 0U);
  }
}

}  // namespace swiftlet::ground::topic_stream_test
