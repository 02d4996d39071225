// The ROS 2 message definitions agree with what the generated code of the IDL files sends.
#include "swiftlet/services/messages/schemas.hpp"

#include <cstring>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/EstimatePubSubTypes.h"
#include "swiftlet_msgs/msg/GroundLinkPubSubTypes.h"
#include "swiftlet_msgs/msg/ImuPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionPubSubTypes.h"
#include "swiftlet_msgs/msg/ReferencePubSubTypes.h"

#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "tests/support/serialization.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::messages::fixtures::schemas_test {

mcap::MessageDecoder decoder_of(const MessageSchema& schema) {
  return mcap::MessageDecoder({1, schema.name, "ros2msg", schema.definition});
}

template <class PubSubType>
std::map<std::string, mcap::Value> decoded(const typename PubSubType::type& message) {
  const auto bytes = swiftlet::tests::serialized<PubSubType>(message);
  const mcap::MessageDecoder decoder = decoder_of(schema_of<typename PubSubType::type>());
  std::vector<mcap::Value> values;
  EXPECT_TRUE(decoder.decode({bytes.data(), bytes.size()}, values));
  std::map<std::string, mcap::Value> named;
  for (std::size_t i = 0; i < values.size(); ++i) named[decoder.columns()[i].name] = values[i];
  return named;
}

// The payload is decoded to its last byte: a member that one of the two misses would shift the others.
template <class PubSubType>
void expect_whole(const typename PubSubType::type& message) {
  auto bytes = swiftlet::tests::serialized<PubSubType>(message);
  const mcap::MessageDecoder decoder = decoder_of(schema_of<typename PubSubType::type>());
  std::vector<mcap::Value> values;
  EXPECT_TRUE(decoder.decode({bytes.data(), bytes.size()}, values))
      << schema_of<typename PubSubType::type>().name;
  constexpr std::size_t kPadding = 3;  // Fast DDS 2.9 pads a payload to a multiple of 4
  EXPECT_FALSE(decoder.decode({bytes.data(), bytes.size() - kPadding - 1}, values))
      << schema_of<typename PubSubType::type>().name;
}

TEST(Schemas, EveryTopicHasOne) {
  std::set<std::string> names;
  for_each_topic([&](const auto& topic) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    EXPECT_TRUE(names.insert(topic.name).second) << topic.name;
    EXPECT_GE(decoder_of(schema_of<Message>()).columns().size(), 2U) << topic.name;
    EXPECT_FALSE(topic.writers[0].empty()) << topic.name;
  });
}

TEST(Schemas, DecodeWhatIsSent) {
  const auto imu = decoded<msg::ImuPubSubType>(to_message(imu_sample()));
  EXPECT_EQ(imu.at("stamp_ns"), mcap::Value(std::int64_t{1001}));
  EXPECT_EQ(imu.at("specific_force_frd[2]"), mcap::Value(-9.8));
  EXPECT_EQ(imu.at("body_rates_frd[0]"), mcap::Value(0.3));
  const auto command = decoded<msg::ActuatorCommandPubSubType>(to_message(actuator_command()));
  EXPECT_EQ(command.at("throttle[1]"), mcap::Value(0.4));
  EXPECT_EQ(command.at("term"), mcap::Value(std::uint64_t{21}));
  msg::ControlStatus status;
  status.mode(3);
  status.settings("motor_lag");
  status.gains_progress(0.25);
  const auto control = decoded<msg::ControlStatusPubSubType>(status);
  EXPECT_EQ(control.at("mode"), mcap::Value(std::uint64_t{3}));
  EXPECT_EQ(control.at("settings"), mcap::Value(std::string("motor_lag")));
  EXPECT_EQ(control.at("gains_progress"), mcap::Value(0.25));
  const auto uploaded = decoded<msg::MissionPubSubType>(to_message(mission(4)));
  EXPECT_EQ(uploaded.at("items.length"), mcap::Value(std::uint64_t{4}));
  EXPECT_EQ(uploaded.at("segments.length"), mcap::Value(std::uint64_t{3}));
  EXPECT_EQ(uploaded.at("max_yaw_rate"), mcap::Value(1.4));
  EXPECT_EQ(uploaded.at("fence_max_ned[2]"), mcap::Value(0.1));
}

TEST(Schemas, CoverWholePayloads) {
  expect_whole<msg::ImuPubSubType>({});
  expect_whole<msg::ActuatorCommandPubSubType>({});
  expect_whole<msg::EstimatePubSubType>({});
  expect_whole<msg::ReferencePubSubType>({});
  expect_whole<msg::ControlStatusPubSubType>({});
  expect_whole<msg::GroundLinkPubSubType>({});
  expect_whole<msg::MissionPubSubType>(to_message(mission(2)));
}

TEST(Schemas, KnowWhereTheStampIs) {
  const auto stamp_in = [](const std::vector<unsigned char>& bytes, int offset) {
    std::int64_t stamp_ns = 0;
    std::memcpy(&stamp_ns, bytes.data() + offset, sizeof(stamp_ns));
    return stamp_ns;
  };
  msg::GroundLink link;
  link.client(3);
  link.stamp_ns(-77);
  EXPECT_EQ(stamp_in(swiftlet::tests::serialized<msg::GroundLinkPubSubType>(link),
                     schema_of<msg::GroundLink>().stamp_offset),
            -77);
  EXPECT_EQ(stamp_in(swiftlet::tests::serialized<msg::ImuPubSubType>(to_message(imu_sample())),
                     schema_of<msg::Imu>().stamp_offset),
            1001);
  EXPECT_EQ(schema_of<msg::Command>().stamp_offset, -1);
}

}  // namespace swiftlet::messages::fixtures::schemas_test
