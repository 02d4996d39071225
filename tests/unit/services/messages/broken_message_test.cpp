// Bytes that are not a valid message of their topic's type are dropped; later messages are received.
#include <algorithm>
#include <string>
#include <vector>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <gtest/gtest.h>

#include "swiftlet_msgs/msg/CommandPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionPubSubTypes.h"
#include "swiftlet_msgs/msg/MocapPosePubSubTypes.h"
#include "swiftlet_msgs/msg/VehicleInfoPubSubTypes.h"

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/serialization.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::messages::fixtures::broken_message_test {

namespace fastdds = eprosima::fastdds::dds;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;

using swiftlet::tests::RawType;
using swiftlet::tests::serialized;
using Bytes = RawType::Bytes;

Bytes changed(Bytes bytes, std::size_t at, unsigned char value) {
  bytes.at(at) = value;
  return bytes;
}
Bytes cut(Bytes bytes, std::size_t size) {
  bytes.resize(size);
  return bytes;
}

// A peer that publishes raw bytes on one topic.
class RawPeer {
 public:
  RawPeer(const dds::DomainLock& lock, const std::string& topic, const std::string& type, Qos qos,
          const std::string& prefix = "rt/kl1/")
      : session_(swiftlet::tests::settings_of("raw", lock), rtps::Announcement(),
                 std::make_shared<rtps::DatagramGuard>(), nullptr) {
    fastdds::Topic* const raw_topic = session_.topic(prefix + topic, fastdds::TypeSupport(new RawType(type)));
    writer_ = session_.publisher->create_datawriter(raw_topic, dds::writer_qos(qos));
  }
  bool send(const Bytes& bytes) { return dds::write(*writer_, &bytes); }
  bool is_matched() const {
    fastdds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count == 1;
  }

 private:
  dds::ParticipantSession session_;
  fastdds::DataWriter* writer_;
};

template <class Type>
void expect_dropped(const Topic<typename Type::type>& topic, const typename Type::type& whole,
                    const std::vector<Bytes>& broken) {
  const dds::DomainLock lock;
  dds::Node node(swiftlet::tests::settings_of("node", lock));
  Inbox<typename Type::type> inbox;
  const auto subscription =
      node.subscribe<typename Type::type>(topic, [&](const auto& message) { inbox.put(message); });
  RawPeer peer(lock, topic.name, dds::type_name(Type()), topic.qos);
  ASSERT_TRUE(eventually([&] { return subscription.matched() == 1 && peer.is_matched(); }));

  std::size_t received = 0;
  for (const Bytes& bytes : broken) {
    ASSERT_TRUE(peer.send(bytes));
    ASSERT_TRUE(peer.send(serialized<Type>(whole)));
    ASSERT_TRUE(inbox.wait_for_count(++received));
  }
  for (const auto& message : inbox.items()) EXPECT_TRUE(message == whole);
}

constexpr std::size_t kEncapsulation = 4;

TEST(BrokenMessage, IsDroppedOnAStream) {
  const msg::MocapPose pose = to_message(pose_sample());
  const Bytes whole = serialized<msg::MocapPosePubSubType>(pose);
  expect_dropped<msg::MocapPosePubSubType>(
      topics::kMocapPose, pose,
      {changed(whole, kEncapsulation + 16, 2), changed(whole, 0, 0x5a), changed(whole, 1, 0x5a),
       cut(whole, whole.size() - 9), cut(whole, kEncapsulation), cut(whole, 3), cut(whole, 0)});
}

TEST(BrokenMessage, IsDroppedOnARequestTopic) {
  const msg::Mission mission = to_message(messages::fixtures::mission(3, 2));
  const Bytes whole = serialized<msg::MissionPubSubType>(mission);
  Bytes endless = whole;
  for (std::size_t i = 0; i < 4; ++i) endless.at(kEncapsulation + 16 + i) = 0xff;  // the number of items
  expect_dropped<msg::MissionPubSubType>(topics::kMission, mission,
                                         {endless, cut(whole, whole.size() / 2), changed(whole, 0, 1)});
}

// GIVEN a peer whose vehicle_info has another wire version and another layout WHEN it comes THEN a reader gets that version alone, and
// one of payloads nothing.
TEST(WireVersion, IsAllThatIsTakenOfAMessageOfAnotherOne) {
  const dds::DomainLock lock;
  dds::Node node(swiftlet::tests::settings_of("node", lock));
  Inbox<msg::VehicleInfo> inbox;
  Inbox<std::size_t> payloads;
  const auto messages =
      node.subscribe<msg::VehicleInfo>(topics::kVehicleInfo, [&](const auto& info) { inbox.put(info); });
  dds::Node recorder(swiftlet::tests::settings_of("recorder", lock));
  const auto raw = recorder.subscribe_raw<msg::VehicleInfo>(
      topics::kVehicleInfo, [&](const dds::RawSample& sample) { payloads.put(sample.size); });
  RawPeer peer(lock, "vehicle_info", dds::type_name(msg::VehicleInfoPubSubType()), Qos::kLatched);
  ASSERT_TRUE(eventually([&] { return messages.matched() == 1 && raw.matched() == 1; }));
  const Bytes whole = serialized<msg::VehicleInfoPubSubType>(example<msg::VehicleInfo>());
  ASSERT_TRUE(peer.send(cut(changed(whole, kEncapsulation, 4), kEncapsulation + 12)));
  ASSERT_TRUE(inbox.wait_for_count(1));
  ASSERT_TRUE(peer.send(whole));
  ASSERT_TRUE(inbox.wait_for_count(2));
  ASSERT_TRUE(payloads.wait_for_count(1));
  msg::VehicleInfo foreign;
  foreign.wire_version(4);
  EXPECT_TRUE(inbox.items()[0] == foreign);
  EXPECT_TRUE(inbox.items()[1] == example<msg::VehicleInfo>());
  EXPECT_EQ(payloads.size(), 1U);
}

// GIVEN programs of others with the type of ROS 2, or without the prefix of its topics THEN each is named, with what is expected.
TEST(Mismatches, OfTypesAndNamesAreToldByProcess) {
  const dds::DomainLock lock;
  const dds::Node node(swiftlet::tests::settings_of("node", lock));
  const std::string type = dds::type_name(msg::CommandPubSubType());
  const RawPeer right(lock, "command", type, Qos::kRequest);
  const RawPeer wrong_type(lock, "command", "swiftlet_msgs::msg::Command", Qos::kRequest);
  const RawPeer wrong_name(lock, "command", type, Qos::kRequest, "kl1/");
  const RawPeer another_vehicle(lock, "command", "swiftlet_msgs::msg::Command", Qos::kRequest, "rt/kl2/");
  ASSERT_TRUE(eventually([&] { return node.mismatches_seen().size() == 2; }));
  std::vector<std::string> told = node.mismatches_seen();
  std::sort(told.begin(), told.end());
  EXPECT_EQ(told[0], "kl1/command: raw has it without rt/, expected rt/kl1/command");
  EXPECT_EQ(told[1],
            "rt/kl1/command: raw has it as swiftlet_msgs::msg::Command, expected "
            "swiftlet_msgs::msg::dds_::Command_");
}

TEST(WireVersion, IsRefusedByName) {
  EXPECT_EQ(fault_of_wire_version(kWireVersion, "the vehicle"), "");
  EXPECT_EQ(fault_of_wire_version(4, "the vehicle"),
            "the vehicle speaks version 4 of the messages, this program 3");
  EXPECT_EQ(fault_of_wire_version(0x51234567, "control"),
            "control speaks another version of the messages than this program, 3");
}

}  // namespace swiftlet::messages::fixtures::broken_message_test
